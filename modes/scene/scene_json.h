#pragma once

/// A scene as text: JSON, described in modes/README.md. Panel, command line and ParaView's state use the same text.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "modes/scene/scene.h"

namespace palpate::modes {

/// Reads and validates a scene. `source` names it in messages (a file's name). Throws std::invalid_argument with the
/// source and the path of the bad key: "skin.json: modes[1].type: there is no mode "surfce"; there are: follow, force,
/// ...".
Scene scene_from_json(std::string_view text, const std::string& source);

/// The text of a scene. scene_from_json() reads it back to the same scene, bit for bit; that scene has the same text.
std::string to_json(const Scene& scene);

/// A scene's filter alone, as its key "filter" has it; no filter for an empty text. Throws std::invalid_argument.
io::Filter filter_from_json(std::string_view text);
/// Empty where there is no filter.
std::string to_json(const io::Filter& filter);

/// The scene in a file, or the starting scene of that name ("ct-skin-and-bone"). Throws std::invalid_argument that
/// names the file, or lists the starting scenes.
Scene load_scene(const std::string& file_or_name);

/// Names of the starting scenes: the files in modes/scene/starting, compiled in, so that they are found wherever the
/// program is.
std::vector<std::string> starting_scenes();

/// The text of a starting scene; empty where there is none of that name.
std::string_view starting_scene_text(std::string_view name);

}  // namespace palpate::modes

#pragma once

/// A scene as text: JSON, described in modes/README.md. The panel, the command line and ParaView's state use it.

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

/// A scene's filter alone, in the form of its key "filter"; no filter for an empty text. Throws std::invalid_argument.
io::Filter filter_from_json(std::string_view text);
/// Empty if there is no filter.
std::string to_json(const io::Filter& filter);

/// The scene in a file, or the starting scene of that name ("ct-skin-and-bone"). Throws std::invalid_argument that
/// names the file or lists the starting scenes.
Scene load_scene(const std::string& file_or_name);

/// Names of the starting scenes: the files in modes/scene/starting. They are compiled in, so that the program finds
/// them wherever it is installed.
std::vector<std::string> starting_scenes();

/// The text of a starting scene; empty if no starting scene has that name.
std::string_view starting_scene_text(std::string_view name);

}  // namespace palpate::modes

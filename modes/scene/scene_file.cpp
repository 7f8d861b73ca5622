#include <fstream>
#include <sstream>
#include <stdexcept>

#include "modes/messages.h"
#include "modes/scene/embedded_scenes.h"
#include "modes/scene/scene_json.h"

namespace palpate::modes {

std::vector<std::string> starting_scenes() {
  std::vector<std::string> names;
  for (const auto& [name, text] : embedded_scenes()) {
    names.emplace_back(name);
  }
  return names;
}

std::string_view starting_scene_text(std::string_view name) {
  for (const auto& [known, text] : embedded_scenes()) {
    if (known == name) {
      return text;
    }
  }
  return {};
}

Scene load_scene(const std::string& file_or_name) {
  if (const auto text = starting_scene_text(file_or_name); !text.empty()) {
    return scene_from_json(text, file_or_name);
  }
  std::error_code ignored;
  std::ifstream file(file_or_name, std::ios::binary);
  if (!file || std::filesystem::is_directory(file_or_name, ignored)) {
    std::string known;
    for (const std::string& name : starting_scenes()) {
      known += (known.empty() ? "" : ", ") + name;
    }
    throw InvalidInput(say("no-such-scene-file-can-be-read", file_or_name, known));
  }
  std::ostringstream text;
  text << file.rdbuf();
  Scene scene = scene_from_json(text.str(), file_or_name);
  // A recording and the panel keep the scene's text alone: its structures are to be found from there too.
  const std::filesystem::path folder = std::filesystem::absolute(file_or_name).parent_path();
  for (SceneStructure& structure : scene.structures) {
    if (structure.file.empty()) continue;
    structure.file = (folder / structure.file).lexically_normal().string();
  }
  return scene;
}

}  // namespace palpate::modes

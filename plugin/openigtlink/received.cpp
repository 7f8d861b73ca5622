#include "plugin/openigtlink/received.h"

#include <fmt/format.h>

#include <algorithm>

#include "plugin/openigtlink/say.h"

namespace palpate::plugin::igtl {
namespace {

constexpr std::string_view prefix = "openigtlink:";

}  // namespace

std::filesystem::path Received::fresh_file(const std::string& name) {
  if (!files_.contains(name) && files_.size() >= most_maps) throw Refusal(say("igtl-too-many-maps", name, most_maps));
  return folder_.path() / fmt::format("{}.nrrd", ++written_);
}

std::filesystem::path Received::file_of(const std::string& name) const {
  const auto found = files_.find(name);
  return found == files_.end() ? std::filesystem::path() : found->second.back();
}

void Received::use(const std::string& name, const std::filesystem::path& file) {
  auto& files = files_[name];
  files.push_back(file);
  if (files.size() <= most_files) return;
  std::error_code none;
  std::filesystem::remove(files.front(), none);
  files.erase(files.begin());
}

modes::Scene Received::with_names(modes::Scene scene) const {
  for (modes::SceneStructure& structure : scene.structures) {
    for (const auto& [name, files] : files_) {
      if (std::ranges::count(files, std::filesystem::path(structure.file)) > 0) {
        structure.file = std::string(prefix) + name;
        break;
      }
    }
  }
  return scene;
}

modes::Scene Received::with_files(modes::Scene scene) const {
  for (modes::SceneStructure& structure : scene.structures) {
    if (!structure.file.starts_with(prefix)) continue;
    const std::string name = structure.file.substr(prefix.size());
    const std::filesystem::path file = file_of(name);
    if (file.empty()) throw InvalidInput(say("igtl-no-such-map", structure.name, name));
    structure.file = file.string();
  }
  return scene;
}

}  // namespace palpate::plugin::igtl

#include "plugin/openigtlink/received.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <mutex>

#include "plugin/messages/tell.h"
#include "plugin/openigtlink/say.h"
#include "plugin/structures/structure_files.h"

namespace palpate::plugin::igtl {
namespace {

constexpr std::string_view prefix = "openigtlink:";

/// Its name is there when it is whole.
void copy_whole(const std::filesystem::path& file, const std::filesystem::path& to) {
  std::filesystem::create_directories(to.parent_path());
  const std::filesystem::path partial = to.string() + ".partial";
  std::filesystem::copy_file(file, partial, std::filesystem::copy_options::overwrite_existing);
  std::filesystem::rename(partial, to);
}

void keep(const std::string& name, const std::filesystem::path& file, const std::filesystem::path& folder) try {
  static std::mutex one_by_one;  // the same map may come twice
  const std::lock_guard lock(one_by_one);
  const std::filesystem::path kept = folder / (hash_of_file(file) + file.extension().string());
  if (std::filesystem::exists(kept)) return;
  copy_whole(file, kept);
  tell(say("igtl-map-kept", name, folder.string()));
} catch (const std::filesystem::filesystem_error& error) {
  tell(say("igtl-map-not-kept", name, folder.string(), error.code().message()));
}

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
  if (!keep_in_.empty()) {
    std::erase_if(copies_,
                  [](const auto& copy) { return copy.wait_for(std::chrono::seconds(0)) == std::future_status::ready; });
    copies_.push_back(std::async(std::launch::async, keep, name, file, keep_in_));
  }
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

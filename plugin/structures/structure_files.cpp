#include "plugin/structures/structure_files.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "io/structures/structure.h"
#include "plugin/messages/messages.h"

namespace palpate::plugin {
namespace {

constexpr std::size_t digits = 16;

bool is_hash(const std::string& file) {
  return file.size() == digits &&
         std::all_of(file.begin(), file.end(), [](unsigned char c) { return std::isxdigit(c) != 0; });
}

/// ".2" is one.
bool is_number(const std::string& extension) {
  return extension.size() > 1 &&
         std::all_of(extension.begin() + 1, extension.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

std::string unknown_hash() {
  return std::string(digits, '0');
}

std::string read_and_hash(const std::filesystem::path& file) {
  std::ifstream input(file, std::ios::binary);
  if (!input) return unknown_hash();
  const std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state(XXH3_createState(), XXH3_freeState);
  XXH3_64bits_reset(state.get());
  std::array<char, 1 << 16> part{};
  while (input.read(part.data(), part.size()) || input.gcount() > 0) {
    XXH3_64bits_update(state.get(), part.data(), static_cast<std::size_t>(input.gcount()));
  }
  return input.bad() ? unknown_hash() : fmt::format("{:016x}", XXH3_64bits_digest(state.get()));
}

std::mutex fetched_mutex;
std::map<std::filesystem::path, std::filesystem::path> fetched;

}  // namespace

std::filesystem::path structures_beside(const std::filesystem::path& recording) {
  std::filesystem::path file = recording;
  if (file.extension() == ".partial") {
    file.replace_extension();
    // A second one is NAME.2.partial.
    if (!std::filesystem::exists(file.string() + ".structures") && is_number(file.extension().string())) {
      file.replace_extension();
    }
  }
  return file.string() + ".structures";
}

void set_fetched_files(std::map<std::filesystem::path, std::filesystem::path> here_by_name) {
  const std::lock_guard lock(fetched_mutex);
  fetched = std::move(here_by_name);
}

std::filesystem::path copy_of(const std::filesystem::path& name) {
  const std::lock_guard lock(fetched_mutex);
  const auto found = fetched.find(name);
  return found == fetched.end() ? name : found->second;
}

std::filesystem::path name_of_copy(const std::filesystem::path& here) {
  const std::lock_guard lock(fetched_mutex);
  for (const auto& [name, place] : fetched) {
    if (place == here) return name;
  }
  return here;
}

std::optional<FileState> state_of_file(const std::filesystem::path& file) {
  std::error_code absent, no_size;
  const FileState state{std::filesystem::last_write_time(file, absent), std::filesystem::file_size(file, no_size)};
  return absent || no_size ? std::nullopt : std::optional(state);
}

std::string hash_of_file(const std::filesystem::path& file) {
  // A scene that is dragged while it is recorded is written down thirty times a second.
  static std::mutex mutex;
  static std::map<std::pair<std::string, FileState>, std::string> known;
  const std::optional<FileState> state = state_of_file(file);
  if (!state) return unknown_hash();
  const std::lock_guard lock(mutex);
  const std::pair key(file.string(), *state);
  if (const auto found = known.find(key); found != known.end()) return found->second;
  std::string hash = read_and_hash(file);
  if (state_of_file(file) == state) known.emplace(key, hash);  // else it was written meanwhile
  return hash;
}

bool is_known(const std::string& hash) {
  return is_hash(hash) && hash != unknown_hash();
}

modes::Scene without_paths(modes::Scene scene) {
  for (modes::SceneStructure& structure : scene.structures) {
    if (structure.file.empty()) continue;  // its contours are in the scene
    if (!is_hash(structure.file)) structure.file = hash_of_file(copy_of(structure.file));
  }
  return scene;
}

modes::Scene StructureFiles::with_paths(modes::Scene scene) {
  for (modes::SceneStructure& structure : scene.structures) {
    if (!is_known(structure.file)) continue;
    if (!std::exchange(looked_, true)) {
      for (const io::Structure& found : io::find_structures(places_).structures) {
        const bool known = std::any_of(by_hash_.begin(), by_hash_.end(),
                                       [&](const auto& entry) { return entry.second == found.file; });
        if (!known) by_hash_.emplace(hash_of_file(found.file), found.file);
      }
    }
    const auto found = by_hash_.find(structure.file);
    if (found == by_hash_.end()) {
      throw InvalidInput(say("structure-of-a-recording-is-not-here", structure.name));
    }
    structure.file = std::filesystem::absolute(found->second).string();
  }
  return scene;
}

}  // namespace palpate::plugin

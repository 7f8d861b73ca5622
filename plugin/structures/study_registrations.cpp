#include "plugin/structures/study_registrations.h"

#include <system_error>
#include <utility>

#include "plugin/messages/messages.h"
#include "plugin/structures/structure_files.h"

namespace palpate::plugin {
namespace {

namespace fs = std::filesystem;

/// Adds the files of a folder until there are `most`. Returns whether that was all.
template <typename Entries>
bool add_files(Entries entries, std::size_t most, std::set<fs::path>& files) {
  std::error_code ignored;
  for (auto entry = begin(entries); entry != end(entries); entry.increment(ignored)) {
    if (!entry->is_regular_file(ignored)) continue;
    if (files.size() >= most) return false;
    files.insert(entry->path());
  }
  return true;
}

}  // namespace

const StudyRegistrations::Folder& StudyRegistrations::files_beside(const fs::path& folder) {
  const auto [found, is_new] = folders_.try_emplace(folder);
  Folder& beside = found->second;
  if (!is_new) return beside;
  std::error_code ignored;
  constexpr auto skip = fs::directory_options::skip_permission_denied;
  beside.is_whole = add_files(fs::recursive_directory_iterator(folder, skip, ignored), most_, beside.files);
  std::set<fs::path> series;
  for (const auto& one : fs::directory_iterator(folder.parent_path(), skip, ignored)) {
    if (one.is_directory(ignored) && one.path() != folder) series.insert(one.path());
  }
  for (const fs::path& one : series) {
    beside.is_whole = beside.is_whole && add_files(fs::directory_iterator(one, skip, ignored), most_, beside.files);
  }
  return beside;
}

std::vector<io::Registration> StudyRegistrations::beside(io::Structure& structure, const io::Volume& scan) {
  const std::string &from = structure.frame_of_reference_uid, &to = scan.frame_of_reference_uid;
  if (from.empty() || to.empty() || from == to) return {};
  std::error_code ignored;
  const fs::path folder = fs::absolute(copy_of(structure.file), ignored).parent_path();
  const Folder& beside = files_beside(folder);
  if (!beside.is_whole) {
    structure.warnings.push_back(say("too-many-files-beside-a-structure", most_, structure.file.filename().string()));
  }
  std::vector<fs::path> unread;
  for (const fs::path& file : beside.files) {
    if (!read_.contains(file)) unread.push_back(file);
  }
  if (!unread.empty()) {
    std::vector<io::Registration> found = io::find_registrations(unread, progress_);
    for (const fs::path& file : unread) read_.try_emplace(file);
    for (io::Registration& one : found) read_.at(one.file) = one;
  }
  std::vector<io::Registration> registrations;
  for (const fs::path& file : beside.files) {
    if (const auto& one = read_.at(file)) registrations.push_back(*one);
  }
  return registrations;
}

}  // namespace palpate::plugin

#include "io/fresh_folder.h"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

#include "io/messages.h"

namespace palpate::io {
namespace fs = std::filesystem;

FreshFolder::FreshFolder(fs::path final_path, Readable readable) : final_(std::move(final_path)) {
  if (!final_.has_filename()) {
    final_ = final_.parent_path();  // "out/" means "out"
  }
  if (fs::exists(final_) && !(fs::is_directory(final_) && fs::is_empty(final_))) {
    throw Refusal(say("exists-and-is-not-an-empty-folder", final_.string()));
  }
  const fs::path parent = fs::absolute(final_).parent_path();
  fs::create_directories(parent);
  std::string pattern = (parent / (final_.filename().string() + ".partial-XXXXXX")).string();
  if (mkdtemp(pattern.data()) == nullptr) {
    throw Refusal(
        say("cannot-make-a-folder", parent.string(), std::error_code(errno, std::generic_category()).message()));
  }
  working_ = pattern;
  if (readable == Readable::by_owner) return;  // as mkdtemp makes it
  fs::permissions(working_,
                  fs::perms::group_read | fs::perms::group_exec | fs::perms::others_read | fs::perms::others_exec,
                  fs::perm_options::add);
}

FreshFolder::~FreshFolder() {
  if (!working_.empty()) {
    std::error_code ignored;
    fs::remove_all(working_, ignored);
  }
}

void FreshFolder::commit() {
  fs::rename(working_, final_);
  working_.clear();
}

FreshFolder temporary_folder() {
  return FreshFolder(fs::temp_directory_path() / ("palpate-" + std::to_string(getpid())),
                     FreshFolder::Readable::by_owner);
}

void write_all_or_none(const fs::path& final_path, const std::function<void(const fs::path&)>& write) {
  if (final_path.empty()) {
    write({});
    return;
  }
  FreshFolder folder(final_path);
  write(folder.path());
  folder.commit();
}

}  // namespace palpate::io

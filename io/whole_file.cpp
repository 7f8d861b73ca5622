#include "io/whole_file.h"

#include <unistd.h>

#include <atomic>
#include <fstream>
#include <string>
#include <system_error>

#include "io/errors.h"
#include "io/messages.h"

namespace palpate::io {
namespace {

namespace fs = std::filesystem;

/// No other process or thread writes there.
fs::path name_beside(const fs::path& file) {
  static std::atomic<int> count{0};
  return file.parent_path() / (".palpate-" + std::to_string(::getpid()) + "-" + std::to_string(count++) + ".part");
}

/// Removed with the object.
struct Temporary {
  explicit Temporary(fs::path where) : path(std::move(where)) {}
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;
  ~Temporary() {
    std::error_code ignored;
    fs::remove(path, ignored);
  }
  fs::path path;
};

}  // namespace

void check_may_write(const fs::path& file, Existing existing) {
  std::error_code ignored;
  const fs::file_status status = fs::symlink_status(file, ignored);
  if (!fs::exists(status)) return;
  if (existing == Existing::keep) throw DicomError(say("file-exists", file.string()));
  if (!fs::is_regular_file(fs::status(file, ignored))) throw DicomError(say("report-cannot-be-written", file.string()));
}

void write_whole(const fs::path& file, std::string_view bytes, Existing existing) {
  check_may_write(file, existing);
  const Temporary part(name_beside(file));
  std::ofstream stream(part.path, std::ios::binary);
  stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  stream.close();  // a full disk may show here first
  if (!stream) throw DicomError(say("report-cannot-be-written", file.string()));
  check_may_write(file, existing);
  std::error_code failed;
  fs::rename(part.path, file, failed);
  if (failed) throw DicomError(say("report-cannot-be-written", file.string()));
}

}  // namespace palpate::io

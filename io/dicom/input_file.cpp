#include "io/dicom/input_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "io/errors.h"
#include "io/messages.h"

namespace palpate::io::internal {

InputFile::InputFile(const std::filesystem::path& path)
    : descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)), size_(0) {
  struct stat status {};
  if (descriptor_ < 0 || ::fstat(descriptor_, &status) != 0) {
    if (descriptor_ >= 0) ::close(descriptor_);
    throw DicomError(say("cannot-be-opened"));
  }
  size_ = static_cast<std::uint64_t>(status.st_size);
}

InputFile::~InputFile() {
  ::close(descriptor_);
}

void InputFile::read(std::uint64_t at, std::span<std::byte> into) const {
  if (at > size_ || into.size() > size_ - at) throw DicomError(say("truncated-the-file-ends-early"));
  while (!into.empty()) {
    const ssize_t got = ::pread(descriptor_, into.data(), into.size(), static_cast<off_t>(at));
    if (got <= 0) throw DicomError(say("cannot-be-read-to-its-end"));
    at += static_cast<std::uint64_t>(got);
    into = into.subspan(static_cast<std::size_t>(got));
  }
}

}  // namespace palpate::io::internal

// libFuzzer's way into the reader: the bytes are a file; its header is read and every image in it decoded.
// Built and run by io/fuzz/run.
//
// DCMTK asks for as many bytes as an element claims (up to 4 GiB) before it finds that they are not there. It touches
// none of them and takes a refusal well; that is what the second limit is for. The first one holds for memory in use.
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

#include "io/errors.h"
#include "io/load.h"

namespace {

using namespace palpate::io;

void read_all(const std::filesystem::path& path) {
  const Catalogue found = find_series(std::array{path});
  for (const Series& series : found.series) {
    for (int frame = 0; frame < series.frames_per_position; ++frame) {
      try {
        LoadOptions options;
        options.frame = frame;
        options.threads = 1;
        static_cast<void>(statistics(load(series, options)));
      } catch (const DicomError&) {
      }
    }
  }
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): the name that libFuzzer calls.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // A file in memory: the reader takes paths.
  const int file = ::memfd_create("fuzz", MFD_CLOEXEC);
  if (file < 0 || ::write(file, data, size) != static_cast<ssize_t>(size)) return 0;
  read_all("/proc/self/fd/" + std::to_string(file));
  ::close(file);
  return 0;
}

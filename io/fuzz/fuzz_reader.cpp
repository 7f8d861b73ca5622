// libFuzzer's entry to the reader. The bytes are one file, or several separated by "<next>". Headers are read and every
// image in them decoded; structures are searched, decoded and measured. The first bytes determine a file's name. Built
// and run by io/fuzz/run.
//
// DCMTK allocates as many bytes as an element claims (up to 4 GiB) before it finds that they are missing. It touches
// none of them and handles a refusal well; the second limit is for that. The first limit is on memory in use.
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "io/errors.h"
#include "io/load.h"
#include "io/structures/structure.h"

namespace {

using namespace palpate::io;

namespace fs = std::filesystem;

// NIfTI and MetaImage are known by their names.
const char* ending_of(std::string_view bytes) {
  constexpr std::size_t nifti_magic = 344;
  constexpr std::size_t nifti_2_magic = 4;
  if (bytes.substr(std::min(bytes.size(), nifti_magic)).starts_with("n+1")) return ".nii";
  if (bytes.substr(std::min(bytes.size(), nifti_2_magic)).starts_with("n+2")) return ".nii";
  if (bytes.starts_with("ObjectType") || bytes.starts_with("NDims")) return ".mha";
  return bytes.starts_with("\x1f\x8b") ? ".nii.gz" : "";
}

// In memory, where there is a file system of it.
fs::path scratch_folder() {
  // Never destroyed: what removes it at the end of the program reads it.
  static const fs::path& folder = *[] {
    std::string name =
        (fs::exists("/dev/shm") ? "/dev/shm" : fs::temp_directory_path().string()) + "/palpate_fuzz_XXXXXX";
    if (::mkdtemp(name.data()) == nullptr) std::abort();
    std::atexit([] { fs::remove_all(scratch_folder()); });
    return new fs::path(name);
  }();
  return folder;
}

void write_files(std::string_view bytes) {
  for (const auto& entry : fs::directory_iterator(scratch_folder())) fs::remove_all(entry.path());
  constexpr std::string_view next = "<next>";
  for (int n = 0;; ++n) {
    const std::size_t end = bytes.find(next);
    const std::string_view one = bytes.substr(0, end);
    std::ofstream(scratch_folder() / (std::to_string(n) + ending_of(one)), std::ios::binary) << one;
    if (end == std::string_view::npos) return;
    bytes.remove_prefix(end + next.size());
  }
}

void read_all(const fs::path& path) {
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

/// Decodes structures as when they are used. By then all checks are done; so the distance, which would take seconds
/// here, is not computed.
void read_structures(const fs::path& path) {
  constexpr std::size_t most_structures = 8;
  std::size_t count = 0;
  for (const Structure& structure : find_structures(std::array{path}).structures) {
    if (++count > most_structures) return;
    try {
      static_cast<void>(box_of(structure));
      static_cast<void>(measure(structure));
    } catch (const DicomError&) {
    }
  }
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): the name that libFuzzer calls.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  write_files({reinterpret_cast<const char*>(data), size});
  read_all(scratch_folder());
  read_structures(scratch_folder());
  return 0;
}

// libFuzzer's way into recordings: the bytes are a file. What is read is written as a table.
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "plugin/recording/recording.h"

namespace fs = std::filesystem;

// NOLINTNEXTLINE(readability-identifier-naming): the name that libFuzzer calls.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fs::path folder = fs::exists("/dev/shm") ? "/dev/shm" : fs::temp_directory_path();
  static const fs::path file = folder / ("palpate_fuzz_" + std::to_string(::getpid()) + ".h5");
  static const fs::path table = fs::path(file).replace_extension(".csv");
  static const bool removed_at_exit = std::atexit([] {
                                        fs::remove(file);
                                        fs::remove(table);
                                      }) == 0;
  static_cast<void>(removed_at_exit);
  std::ofstream(file, std::ios::binary).write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  try {
    const palpate::plugin::Recording recording = palpate::plugin::read_recording(file);
    palpate::plugin::write_csv(recording, table);
    static_cast<void>(scan_frames_of(recording));
    static_cast<void>(registered_of(recording));
  } catch (const std::runtime_error&) {
  }
  return 0;
}

#pragma once

/// Files as text, for tests that damage them.

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace palpate::io::internal {

inline std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline void write_bytes(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

}  // namespace palpate::io::internal

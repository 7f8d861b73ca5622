#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

namespace palpate::io::internal {

/// An open file with reads at any offset, closed by the destructor. Several threads may read from it.
class InputFile {
 public:
  /// Throws DicomError if the file cannot be opened.
  explicit InputFile(const std::filesystem::path& path);
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;
  ~InputFile();

  std::uint64_t size() const { return size_; }
  /// Fills all of `into`. Throws DicomError if the file ends too early.
  void read(std::uint64_t at, std::span<std::byte> into) const;

 private:
  int descriptor_;
  std::uint64_t size_;
};

}  // namespace palpate::io::internal

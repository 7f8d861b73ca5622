#pragma once

/// Writes a file whole or not at all.

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace palpate::io {

enum class Existing : std::uint8_t { keep, replace };

/// Throws DicomError if the file exists and must be kept, or if the path is not a file.
void check_may_write(const std::filesystem::path& file, Existing existing);

/// Writes the bytes to a temporary file beside the file, and renames it when all are written. Throws DicomError as
/// check_may_write() does, and if the bytes cannot be written; then no file is left.
void write_whole(const std::filesystem::path& file, std::string_view bytes, Existing existing);

}  // namespace palpate::io

#pragma once

/// Writes a file whole or not at all.

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace palpate::io {

enum class Existing : std::uint8_t { keep, replace };

/// Throws DicomError where the file exists and is to be kept, or is no file at all.
void check_may_write(const std::filesystem::path& file, Existing existing);

/// Writes the bytes under a name of its own beside the file, and moves them to the file's name when all are written.
/// Throws DicomError as check_may_write(), and where they cannot be written; then nothing is left.
void write_whole(const std::filesystem::path& file, std::string_view bytes, Existing existing);

}  // namespace palpate::io

#pragma once

#include <filesystem>
#include <string_view>

namespace palpate::plugin {

/// Writes a text file, replacing an old one. Throws std::runtime_error that names the file and what to do.
void write_text(const std::filesystem::path& file, std::string_view text);

}  // namespace palpate::plugin

#pragma once

#include <filesystem>
#include <string_view>

namespace palpate::plugin {

/// Writes a file of text, in place of what was there. Throws std::runtime_error that names the file and what to do.
void write_text(const std::filesystem::path& file, std::string_view text);

}  // namespace palpate::plugin

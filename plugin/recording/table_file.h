#pragma once

/// A table as text, written row by row. fmt::ostream is not used, because it ends the program if the disk is full.

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <utility>

namespace palpate::plugin {

/// Replaces an existing file. Every function throws std::system_error if it cannot write.
class TableFile {
 public:
  explicit TableFile(const std::filesystem::path& file);

  template <typename... T>
  void print(fmt::format_string<T...> format, T&&... values) {
    fmt::print(file_.get(), format, std::forward<T>(values)...);
  }
  /// Writes the rest. Without this call, a full disk is not reported for it.
  void close();

 private:
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
};

}  // namespace palpate::plugin

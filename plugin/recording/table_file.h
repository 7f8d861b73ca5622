#pragma once

/// A table as text, written row by row. fmt::ostream is not used: where a disk is full it ends the program.

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <utility>

namespace palpate::plugin {

/// Takes the place of a file that was there. Every function throws std::system_error where it cannot write.
class TableFile {
 public:
  explicit TableFile(const std::filesystem::path& file);

  template <typename... T>
  void print(fmt::format_string<T...> format, T&&... values) {
    fmt::print(file_.get(), format, std::forward<T>(values)...);
  }
  /// Writes what is left. Without it nobody is told that there was no room for that.
  void close();

 private:
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
};

}  // namespace palpate::plugin

#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>

#include "plugin/report/text_file.h"

namespace palpate::plugin {

/// Prints the lines of a table on stdout, each at once because the next may take minutes, and keeps them for a CSV
/// file.
class CsvTable {
 public:
  explicit CsvTable(std::string header) : csv_(std::move(header) + "\n") {
    fmt::print("\n{}", csv_);
    std::fflush(stdout);
  }
  void add(const std::string& row) {
    fmt::print("{}\n", row);
    std::fflush(stdout);
    csv_ += row + "\n";
  }
  void save(const std::filesystem::path& folder, const std::string& name) const {
    if (folder.empty()) return;
    write_text(folder / name, csv_);
  }

 private:
  std::string csv_;
};

}  // namespace palpate::plugin

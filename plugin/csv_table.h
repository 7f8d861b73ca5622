#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <utility>

namespace palpate::plugin {

/// Lines of a table on stdout, kept for a CSV file.
class CsvTable {
 public:
  explicit CsvTable(std::string header) : csv_(std::move(header) + "\n") { fmt::print("\n{}", csv_); }
  void add(const std::string& row) {
    fmt::print("{}\n", row);
    csv_ += row + "\n";
  }
  void save(const std::filesystem::path& folder, const std::string& name) const {
    if (folder.empty()) return;
    std::ofstream file(folder / name);
    file << csv_;
    if (!file.flush()) throw std::runtime_error((folder / name).string() + ": cannot be written (is the disk full?)");
  }

 private:
  std::string csv_;
};

}  // namespace palpate::plugin

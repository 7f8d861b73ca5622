#pragma once

/// Files that a test passes to a driver: firmware, settings.

#include <filesystem>
#include <string>

namespace palpate::device {

/// A temporary folder that any user may read; deleted with the object.
class TestFiles {
 public:
  /// Throws std::system_error if no folder can be made.
  TestFiles();
  TestFiles(const TestFiles&) = delete;
  TestFiles& operator=(const TestFiles&) = delete;
  ~TestFiles();

  /// Writes a file of this name, replacing an old one, and returns its path. Throws std::system_error if it cannot.
  std::string write(const std::string& name, const std::string& bytes) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace palpate::device

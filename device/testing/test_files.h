#pragma once

/// Files that a test hands to a driver: firmware, settings.

#include <filesystem>
#include <string>

namespace palpate::device {

/// A folder of its own in the system's temporary one, which any user may read; gone with the object.
class TestFiles {
 public:
  /// Throws std::system_error if no folder can be made.
  TestFiles();
  TestFiles(const TestFiles&) = delete;
  TestFiles& operator=(const TestFiles&) = delete;
  ~TestFiles();

  /// Writes a file of this name anew and returns its path. Throws std::system_error where it cannot.
  std::string write(const std::string& name, const std::string& bytes) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace palpate::device

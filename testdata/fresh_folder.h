#pragma once

/// All of a folder's files or none: they are written beside it and moved to their place at the end.

#include <filesystem>

namespace palpate::testdata {

class FreshFolder {
 public:
  /// Throws std::runtime_error where `final_path` exists and is not an empty folder, or cannot be made.
  explicit FreshFolder(std::filesystem::path final_path);
  FreshFolder(const FreshFolder&) = delete;
  FreshFolder& operator=(const FreshFolder&) = delete;
  /// Removes what was written unless it was committed.
  ~FreshFolder();

  /// Where to write.
  const std::filesystem::path& path() const noexcept { return working_; }
  /// Moves the folder to its place.
  void commit();

 private:
  std::filesystem::path final_;
  std::filesystem::path working_;
};

}  // namespace palpate::testdata

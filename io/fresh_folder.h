#pragma once

/// All of a folder's files or none: they are written beside it and moved to their place at the end.

#include <filesystem>
#include <functional>

namespace palpate::io {

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

/// A folder in the system's temporary one, gone with the object: it is never committed.
FreshFolder temporary_folder();

/// Has `write` fill a fresh folder, which is committed when it returns. An empty `final_path` is handed on as it is:
/// nothing is to be written.
void write_all_or_none(const std::filesystem::path& final_path,
                       const std::function<void(const std::filesystem::path& folder)>& write);

}  // namespace palpate::io

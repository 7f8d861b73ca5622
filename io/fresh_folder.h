#pragma once

/// Writes a folder whole or not at all: its files are written beside it, and moved to their place at the end.

#include <filesystem>
#include <functional>

namespace palpate::io {

class FreshFolder {
 public:
  enum class Readable { by_all, by_owner };
  /// Throws std::runtime_error if `final_path` exists and is not an empty folder, or cannot be made.
  explicit FreshFolder(std::filesystem::path final_path, Readable readable = Readable::by_all);
  FreshFolder(const FreshFolder&) = delete;
  FreshFolder& operator=(const FreshFolder&) = delete;
  /// Removes the files unless they were committed.
  ~FreshFolder();

  /// Where to write.
  const std::filesystem::path& path() const noexcept { return working_; }
  /// Moves the folder to its place.
  void commit();

 private:
  std::filesystem::path final_;
  std::filesystem::path working_;
};

/// A temporary folder that is removed with the object. It is never committed. Only its owner can read it: it may hold
/// files that name a patient.
FreshFolder temporary_folder();

/// Lets `write` fill a fresh folder, and commits the folder when `write` returns. If `final_path` is empty, no folder
/// is made, and `write` gets the empty path.
void write_all_or_none(const std::filesystem::path& final_path,
                       const std::function<void(const std::filesystem::path& folder)>& write);

}  // namespace palpate::io

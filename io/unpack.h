#pragma once

/// Packed studies: zip, tar, tar.gz (and .bz2, .xz), and single gzipped files.

#include <filesystem>
#include <memory>
#include <vector>

#include "io/progress.h"

namespace palpate::io::internal {

/// The files of an archive, in a new folder below the system's temporary folder. Only the user can read that folder. It
/// is removed with the object that owns it.
class Unpacked {
 public:
  struct File {
    std::filesystem::path shown;  ///< its path in the archive
    std::filesystem::path
        stored_at;  ///< named by a number, since a name in an archive must not become a path on the disk
  };

  Unpacked();
  Unpacked(const Unpacked&) = delete;
  Unpacked& operator=(const Unpacked&) = delete;
  ~Unpacked();

  const std::filesystem::path& folder() const { return folder_; }
  std::vector<File> files;  ///< in the archive's order

 private:
  std::filesystem::path folder_;
};

/// Whether the first bytes of a file are those of an archive or of a gzipped file.
bool is_archive(const std::filesystem::path& file);

/// Unpacks regular files only. Archives inside the archive stay packed. Throws DicomError, with a reason that does not
/// name the file, if the archive is damaged or has a password, or if its contents are too large: more than 256 MiB and
/// 50 times the archive, more than 64 GiB, half of the free space, or a million files. Throws Cancelled.
std::shared_ptr<const Unpacked> unpack(const std::filesystem::path& archive, const Progress& progress);

}  // namespace palpate::io::internal

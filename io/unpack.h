#pragma once

/// Studies that were packed: zip, tar, tar.gz (and .bz2, .xz), and single gzipped files.

#include <filesystem>
#include <memory>
#include <vector>

#include "io/progress.h"

namespace palpate::io::internal {

/// The files of an archive, in a folder of their own under the system's temporary one that only the user may read. It
/// is removed with its owner.
class Unpacked {
 public:
  struct File {
    std::filesystem::path shown;      ///< its path in the archive
    std::filesystem::path stored_at;  ///< named by its number: a name in an archive is never a path on the disk
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

/// Unpacks regular files alone; archives in archives stay as they are. Throws DicomError, with a reason that does not
/// name the file, where it is damaged or locked by a password, or where more would come out than 256 MiB and 50 times
/// the archive, 64 GiB, half of the disk's room, or a million files; Cancelled.
std::shared_ptr<const Unpacked> unpack(const std::filesystem::path& archive, const Progress& progress);

}  // namespace palpate::io::internal

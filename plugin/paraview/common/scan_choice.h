#pragma once

/// Which of a folder's series is meant.

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "PalpateServerModule.h"
#include "io/series.h"

namespace palpate::plugin {

/// How many there are to choose from: the catalogue's series, and after them its velocity fields.
PALPATESERVER_EXPORT std::size_t scan_count(const io::Catalogue& catalogue);
/// One of them.
PALPATESERVER_EXPORT const io::Series& scan_at(const io::Catalogue& catalogue, std::size_t index);
/// Whether it is a velocity field.
inline bool is_velocity(const io::Catalogue& catalogue, std::size_t index) {
  return index >= catalogue.series.size();
}

/// What a series is called in properties and state files: its UID, and "UID#2", "UID#3" for further volumes of a series
/// whose images do not all fit together.
PALPATESERVER_EXPORT std::string scan_name(const io::Catalogue& catalogue, std::size_t index);

/// One line for a list: modality, description, size. Names no patient.
PALPATESERVER_EXPORT std::string scan_label(const io::Series& series);

/// Indices of all of them, the one that is meant where none is named first: the series that `path` is a file of, else
/// the usable one with most voxels.
PALPATESERVER_EXPORT std::vector<std::size_t> choices(const io::Catalogue& catalogue,
                                                      const std::filesystem::path& path);

/// Index of the series of that name, or the first of choices() where the name is empty. Throws io::DicomError that
/// lists what there is, also where the first choice is not a volume.
PALPATESERVER_EXPORT std::size_t choose_scan(const io::Catalogue& catalogue, const std::string& name,
                                             const std::filesystem::path& path);

}  // namespace palpate::plugin

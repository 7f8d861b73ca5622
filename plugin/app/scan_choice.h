#pragma once

/// Chooses a series of a folder, and a frame of it. The command line, ParaView's reader and the panel all use this, so
/// that a name, a number or a default means the same everywhere.

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/series.h"

namespace palpate::plugin {

/// The number of choices: the catalogue's series, followed by its velocity fields.
std::size_t scan_count(const io::Catalogue& catalogue);
/// One of them; `index` counts from 0.
const io::Series& scan_at(const io::Catalogue& catalogue, std::size_t index);
/// Whether it is a velocity field.
inline bool is_velocity(const io::Catalogue& catalogue, std::size_t index) {
  return index >= catalogue.series.size();
}

/// The name of a series in --series, properties and state files: its UID, and "UID#2", "UID#3" for further volumes of a
/// series whose images do not all fit together.
std::string scan_name(const io::Catalogue& catalogue, std::size_t index);

/// One short line for a list: modality, description, size. Names no patient.
std::string scan_label(const io::Series& series);

/// One whole line on a series: its number (from 1), modality, description, size, spacing, frames and name. Names no
/// patient.
std::string describe_series(std::size_t number, const io::Series& series, const std::string& name);
/// These lines, each after a line break, for all choices or only for those that are volumes.
std::string list_scans(const io::Catalogue& catalogue, bool usable_only = false);

/// Index of the series with that name (scan_name()) or number, counted from 1. None if there is no such series.
std::optional<std::size_t> find_scan(const io::Catalogue& catalogue, const std::string& name);
/// The number of volumes in a series of that UID; a UID alone means the first of them.
std::size_t volumes_of(const io::Catalogue& catalogue, const std::string& uid);

/// Index of the only volume. None if there is no volume, or more than one.
std::optional<std::size_t> only_scan(const io::Catalogue& catalogue);

/// Indices of all choices. The default comes first: the series of the DICOM file `path`, else io::choose_first()'s.
std::vector<std::size_t> choices(const io::Catalogue& catalogue, const std::filesystem::path& path);

/// The result of find_scan(), or the first of choices() if the name is empty. Throws io::DicomError that lists the
/// choices, also if the first of them is not a volume.
std::size_t choose_scan(const io::Catalogue& catalogue, const std::string& name, const std::filesystem::path& path);

/// The frame for a viewer's time: the nearest one, counted from 0.
int frame_at(int frames, double time);

}  // namespace palpate::plugin

#pragma once

/// Which starting scene suits a series.

#include <string>
#include <vector>

#include "io/series.h"
#include "io/volume.h"

namespace palpate::modes {

/// The name of the starting scene for a series, for load_scene(): by modality and, in CT, by the part of the body
/// (chest, abdomen, spine or head) from BodyPartExamined, else from the first word of SeriesDescription that names one.
/// If neither names one, it is the scene of the modality.
std::string starting_scene(const io::Series& series);
/// The same for a loaded scan: by its series, or "flow" for a velocity field.
std::string starting_scene(const io::Volume& volume);
/// The first word that names a part of the body, in capitals; empty if there is none. A starting scene depends on this
/// and the modality alone.
std::string part_of_body(const io::Volume& volume);

/// Whether the scan's attributes say that it shows the head.
bool is_of_head(const io::Volume& volume);

/// A starting scene in the list for a scan.
struct OfferedScene {
  std::string name;
  std::string made_for;  ///< empty if it suits the scan; else the scans that it was made for, in words
};
/// All starting scenes: `first`, then the others for this modality, then those for other scans.
std::vector<OfferedScene> offered_scenes(const std::string& first, const std::string& modality, bool has_vectors);

}  // namespace palpate::modes

#pragma once

/// Which starting scene suits a series.

#include <string>
#include <vector>

#include "io/series.h"
#include "io/volume.h"

namespace palpate::modes {

/// The name of a starting scene, for load_scene(): by modality and, in CT, by the part of the body: chest, abdomen,
/// spine or head, from BodyPartExamined, else from the first word of SeriesDescription that names one. Where nothing
/// does it is the scene of the modality.
std::string starting_scene(const io::Series& series);
/// The same of a scan that is loaded: of the series that it is of, or "flow" for a velocity field.
std::string starting_scene(const io::Volume& volume);
/// The first word that names a part of the body, in capitals; empty where none does: all that a starting scene depends
/// on beside the modality.
std::string part_of_body(const io::Volume& volume);

/// Whether it says that it is of the head.
bool is_of_head(const io::Volume& volume);

/// A starting scene as it is offered for a scan.
struct OfferedScene {
  std::string name;
  std::string made_for;  ///< empty: for such scans; else for what instead, in words
};
/// All starting scenes: `first`, then the others for scans of this modality, then those that are made for others.
std::vector<OfferedScene> offered_scenes(const std::string& first, const std::string& modality, bool has_vectors);

}  // namespace palpate::modes

#pragma once

/// Names of the boundaries found in a scan, in a clinician's words.

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "modes/scene/site.h"

namespace palpate::modes {

/// A boundary between two tissues, by their typical values.
struct NamedPair {
  double low = 0;
  double high = 0;
  std::string within = {};  ///< for a wall within a tissue: that tissue, such as "lung or foam"
  SiteCounts sites = {};    ///< CT only: where its edges lie; all 0 if unknown
};

/// One name for each boundary, all different.
///
/// HU: a boundary of air is named by all sites that have more than a thousandth of its edges: "Skin", "Skin, lung
/// surface and table". It is "Bone at air" if no soft tissue lies between, as in a sinus, or none is resolved; "Airways
/// in the lung" or "Foam or cloth" if its denser side is light too. If the sites are unknown, its values name it. Other
/// boundaries are "Soft tissue", "Bone", "Dense bone", "Metal"; if two would have the same name, the denser tissue's HU
/// is added. Fat beside soft tissue is "Soft tissue" too; any other wall within a tissue is "Wall in lung or foam".
///
/// Other units: the values say only which tissues a boundary lies between, in order of brightness. A likely name has a
/// question mark: "Skin?" for the boundary with the smallest rise from the darkest tissue; in a head (head_shape.h),
/// "Scalp and brain surface?" for the same, "Gray and white matter?" for the boundary between the next two, and "Scalp
/// fat or CSF?" for the one from the darkest to the third. Numbers in names are whole, or rounded to a hundredth of
/// `range`, the range of the scan's values, if that is less than 1.
struct NamingOptions {
  bool hounsfield = false;
  bool is_head = false;
  double range = 0;
};
std::vector<std::string> boundary_names(std::span<const NamedPair> boundaries, const NamingOptions& options);

/// The name of a boundary at one site: "Skin, lung surface and table" is "Skin" at the skin, and plain "Skin" gets the
/// table's name at the table. Names made of other words do not change. Site::elsewhere changes none.
std::string name_at(const std::string& name, Site site);

/// The name of the same boundary when it is crossed the other way.
std::string way_back_name(const std::string& name);

}  // namespace palpate::modes

#pragma once

/// What the boundaries found in a scan are called: in a clinician's words.

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
  std::string within = {};  ///< the tissue that both sides are part of, of a wall within one: "lung or foam"
  SiteCounts sites = {};    ///< of a CT: where its edges lie; all 0 where that is not known
};

/// One name for each, all different.
///
/// HU: a boundary of air is named by all sites where it is met, each with more than a thousandth of its edges: "Skin",
/// "Skin, lung surface and table". It is "Bone at air" where no soft tissue lies between, as in a sinus, or seems to;
/// "Airways in the lung" or "Foam or cloth" where its denser side is light too. Where the sites are not known its
/// values name it. Others are "Soft tissue", "Bone", "Dense bone", "Metal"; those that would share a name end in the
/// denser tissue's HU. Fat beside soft tissue is "Soft tissue" too; any other wall within a tissue is "Wall in lung or
/// foam".
///
/// Other units: nothing in the values says more than which tissues a boundary lies between, in order of brightness.
/// What is likely is asked: "Skin?" for the boundary that rises least from the darkest; and of a head, "Scalp and brain
/// surface?" for it and "Gray and white matter?" for that between the next two. Values in names are whole, or to a
/// hundredth of `range`, that of the scan's values, where that is less.
struct NamingOptions {
  bool hounsfield = false;
  bool is_head = false;
  double range = 0;
};
std::vector<std::string> boundary_names(std::span<const NamedPair> boundaries, const NamingOptions& options);

/// What a boundary of this name is called at one site: "Skin" there, of "Skin, lung surface and table", and of "skin"
/// alone it is the table's where the table is met. A name that is not made of such words stays, as it does elsewhere.
std::string name_at(const std::string& name, Site site);

/// Of the same boundary, felt on the way back.
std::string way_back_name(const std::string& name);

}  // namespace palpate::modes

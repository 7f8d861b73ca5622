#pragma once

/// What the boundaries found in a scan are called: in a clinician's words.

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace palpate::modes {

/// A boundary between two tissues, by their typical values.
struct NamedPair {
  double low = 0;
  double high = 0;
  std::string within = {};  ///< the tissue that both sides are part of, of a wall within one: "lung or foam"
};

/// One name for each, all different. HU: "Skin", "Lung or foam", "Lung surface", "Soft tissue", "Bone", "Metal", and
/// "Bone at air" where no soft tissue lies between, as in a sinus, or seems to; those that would share a name end in
/// the denser tissue's HU. Fat beside soft tissue is "Soft tissue" too; any other wall within a tissue is "Wall in lung
/// or foam". Other units: "Skin?" for the boundary that rises least from the darkest, and else which
/// tissues it lies between, in order of brightness; nothing in the values says more. Values in names are whole, or to a
/// hundredth of `range`, that of the scan's values, where that is less.
std::vector<std::string> boundary_names(std::span<const NamedPair> boundaries, bool hounsfield, double range);

/// Of the same boundary, felt on the way back.
std::string way_back_name(const std::string& name);

}  // namespace palpate::modes

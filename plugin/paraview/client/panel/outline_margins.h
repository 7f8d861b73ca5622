#pragma once

/// How far a structure that is corrected is from what the stylus is kept out of.

#include <memory>
#include <string>
#include <vector>

#include "io/structures/distance_field.h"
#include "io/structures/structure.h"

namespace palpate::plugin {

/// A structure as it is felt, and a box that holds it.
struct KeepOut {
  std::string name;
  double margin_mm = 0;  ///< at which its force begins
  std::shared_ptr<const io::DistanceField> outline;
  io::StructureBox box;
  bool operator==(const KeepOut& other) const {
    return name == other.name && margin_mm == other.margin_mm && outline == other.outline;
  }
};

struct OutlineMargin {
  std::string name;
  double keep_out_mm = 0;  ///< at which its force begins
  double mm = 0;           ///< the smallest distance between the surfaces; below 0: how deep one reaches into the other
};

/// Takes up to seconds: in the background.
std::vector<OutlineMargin> margins_from(const std::shared_ptr<const io::DistanceField>& outline,
                                        const io::StructureBox& box, const std::vector<KeepOut>& keep_outs);

}  // namespace palpate::plugin

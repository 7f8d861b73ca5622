#include "io/structures/mask_source.h"

#include "io/structures/beyond_slices.h"
#include "io/structures/mask_measures.h"

namespace palpate::io {

StructureMeasures MaskSource::measure(int number, const RigidMotion& motion, const Geometry* /*scan*/) const {
  return measures_of(moved_mask(number, motion));
}

std::shared_ptr<const DistanceField> MaskSource::distance(int number, const DistanceOptions& options) const {
  Mask mask = moved_mask(number, options.motion);
  measures_of(mask);  // refuses one that is empty
  add_empty_slices(options, mask);
  return distance_of(mask, options);
}

Mask MaskSource::moved_mask(int number, const RigidMotion& motion) const {
  Mask mask = mask_of(number);
  move(motion, mask.geometry);
  return mask;
}

}  // namespace palpate::io

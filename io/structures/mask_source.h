#pragma once

/// A file that holds structures as masks: segments of a DICOM SEG, labels of a label map.

#include <memory>

#include "io/structures/mask.h"
#include "io/structures/structure.h"

namespace palpate::io {

class MaskSource : public StructureSource {
 public:
  StructureMeasures measure(int number, const RigidMotion& motion, const Geometry* scan) const override;
  std::shared_ptr<const DistanceField> distance(int number, const DistanceOptions& options) const override;

 private:
  /// The mask of a structure on its file's grid. Empty if no voxel is inside.
  virtual Mask mask_of(int number) const = 0;
  /// The mask in the scan's frame of reference, and on the scan's slices if the structure was outlined on them.
  Mask moved_mask(int number, const RigidMotion& motion, const Geometry* scan, double around_mm) const;
};

}  // namespace palpate::io

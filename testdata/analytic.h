#pragma once

/// A phantom without voxels: every edge is a step after a Gaussian blur, and value and gradient are exact.

#include <limits>

#include "io/fields/field_source.h"
#include "testdata/phantom.h"

namespace palpate::testdata {

/// Paints the phantom's bodies over each other with the weight Phi(-distance / softness) instead of a step, so that the
/// edge of a half-space is a step blurred by a Gaussian of that standard deviation. Value in HU, gradient per mm.
///
/// Nothing is felt beyond `lower` and `upper` (mm, both ends inside).
class AnalyticSource : public io::FieldSource {
 public:
  explicit AnalyticSource(Phantom phantom, double softness_mm = 1,
                          const Vec3& lower = Vec3(-std::numeric_limits<double>::infinity()),
                          const Vec3& upper = Vec3(std::numeric_limits<double>::infinity()));

  io::FieldSet available() const noexcept override { return io::FieldSet::value | io::FieldSet::gradient; }
  io::Sample sample(const Vec3& position_mm, io::FieldSet wanted) const noexcept override;

  const Phantom& phantom() const noexcept { return phantom_; }

 private:
  Phantom phantom_;
  double softness_;
  Vec3 lower_;
  Vec3 upper_;
};

}  // namespace palpate::testdata

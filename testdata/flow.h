#pragma once

/// The virtual wind tunnel: potential flow past a sphere, exactly. Source: Batchelor, "An Introduction to Fluid
/// Dynamics" (1967), section 6.8 (the potential) and 6.2 (Bernoulli's theorem).

#include "io/fields/field_source.h"

namespace palpate::testdata {

struct FlowPastSphere {
  io::Vec3 center{0};             ///< mm
  double radius = 20;             ///< mm
  io::Vec3 free_stream{1, 0, 0};  ///< velocity far away, m/s
  double density = 1.2;           ///< kg/m^3
  double half_width = 100;        ///< mm: the tunnel is a cube about the center, and there is nothing outside it
};

/// vector: the velocity, m/s. value: the pressure above that of the free stream, Pa. gradient: the pressure's, Pa/mm.
/// The sphere and what is beyond the tunnel's walls are outside.
class FlowSource : public io::FieldSource {
 public:
  /// Throws std::invalid_argument for a radius not above 0.
  explicit FlowSource(const FlowPastSphere& flow);

  io::FieldSet available() const noexcept override {
    return io::FieldSet::value | io::FieldSet::gradient | io::FieldSet::vector;
  }
  io::Sample sample(const io::Vec3& position_mm, io::FieldSet wanted) const noexcept override;

 private:
  FlowPastSphere flow_;
};

}  // namespace palpate::testdata

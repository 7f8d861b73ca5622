#include "testdata/flow.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <stdexcept>

namespace palpate::testdata {

FlowSource::FlowSource(const FlowPastSphere& flow) : flow_(flow) {
  if (!(flow.radius > 0)) {
    throw std::invalid_argument("flow past a sphere: the radius has to be above 0 mm");
  }
}

io::Sample FlowSource::sample(const io::Vec3& position_mm, io::FieldSet wanted) const noexcept {
  using io::Vec3;
  io::Sample s;
  const Vec3 r = position_mm - flow_.center;
  const double r2 = glm::dot(r, r);
  const Vec3 off = glm::abs(r);
  if (!(r2 >= flow_.radius * flow_.radius) || off.x > flow_.half_width || off.y > flow_.half_width ||
      off.z > flow_.half_width) {
    return s;
  }
  s.inside = true;
  // Potential U . r (1 + a^3 / 2 r^3): its gradient is the velocity, its Hessian (symmetric) the velocity's Jacobian.
  const Vec3& stream = flow_.free_stream;
  const double length = glm::length(r);
  const double a3 = flow_.radius * flow_.radius * flow_.radius / (2 * length * r2);
  const double along = glm::dot(stream, r);
  const Vec3 velocity = (1 + a3) * stream - (3 * a3 * along / r2) * r;
  if (contains(wanted, io::FieldSet::vector)) {
    s.vector = velocity;
  }
  if (contains(wanted, io::FieldSet::value)) {
    s.value = 0.5 * flow_.density * (glm::dot(stream, stream) - glm::dot(velocity, velocity));
  }
  if (contains(wanted, io::FieldSet::gradient)) {
    // grad p = -rho J u, J u = -3 a3 / r^2 (U (r.u) + r (U.u) + (U.r) u) + 15 a3 (U.r)(r.u) / r^4 r
    const double r_u = glm::dot(r, velocity);
    const Vec3 acceleration = (-3 * a3 / r2) * (r_u * stream + glm::dot(stream, velocity) * r + along * velocity) +
                              (15 * a3 * along * r_u / (r2 * r2)) * r;
    s.gradient = -flow_.density * acceleration;
  }
  return s;
}

}  // namespace palpate::testdata

#pragma once

/// A primitive in coordinates relative to the probe, as the solvers read it. Directions are taken as exact, so one of
/// length 1 + 1e-15 is not rounded.

#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <span>

#include "solver/exact/double_double.h"
#include "solver/primitive.h"

namespace palpate::solver::internal {

/// Not initialized by default: solvers keep short arrays of these on the stack.
struct Placed {
  PrimitiveType type;
  double strength;  ///< N
  FineVec3 offset;  ///< position - probe, m, exact; not set for a directed force
  /// Of length 0.5 to 3.5: the direction given times a power of two. This and the next two are not set for a point.
  Vec3 given_direction;
  Vec3 direction;       ///< of length 1, except for rounding
  double given_length;  ///< of given_direction, except for rounding
};

/// Writes into `placed`: a value that is returned and then copied costs time.
void place(const Primitive& primitive, const Vec3& probe, Placed& placed);

/// The primitives of a balance: placed in advance into an array, or else each time that one is read.
class PlacedPrimitives {
 public:
  PlacedPrimitives(std::span<const Primitive> primitives, const Vec3& probe) : primitives_(primitives), probe_(probe) {}
  explicit PlacedPrimitives(std::span<const Placed> stored) : stored_(stored) {}

  std::size_t size() const { return stored_.empty() ? primitives_.size() : stored_.size(); }
  /// room: where the primitive is put if it is not stored.
  const Placed& at(std::size_t i, Placed& room) const {
    if (!stored_.empty()) {
      return stored_[i];
    }
    place(primitives_[i], probe_, room);
    return room;
  }

 private:
  std::span<const Primitive> primitives_;
  Vec3 probe_{0};
  std::span<const Placed> stored_;
};

/// Length without under- or overflow.
double scaled_length_of(const Vec3& v);
inline double length_of(const Vec3& v) {
  const double squared = glm::dot(v, v);
  return squared > 1e-280 && squared < 1e280 ? std::sqrt(squared) : scaled_length_of(v);
}

/// Sum of the components' magnitudes.
inline double size_of(const FineVec3& v) {
  return std::abs(v.x.hi) + std::abs(v.y.hi) + std::abs(v.z.hi);
}

bool same(const FineVec3& a, const FineVec3& b);

/// The relative rounding of a difference and its scalar product in double, with a margin.
inline constexpr double rough_rounding = 0x1p-50;

// In double-double if cancellation requires it.

/// The vector from z (relative to the probe, m) to the nearest point of a line or point, and its largest error.
struct Miss {
  FineVec3 vector;
  double length = 0;
  double error = 0;
};
Miss fine_miss_of(const Placed& line_or_point, const FineVec3& z);
inline Miss miss_of(const Placed& line_or_point, const FineVec3& z) {
  const Vec3 e = line_or_point.offset.hi() - z.hi();
  const Vec3& q = line_or_point.direction;
  const Vec3 rough = line_or_point.type == PrimitiveType::point ? e : e - q * glm::dot(q, e);
  const double length = length_of(rough);
  const double size = size_of(line_or_point.offset) + size_of(z);
  if (4 * length > size) {
    return {fine(rough), length, rough_rounding * size};
  }
  return fine_miss_of(line_or_point, z);
}

/// The rounding of quick_miss_of(), relative to the distance from z to the primitive's position. A miss shorter than
/// quick_part of that distance is computed in double-double.
inline constexpr double quick_rounding = 0x1p-49;
inline constexpr double quick_part = 0.25;

/// The same with an error that is small relative to the distance from z to the primitive's position: a difference of
/// two double-doubles rounded to a double is nearly exact. Takes a quarter of the time if the probe is not far away.
inline Miss quick_miss_of(const Placed& line_or_point, const FineVec3& z) {
  const FineVec3& o = line_or_point.offset;
  const Vec3 e{(o.x.hi - z.x.hi) + (o.x.lo - z.x.lo), (o.y.hi - z.y.hi) + (o.y.lo - z.y.lo),
               (o.z.hi - z.z.hi) + (o.z.lo - z.z.lo)};
  const Vec3& q = line_or_point.direction;
  const Vec3 quick = line_or_point.type == PrimitiveType::point ? e : e - q * glm::dot(q, e);
  const double length = length_of(quick);
  const double distance = std::abs(e.x) + std::abs(e.y) + std::abs(e.z);
  return length > quick_part * distance ? Miss{fine(quick), length, quick_rounding * distance}
                                        : fine_miss_of(line_or_point, z);
}

/// (position - z) . direction of a plane, positive behind it.
struct Depth {
  double value = 0;
  double error = 0;
};
Depth fine_depth_of(const Placed& plane, const FineVec3& z);
inline Depth depth_of(const Placed& plane, const FineVec3& z) {
  const double rough = glm::dot(plane.offset.hi() - z.hi(), plane.direction);
  const double error = rough_rounding * (size_of(plane.offset) + size_of(z));
  return std::abs(rough) > 0x1p20 * error ? Depth{rough, error} : fine_depth_of(plane, z);
}

}  // namespace palpate::solver::internal

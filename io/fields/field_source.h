#pragma once

/// The input of the haptic modes: fields sampled at one point of patient space (LPS, mm). A scan is one source
/// (VolumeFields); an analytic phantom or a flow is another.

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <string>

namespace palpate::io {

using Vec3 = glm::dvec3;

/// The fields a source may offer and a scene may ask for: a set of flags.
enum class FieldSet : std::uint8_t {
  none = 0,
  value = 1,      ///< the scan's value: HU for CT, the stored unit for others
  gradient = 2,   ///< of the value, per mm
  vector = 4,     ///< a vector field, such as a velocity
  tube = 8,       ///< the eigenvector of least curvature of the value's Hessian
  low_high = 16,  ///< the values on both sides of the nearest boundary
  distance = 32   ///< from the surfaces of structures (structures/structure.h)
};
constexpr FieldSet operator|(FieldSet a, FieldSet b) {
  return static_cast<FieldSet>(static_cast<unsigned>(a) | static_cast<unsigned>(b));
}
constexpr FieldSet operator&(FieldSet a, FieldSet b) {
  return static_cast<FieldSet>(static_cast<unsigned>(a) & static_cast<unsigned>(b));
}
constexpr bool contains(FieldSet set, FieldSet wanted) {
  return (set & wanted) == wanted;
}

/// The most structures of a scene that its modes may read.
inline constexpr std::size_t most_structures = 8;

/// The distance from the surface of a structure.
struct Distance {
  double mm = 0;     ///< positive inside
  Vec3 gradient{0};  ///< per mm, along patient axes: inward, of about unit length
};

/// The distances from the surfaces of a source's structures, in its order; zero for structures that it lacks. Only
/// those present are set and copied: eight take 256 bytes, and each sub-step of a tick copies its sample several times.
class Distances {
 public:
  Distances() noexcept {}
  Distances(const Distances& other) noexcept { *this = other; }
  Distances& operator=(const Distances& other) noexcept {
    size_ = other.size_;
    for (std::size_t n = 0; n < size_; ++n) of_[n] = other.of_[n];
    return *this;
  }
  ~Distances() = default;

  Distance operator[](std::size_t n) const noexcept { return n < size_ ? of_[n] : Distance{}; }
  /// For writing. Entries before it that are not yet set become zero. n: less than most_structures.
  Distance& operator[](std::size_t n) noexcept {
    while (size_ <= n) of_[size_++] = Distance{};
    return of_[n];
  }

 private:
  std::size_t size_ = 0;
  union {  // not set by the constructor
    std::array<Distance, most_structures> of_;
  };
};

/// Fields at a point. Outside the data (beyond the volume, in padding) `inside` is false and all else is zero: there is
/// no force there.
struct Sample {
  bool inside = false;
  double value = 0;
  Vec3 gradient{0};  ///< per mm, along patient axes
  Vec3 vector{0};    ///< along patient axes, in the source's unit
  Vec3 tube{0};      ///< unit vector along the tube, or zero
  double low = 0;    ///< value on the thinner side of the boundary
  double high = 0;   ///< value on the denser side
  /// Whether the gradient was read from a precomputed brick. If not, it was computed directly at this point: slower,
  /// with the same bits.
  bool from_brick = false;
  Distances distance;
};

class FieldSource {
 public:
  FieldSource() = default;
  FieldSource(const FieldSource&) = delete;
  FieldSource& operator=(const FieldSource&) = delete;
  virtual ~FieldSource() = default;

  /// Fields that sample() can give.
  virtual FieldSet available() const noexcept = 0;
  /// The wanted fields at a point (mm). Called in the servo tick: no lock, exception or system call. Other fields are
  /// neither computed nor read.
  virtual Sample sample(const Vec3& position_mm, FieldSet wanted) const noexcept = 0;
};

}  // namespace palpate::io

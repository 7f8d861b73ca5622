#pragma once

/// A haptic mode: it turns the fields sampled at a place into primitives there. Each mode has one file
/// (<name>_mode.cpp), and one name in modes/CMakeLists.txt.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "io/fields/field_source.h"
#include "modes/scene/scene.h"
#include "modes/scene/strength.h"
#include "solver/primitive.h"

namespace palpate::modes {

/// The direction of a mode's constraint. It decides which combinations the analytical solver can solve (plan.h).
enum class Axis : std::uint8_t { none, gradient, vector, tube, own, structure };

/// The primitives that a mode places.
struct Footprint {
  solver::PrimitiveType primitive = solver::PrimitiveType::directed_force;
  Axis axis = Axis::none;
  bool co_located = true;  ///< placed at the anchor with all the others; false: at its own place
  int structure = -1;      ///< for Axis::structure: which structure
};

/// Keys of a scene's mode that a type of mode reads, beside type, name, enabled and color: a set of flags.
enum class Key : std::uint8_t {
  none = 0,
  strength = 1,
  gates = 2,
  side = 4,
  direction_of = 8,
  tissues = 16,
  landmark = 32,   ///< shape, position_mm, direction
  structure = 64,  ///< structure and level_mm: in place of the scan's own boundary
  margin = 128     ///< structure and margin_mm
};
constexpr Key operator|(Key a, Key b) {
  return static_cast<Key>(static_cast<unsigned>(a) | static_cast<unsigned>(b));
}
constexpr bool contains(Key set, Key wanted) {
  return (static_cast<unsigned>(set) & static_cast<unsigned>(wanted)) == static_cast<unsigned>(wanted);
}

struct ModeType;

/// A mode of a plan: checked, with its strength in the form for the tick.
struct ActiveMode {
  const ModeType* type = nullptr;
  std::size_t scene_index = 0;  ///< its index in the scene's modes
  bool co_located = true;       ///< placed at the anchor, and only inside the data
  bool holds = false;           ///< a surface: while it holds the proxy, the anchor keeps to the iso-surface
  Strength strength;
  Side side = Side::entering;
  DirectionField direction_of = DirectionField::vector;
  int structure =
      -1;  ///< index in Sample::distance of the structure whose edge it follows; -1: the scan's own boundary
  double level_mm = 0;
  double margin_mm = 3;
  double push_share = 0;  ///< the part of its strength in the directed force; the rest only resists (keep_out)
  Shape shape = Shape::point;
  Vec3 position_mm{0};
  Vec3 direction{0, 0, 1};
};

/// The place at which a mode puts its primitives.
struct Place {
  const io::Sample& sample;    ///< at the old proxy, patient space
  const Workspace& workspace;  ///< rotates directions into the device's frame
  Vec3 anchor_m{0};            ///< the place of all co-located primitives, device's frame
  /// The place of the planes of each structure's surface. All other primitives are at the anchor.
  std::span<const Vec3> structure_anchor_m;
};

/// The primitives that modes place in a tick: a list of fixed capacity.
class PrimitiveList {
 public:
  /// The most that one mode may place (surface on both sides).
  static constexpr std::size_t most_of_a_mode = 2;

  PrimitiveList(std::span<solver::Primitive> room, std::span<std::uint8_t> mode_of) noexcept
      : room_(room), mode_of_(mode_of) {}
  void set_mode(std::uint8_t mode) noexcept { mode_ = mode; }
  /// Multiplies the strength of primitives added from here on.
  void set_weight(double weight) noexcept { weight_ = weight; }
  /// A primitive without strength is not added. A mode must not add one without a direction.
  void add(const solver::Primitive& primitive) noexcept {
    // make_plan() checks the capacity; this is a second check.
    const double strength = weight_ * primitive.strength;
    if (!(strength > 0) || size_ == room_.size()) {
      return;
    }
    room_[size_] = primitive;
    room_[size_].strength = strength;
    mode_of_[size_] = mode_;
    ++size_;
  }
  std::size_t size() const noexcept { return size_; }

 private:
  std::span<solver::Primitive> room_;
  std::span<std::uint8_t> mode_of_;
  std::size_t size_ = 0;
  std::uint8_t mode_ = 0;
  double weight_ = 1;
};

/// A type of mode: constant data and functions.
struct ModeType {
  std::string_view name;             ///< as in scenes
  std::string_view summary;          ///< one line for people: what it feels like
  Key keys = Key::none;              ///< the keys of a scene's mode that it reads
  Datum strength_of = Datum::value;  ///< the datum of its strength if the scene names none
  /// Whether a session may begin at a place where it is felt. False for friction, which is felt everywhere, and
  /// landmarks.
  bool finds_places = true;
  double margin_side = 1;  ///< for Key::margin: 1: the margin lies outside the structure; -1: inside
  /// Fields that it samples beside those that its strength and gates read.
  io::FieldSet (*reads)(const Mode& mode) = nullptr;
  Footprint (*footprint)(const Mode& mode) = nullptr;
  /// Adds its primitives. Called in the tick: no allocation, lock, log or exception.
  void (*place)(const ActiveMode& mode, const Place& place, PrimitiveList& primitives) noexcept = nullptr;
};

/// All types of mode, by name.
std::span<const ModeType* const> mode_types();
/// Null if no type has that name.
const ModeType* find_mode_type(std::string_view name);
/// Whether the type of a scene's mode reads that key, such as Key::tissues for boundaries. False for an unknown type.
bool reads_key(const Mode& mode, Key key);
/// "follow, force, ...": for messages.
std::string mode_type_names();

}  // namespace palpate::modes

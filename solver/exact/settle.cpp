#include "solver/exact/settle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <new>

namespace palpate::solver::internal {

namespace {

// Below this sine two directions count as parallel: what is left of their angle is left to the slack of the law.
constexpr double parallel_sine = 0x1p-44;

// The few primitives that may hold a proxy, placed: more of them add no more than tightness.
struct Holding {
  std::array<Placed, 32> placed;
  std::array<std::uint32_t, 32> index;
  std::size_t count = 0;

  void add(const Placed& primitive, std::size_t i) {
    placed[count] = primitive;
    index[count++] = static_cast<std::uint32_t>(i);
  }
  bool is_full() const { return count == placed.size(); }
  std::span<const Placed> all() const { return std::span(placed).first(count); }
};

// A point, else a line, else the plane with the largest angle to what is locked.
bool lock_best(const Holding& holding, ActiveSet& active) {
  const int count = active.count;
  const int rank = active.rank;
  std::uint32_t best = 0;
  double best_size = 0;
  for (std::uint32_t i = 0; i < holding.count; ++i) {
    const PrimitiveType type = holding.placed[i].type;
    double size = 0;
    if (type == PrimitiveType::plane) {
      active.count = count;
      active.rank = rank;
      if (!active.has(i) && lock(active, holding.all(), i)) {
        size = std::abs(active.size[count]);
      }
    } else if (type == PrimitiveType::point && count == 0) {
      active.rank = rank;
      active.count = count;
      return lock(active, holding.all(), i);
    } else if (count == 0) {
      size = 3;
    }
    if (size > best_size && size > parallel_sine) {
      best_size = size;
      best = i;
    }
  }
  active.count = count;
  active.rank = rank;
  return best_size > 0 && lock(active, holding.all(), best);
}

// Two lines of one position meet there and nowhere else.
bool meets_another_line(const Holding& holding, const ActiveSet& active, std::uint32_t& other) {
  if (active.count != 1 || active.rank != 2) {
    return false;
  }
  const Placed& line = holding.placed[active.locked[0]];
  for (other = 0; other < holding.count; ++other) {
    const Placed& placed = holding.placed[other];
    if (placed.type == PrimitiveType::line && other != active.locked[0] && same(placed.offset, line.offset) &&
        length_of(glm::cross(placed.direction, line.direction)) > parallel_sine) {
      return true;
    }
  }
  return false;
}

Flat settle(const Holding& holding, FineVec3& z) {
  ActiveSet active;
  Flat flat;
  if (!lock_best(holding, active)) {
    return flat;
  }
  std::uint32_t other = 0;
  bool one_position = meets_another_line(holding, active, other);
  if (one_position) {
    flat.chosen[flat.count++] = holding.index[other];
  } else {
    while (active.rank < 3 && lock_best(holding, active)) {
    }
  }
  const FineVec3& first = holding.placed[active.locked[0]].offset;
  for (int j = 0; j < active.count; ++j) {
    flat.chosen[flat.count++] = holding.index[active.locked[j]];
    one_position = (one_position || active.rank == 3) && same(first, holding.placed[active.locked[j]].offset);
  }
  if (one_position) {
    z = first;
  } else {
    settle(active, holding.all(), z);
    flat.doubt = doubt_of(active, holding.all(), z);
  }
  return flat;
}

// Shares of no more primitives than this are kept.
constexpr std::size_t few = 16;

Bound law_at(const PlacedPrimitives& primitives, double stiffness, const FineVec3& z, const Flat& flat,
             std::span<const Vec3> forces) {
  const Bound bound = bound_at(primitives, stiffness, z, flat, forces);
  return std::isfinite(bound.error) ? bound : bound_at(primitives, stiffness, z, flat, forces, true);
}

bool has_full_size(const Placed& primitive, const Vec3& force) {
  return (primitive.type == PrimitiveType::line || primitive.type == PrimitiveType::point) &&
         length_of(force) >= primitive.strength * (1 - 8 * unit_roundoff);
}

// Moves z within the flat to where the attractor's direction is that of its force: by the rounding of z, which close to
// the attractor turns the direction by far more than that of the force.
void align(const Placed& attractor, const Vec3& force, const ActiveSet& active, FineVec3& z) {
  const Miss miss = miss_of(attractor, z);
  const Vec3 step = (miss.vector - fine(force * (miss.length / length_of(force)))).hi();
  z = z + within(active, fine(step));
}

}  // namespace

Settled settle_on(const ActiveSet& active, std::span<const Placed> placed, double stiffness, const FineVec3& z,
                  std::span<const Vec3> forces) {
  Settled settled{z, {}};
  Flat flat;
  for (int j = 0; j < active.count; ++j) {
    flat.chosen[flat.count++] = active.locked[j];
  }
  settle(active, placed, settled.z);
  flat.doubt = doubt_of(active, placed, settled.z);
  settled.bound = bound_at(PlacedPrimitives(placed), stiffness, settled.z, flat, forces);
  return settled;
}

Settled settle_and_bound(const PlacedPrimitives& primitives, double stiffness, const FineVec3& z,
                         std::span<const Vec3> forces) {
  Holding held;
  Holding inside;  // those of the held whose force is not at its limit
  std::uint32_t slipping = 0;
  int slips = 0;
  Placed room;
  std::array<Contribution, few> shares;
  Contribution another;
  for (std::size_t i = 0; i < primitives.size() && !held.is_full(); ++i) {
    const Placed& primitive = primitives.at(i, room);
    // Made in place: a copy of what was written just now waits for it.
    const Contribution& share =
        *new (i < few ? &shares[i] : &another) Contribution(share_of(primitive, z, forces[i], stiffness));
    const bool is_slipping = share.slack > 0 && has_full_size(primitive, forces[i]);
    if (is_slipping) {
      slipping = static_cast<std::uint32_t>(i);
      ++slips;
    }
    if (share.held) {
      held.add(primitive, i);
      if (!is_slipping) {
        inside.add(primitive, i);
      }
    }
  }
  Settled settled{z, {}};
  if (held.count == 0 && primitives.size() <= few) {
    settled.bound = bound_of(std::span(shares).first(primitives.size()), stiffness, z);
    if (std::isfinite(settled.bound.error) && slips != 1) {
      return settled;
    }
  }
  const Flat flat = settle(held, settled.z);
  settled.bound = law_at(primitives, stiffness, settled.z, flat, forces);
  if (slips == 1) {
    // Between sticking and slipping, where friction rests for as long as the probe does, the proxy is nearly but not
    // quite on one attractor, which pulls with all its strength.
    Settled free{z, {}};
    ActiveSet active;
    while (active.rank < 3 && lock_best(inside, active)) {
    }
    Flat rest;
    for (int j = 0; j < active.count; ++j) {
      rest.chosen[rest.count++] = inside.index[active.locked[j]];
    }
    settle(active, inside.all(), free.z);
    align(primitives.at(slipping, room), forces[slipping], active, free.z);
    rest.doubt = doubt_of(active, inside.all(), free.z);
    free.bound = law_at(primitives, stiffness, free.z, rest, forces);
    if (free.bound.backward_error < settled.bound.backward_error) {
      return free;
    }
  }
  return settled;
}

}  // namespace palpate::solver::internal

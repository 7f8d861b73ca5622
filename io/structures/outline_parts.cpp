#include "io/structures/outline_parts.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <map>
#include <numeric>

namespace palpate::io {
namespace {

using internal::DistanceParts;

/// Union of sets, by the smallest member.
class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), std::uint32_t{0}); }
  std::uint32_t root(std::uint32_t n) {
    while (parent_[n] != n) n = parent_[n] = parent_[parent_[n]];
    return n;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = root(a);
    b = root(b);
    if (a != b) parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

/// The nodes of a field's bricks. A brick that is not kept is one piece: all of it lies on one side.
class Pieces {
 public:
  explicit Pieces(const DistanceParts& parts)
      : parts_(parts),
        nodes_(parts.near.count() * NodeBricks::nodes),
        sets_(1 + nodes_ + parts.near.slot.size()),
        missing_mm_(parts.near.slot.size(), 0.0F) {
    for_missing([&](const glm::ivec3& at, std::size_t n) {
      const NodeLattice& lattice = parts_.near.lattice;
      missing_mm_[n] = static_cast<float>(
          parts_.sample_far(lattice.position(Vec3(at * NodeBricks::edge) + 0.5 * (NodeBricks::edge - 1))).mm);
    });
    join_all();
  }

  std::uint32_t root_of(const glm::ivec3& node) { return sets_.root(piece_of(node)); }
  double mm(const glm::ivec3& node) const {
    const glm::ivec3 brick(node.x >> 3, node.y >> 3, node.z >> 3);
    if (!holds(brick)) return -1;
    const std::int32_t slot = parts_.near.slot_at(brick.x, brick.y, brick.z);
    if (slot < 0) return missing_mm_[brick_at(brick)];
    return stored(slot, node - brick * NodeBricks::edge);
  }
  std::uint32_t outside() { return sets_.root(0); }

  /// Calls `work` with each piece's root, number of nodes, a node of it and its distance.
  template <typename Work>
  void for_each(const Work& work) {
    for (std::size_t slot = 0; slot < parts_.near.count(); ++slot) {
      for (int n = 0; n < static_cast<int>(NodeBricks::nodes); ++n) {
        const glm::ivec3 in(n % 8, n / 8 % 8, n / 64);
        const glm::ivec3 node = parts_.near.place[slot] * NodeBricks::edge + in;
        work(root_of(node), std::size_t{1}, node, stored(static_cast<std::int32_t>(slot), in));
      }
    }
    for_missing([&](const glm::ivec3& at, std::size_t n) {
      const glm::ivec3 middle = at * NodeBricks::edge + NodeBricks::edge / 2;
      work(root_of(middle), NodeBricks::nodes, middle, missing_mm_[n]);
    });
  }

 private:
  bool holds(const glm::ivec3& brick) const {
    const glm::ivec3& n = parts_.near.lattice.bricks;
    return brick.x >= 0 && brick.y >= 0 && brick.z >= 0 && brick.x < n.x && brick.y < n.y && brick.z < n.z;
  }
  std::size_t brick_at(const glm::ivec3& brick) const {
    const glm::ivec3& n = parts_.near.lattice.bricks;
    return (static_cast<std::size_t>(brick.z) * static_cast<std::size_t>(n.y) + static_cast<std::size_t>(brick.y)) *
               static_cast<std::size_t>(n.x) +
           static_cast<std::size_t>(brick.x);
  }
  double stored(std::int32_t slot, const glm::ivec3& in) const {
    constexpr std::ptrdiff_t row = DistanceParts::wide;
    return parts_.brick[static_cast<std::size_t>(slot)][((in.z + 1) * row + in.y + 1) * row + in.x + 1];
  }
  /// 0: all that lies around the bricks.
  std::uint32_t piece_of(const glm::ivec3& node) const {
    const glm::ivec3 brick(node.x >> 3, node.y >> 3, node.z >> 3);
    if (!holds(brick)) return 0;
    const std::int32_t slot = parts_.near.slot_at(brick.x, brick.y, brick.z);
    if (slot < 0) return static_cast<std::uint32_t>(1 + nodes_ + brick_at(brick));
    const glm::ivec3 in = node - brick * NodeBricks::edge;
    return static_cast<std::uint32_t>(1 + static_cast<std::size_t>(slot) * NodeBricks::nodes +
                                      NodeBricks::at(in.x, in.y, in.z));
  }
  template <typename Work>
  void for_missing(const Work& work) const {
    const glm::ivec3& count = parts_.near.lattice.bricks;
    std::size_t n = 0;
    for (int z = 0; z < count.z; ++z) {
      for (int y = 0; y < count.y; ++y) {
        for (int x = 0; x < count.x; ++x, ++n) {
          if (parts_.near.slot[n] < 0) work(glm::ivec3(x, y, z), n);
        }
      }
    }
  }
  void join_if_alike(const glm::ivec3& a, const glm::ivec3& b) {
    if ((mm(a) > 0) == (mm(b) > 0)) sets_.join(piece_of(a), piece_of(b));
  }
  void join_all() {
    for (std::size_t slot = 0; slot < parts_.near.count(); ++slot) {
      const glm::ivec3 corner = parts_.near.place[slot] * NodeBricks::edge;
      for (int n = 0; n < static_cast<int>(NodeBricks::nodes); ++n) {
        const glm::ivec3 in(n % 8, n / 8 % 8, n / 64);
        for (int axis = 0; axis < 3; ++axis) {
          glm::ivec3 aside(0);
          aside[axis] = 1;
          join_if_alike(corner + in, corner + in + aside);
          if (in[axis] == 0) join_if_alike(corner + in, corner + in - aside);
        }
      }
    }
    for_missing([&](const glm::ivec3& at, std::size_t) {
      const glm::ivec3 corner = at * NodeBricks::edge;
      for (int axis = 0; axis < 3; ++axis) {
        for (const int step : {-1, NodeBricks::edge}) {
          glm::ivec3 beside = corner;
          beside[axis] += step;
          const glm::ivec3 brick(beside.x >> 3, beside.y >> 3, beside.z >> 3);
          // One that is kept has joined its own nodes with this.
          if (!holds(brick) || parts_.near.slot_at(brick.x, brick.y, brick.z) < 0) join_if_alike(corner, beside);
        }
      }
    });
  }

  const DistanceParts& parts_;
  std::size_t nodes_;
  Sets sets_;
  std::vector<float> missing_mm_;
};

/// Which part's surface a place lies on: the hole behind it or the part before it.
std::uint32_t root_at(Pieces& pieces, const NodeLattice& lattice, const OutlinePlace& place,
                      const std::map<std::uint32_t, std::size_t>& number_of) {
  const Vec3 node = lattice.node_of(place.place_mm);
  const glm::ivec3 first(glm::floor(node));
  double nearest_inside = 1e9, nearest_outside = 1e9;
  std::uint32_t inside = 0, outside = 0;
  for (int n = 0; n < 64; ++n) {
    const glm::ivec3 at = first + glm::ivec3(n % 4, n / 4 % 4, n / 16) - 1;
    const Vec3 away = Vec3(at) - node;
    const double squared = away.x * away.x + away.y * away.y + away.z * away.z;
    double& nearest = pieces.mm(at) > 0 ? nearest_inside : nearest_outside;
    if (squared >= nearest) continue;
    nearest = squared;
    (pieces.mm(at) > 0 ? inside : outside) = pieces.root_of(at);
  }
  return number_of.contains(outside) ? outside : inside;
}

}  // namespace

std::vector<OutlinePart> outline_parts(const DistanceField& field, const std::vector<OutlinePlace>& places,
                                       std::vector<std::size_t>* of_place) {
  const DistanceParts& parts = field.parts();
  const NodeLattice& lattice = parts.near.lattice;
  Pieces pieces(parts);
  const double cell_mm3 = lattice.spacing.x * lattice.spacing.y * lattice.spacing.z;
  const std::uint32_t outside = pieces.outside();
  std::map<std::uint32_t, OutlinePart> by_root;
  pieces.for_each([&](std::uint32_t root, std::size_t nodes, const glm::ivec3& node, double mm) {
    if (root == outside) return;
    OutlinePart& part = by_root[root];
    part.is_hole = mm <= 0;
    part.volume_mm3 += static_cast<double>(nodes) * cell_mm3;
    if (std::abs(mm) <= part.depth_mm) return;
    part.depth_mm = std::abs(mm);
    part.deepest_mm = lattice.position(Vec3(node));
  });
  std::vector<std::pair<std::uint32_t, OutlinePart>> sorted(by_root.begin(), by_root.end());
  std::ranges::stable_sort(sorted, std::greater<>(), [](const auto& one) { return one.second.volume_mm3; });
  std::vector<OutlinePart> found;
  std::map<std::uint32_t, std::size_t> number_of;
  for (const auto& [root, part] : sorted) {
    number_of[root] = found.size();
    found.push_back(part);
  }
  if (of_place != nullptr) {
    of_place->clear();
    for (const OutlinePlace& place : places) {
      const auto number = number_of.find(root_at(pieces, lattice, place, number_of));
      of_place->push_back(number == number_of.end() ? 0 : number->second);
    }
  }
  return found;
}

}  // namespace palpate::io

#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <glm/geometric.hpp>

#include "io/messages.h"
#include "io/parallel.h"
#include "io/structures/cubic.h"
#include "io/structures/field_patch.h"

namespace palpate::io::internal {
namespace {

constexpr std::size_t stored_nodes = DistanceParts::nodes_of_a_brick;

/// The number stored in a brick of the box for a node of it or around it.
float number_of(const Patch& patch, const glm::ivec3& place, const float* stored, int i, int j, int k) {
  const NodeBricks& bricks = patch.bricks;
  const glm::ivec3 node = place * brick_edge + glm::ivec3(i, j, k);
  const glm::ivec3 of(node.x >> 3, node.y >> 3, node.z >> 3);
  const glm::ivec3 in = node - of * brick_edge;
  const std::int32_t slot = bricks.slot_at(of.x, of.y, of.z);
  const std::size_t measured =
      static_cast<std::size_t>(std::max(slot, 0)) * brick_nodes + NodeBricks::at(in.x, in.y, in.z);
  const bool is_new = slot >= 0 && patch.mm[measured] != patch.before_mm[measured];
  // Its own copy of a node beside it need not be the neighbor's.
  if (stored != nullptr && !is_new) return stored[stored_at(i, j, k)];
  if (slot >= 0) return patch.mm[measured];
  if (const float* beside = patch.stored(of); beside != nullptr) return beside[stored_at(in.x, in.y, in.z)];
  // For a new brick at the border of the measured ones: the number of its nearest node.
  const glm::ivec3 own = glm::clamp(glm::ivec3(i, j, k), glm::ivec3(0), glm::ivec3(brick_edge - 1));
  const std::size_t nearest = static_cast<std::size_t>(bricks.slot_at(place.x, place.y, place.z)) * brick_nodes +
                              NodeBricks::at(own.x, own.y, own.z);
  const Vec3f& point = patch.closest[nearest];
  if (point.x == nowhere) return patch.mm[nearest];
  return std::copysign(glm::distance(Vec3f(node) * Vec3f(bricks.lattice.spacing), point), patch.f[nearest]);
}

/// A brick's nodes and those around it, in storage order. False if they are unchanged.
bool fill(const Patch& patch, const glm::ivec3& place, float* into) {
  const float* stored = patch.stored(place);
  for (int k = -1; k < brick_edge + 2; ++k) {
    for (int j = -1; j < brick_edge + 2; ++j) {
      for (int i = -1; i < brick_edge + 2; ++i) into[stored_at(i, j, k)] = number_of(patch, place, stored, i, j, k);
    }
  }
  return stored == nullptr || std::memcmp(stored, into, stored_nodes * sizeof(float)) != 0;
}

/// The bricks to be stored again: those measured, and existing ones beside them.
std::vector<glm::ivec3> bricks_to_store(const Patch& patch, double kept_within_mm, std::vector<glm::ivec3>& dropped) {
  std::vector<glm::ivec3> stored;
  std::vector<char> seen(patch.bricks.slot.size(), 0);
  for (std::size_t slot = 0; slot < patch.bricks.count(); ++slot) {
    const glm::ivec3 place = patch.bricks.place[slot];
    seen[patch.box_at(place)] = 1;
    const float* mm = patch.mm.data() + slot * brick_nodes;
    const bool near =
        std::any_of(mm, mm + brick_nodes, [&](float at) { return std::abs(static_cast<double>(at)) < kept_within_mm; });
    if (near) {
      stored.push_back(place);
    } else if (patch.stored(place) != nullptr) {
      dropped.push_back(place);
    }
  }
  const std::size_t measured = patch.bricks.count();
  for (std::size_t slot = 0; slot < measured; ++slot) {
    for (int n = 0; n < 27; ++n) {
      const glm::ivec3 place = patch.bricks.place[slot] + glm::ivec3(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
      if (!patch.holds(place) || seen[patch.box_at(place)] != 0) continue;
      seen[patch.box_at(place)] = 1;
      if (patch.stored(place) != nullptr) stored.push_back(place);
    }
  }
  return stored;
}

/// Makes the field's table of bricks large enough for the box.
void grow(DistanceParts& parts, const glm::ivec3& low, const glm::ivec3& high) {
  NodeBricks& near = parts.near;
  const glm::ivec3 before = glm::max(-low, glm::ivec3(0));
  const glm::ivec3 size = glm::max(near.lattice.bricks, high) + before;
  if (size == near.lattice.bricks) return;
  near.lattice.origin = near.lattice.position(-Vec3(before * brick_edge));
  near.lattice.bricks = size;
  parts.shift += before * brick_edge;
  near.slot.assign(
      static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) * static_cast<std::size_t>(size.z),
      NodeBricks::outside);
  for (std::size_t n = 0; n < near.place.size(); ++n) {
    glm::ivec3& place = near.place[n];
    place += before;
    near.slot[(static_cast<std::size_t>(place.z) * static_cast<std::size_t>(size.y) +
               static_cast<std::size_t>(place.y)) *
                  static_cast<std::size_t>(size.x) +
              static_cast<std::size_t>(place.x)] = static_cast<std::int32_t>(n);
  }
}

}  // namespace

double measured_at(const Patch& patch, const Vec3& place_mm) {
  const Vec3 node = patch.bricks.lattice.node_of(place_mm), base = glm::floor(node);
  const glm::ivec3 cell(base), place(cell.x >> 3, cell.y >> 3, cell.z >> 3), in = cell - place * brick_edge;
  const float* stored = patch.stored(place);
  if (stored == nullptr && patch.bricks.slot_at(place.x, place.y, place.z) < 0) {
    return patch.old.sample_nearest(place_mm).mm;
  }
  std::array<float, 64> around;
  for (int n = 0; n < 64; ++n) {
    around.data()[n] = number_of(patch, place, stored, in.x - 1 + n % 4, in.y - 1 + n / 4 % 4, in.z - 1 + n / 16);
  }
  return cubic_sample(around.data(), 4, 16, node - base).value;
}

void add_to_measured(Patch& patch, const RadialBumps& bumps, int threads) {
  parallel_for(
      patch.bricks.count(),
      [&](std::size_t slot) {
        const glm::ivec3& place = patch.bricks.place[slot];
        const auto& near = patch.near[patch.box_at(place)];
        if (near.empty()) return;
        std::array<double, brick_nodes> added{};
        add_at_nodes(bumps, near, patch.bricks.lattice, place, added);
        for (std::size_t n = 0; n < brick_nodes; ++n) {
          const std::size_t at = slot * brick_nodes + n;
          if (patch.mm[at] != patch.before_mm[at]) patch.mm[at] = static_cast<float>(patch.mm[at] + added[n]);
        }
      },
      {}, threads);
}

DistanceParts stored(const Patch& patch, int threads) {
  std::vector<glm::ivec3> dropped;
  std::vector<glm::ivec3> places = bricks_to_store(patch, patch.old.kept_within_mm(), dropped);
  std::vector<float> filled(places.size() * stored_nodes);
  std::vector<char> differs(places.size());
  parallel_for(
      places.size(),
      [&](std::size_t n) { differs[n] = fill(patch, places[n], filled.data() + n * stored_nodes) ? 1 : 0; }, {},
      threads);
  std::vector<float> numbers;
  std::vector<glm::ivec3> changed;
  for (std::size_t n = 0; n < places.size(); ++n) {
    if (differs[n] == 0) continue;
    changed.push_back(places[n]);
    const float* first = filled.data() + n * stored_nodes;
    numbers.insert(numbers.end(), first, first + stored_nodes);
  }
  numbers.shrink_to_fit();
  DistanceParts parts = patch.old;
  glm::ivec3 low(0), high(0);
  for (const glm::ivec3& place : changed) {
    low = glm::min(low, patch.low + place);
    high = glm::max(high, patch.low + place + 1);
  }
  grow(parts, low, high);
  const glm::ivec3 to_new = patch.low + (parts.shift - patch.old.shift) / brick_edge;
  const auto entry = [&](const glm::ivec3& place) -> std::int32_t& {
    const glm::ivec3 at = place + to_new;
    const glm::ivec3& n = parts.near.lattice.bricks;
    return parts.near
        .slot[(static_cast<std::size_t>(at.z) * static_cast<std::size_t>(n.y) + static_cast<std::size_t>(at.y)) *
                  static_cast<std::size_t>(n.x) +
              static_cast<std::size_t>(at.x)];
  };
  const auto page = std::make_shared<const std::vector<float>>(std::move(numbers));
  for (std::size_t n = 0; n < changed.size(); ++n) {
    std::int32_t& slot = entry(changed[n]);
    if (slot < 0) {
      slot = static_cast<std::int32_t>(parts.near.count());
      parts.near.place.push_back(changed[n] + to_new);
      parts.brick.push_back(nullptr);
    }
    parts.brick[static_cast<std::size_t>(slot)] = page->data() + n * stored_nodes;
  }
  for (const glm::ivec3& place : dropped) {
    std::int32_t& slot = entry(place);
    const auto gone = static_cast<std::size_t>(slot);
    slot = NodeBricks::outside;
    if (gone + 1 < parts.near.count()) {  // the last one takes its slot
      parts.near.place[gone] = parts.near.place.back();
      parts.brick[gone] = parts.brick.back();
      entry(parts.near.place[gone] - to_new) = static_cast<std::int32_t>(gone);
    }
    parts.near.place.pop_back();
    parts.brick.pop_back();
  }
  if (parts.near.place.empty()) throw InvalidInput(say("edit-leaves-nothing"));
  parts.pages.push_back(page);
  std::erase_if(parts.pages, [&](const DistanceParts::Page& one) {
    const std::less_equal<> ordered;
    return std::ranges::none_of(parts.brick, [&](const float* at) {
      return ordered(one->data(), at) && !ordered(one->data() + one->size(), at);
    });
  });
  return parts;
}

}  // namespace palpate::io::internal

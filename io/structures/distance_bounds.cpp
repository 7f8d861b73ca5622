#include "io/structures/distance_bounds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "io/parallel.h"

namespace palpate::io {
namespace {

constexpr float known_to = 0.01F;  // of a voxel's diagonal: room for what is smooth

/// The bricks of one layer (eight planes of nodes).
struct Layer {
  std::vector<glm::ivec3> place;
  std::vector<float> lower, upper;
  std::vector<std::int32_t> kind;  ///< of every brick of the layer: inside, outside, or its number in `place`
};

/// Planes that a layer reads, computed once and dropped when no later layer needs them.
class PlaneWindow {
 public:
  explicit PlaneWindow(const OutlinePlanes& planes) : planes_(planes) {}

  /// Those within the band of a stretch of nodes: node along the third axis and distances.
  std::vector<std::pair<int, const PlaneDistances*>> near(int first_node, int last_node) {
    const int reach = static_cast<int>(std::ceil(planes_.band_mm / planes_.lattice.spacing.z));
    std::vector<std::pair<int, const PlaneDistances*>> found;
    for (std::size_t n = 0; n < planes_.node.size(); ++n) {
      if (planes_.node[n] < first_node - reach) {
        held_.erase(n);
      } else if (planes_.node[n] <= last_node + reach) {
        auto [entry, is_new] = held_.try_emplace(n);
        if (is_new) {
          planes_.compute(n, entry->second);
        }
        found.emplace_back(planes_.node[n], &entry->second);
      }
    }
    return found;
  }

 private:
  const OutlinePlanes& planes_;
  std::map<std::size_t, PlaneDistances> held_;
};

/// Squared distances of a brick's nodes to the inside and the outside.
struct BrickDistances {
  std::array<float, brick_nodes> to_inside;
  std::array<float, brick_nodes> to_outside;
  std::array<float, brick_nodes> known;  ///< mm; NaN where it is not
};

void nearest_of_planes(const std::vector<std::pair<int, const PlaneDistances*>>& near, const NodeLattice& lattice,
                       const glm::ivec3& brick, BrickDistances& distances) {
  distances.to_inside.fill(PlaneDistances::far);
  distances.to_outside.fill(PlaneDistances::far);
  distances.known.fill(std::numeric_limits<float>::quiet_NaN());
  const int columns = lattice.bricks.x * brick_edge;
  for (const auto& [node, plane] : near) {
    for (int k = 0; k < brick_edge; ++k) {
      const auto up = static_cast<float>((brick.z * brick_edge + k - node) * lattice.spacing.z);
      const float farther = up * up;
      for (int j = 0; j < brick_edge; ++j) {
        const auto first = static_cast<std::size_t>(brick.y * brick_edge + j) * static_cast<std::size_t>(columns) +
                           static_cast<std::size_t>(brick.x * brick_edge);
        const float* in = plane->to_inside.data() + first;
        const float* out = plane->to_outside.data() + first;
        if (brick.z * brick_edge + k == node && !plane->known.empty()) {
          std::copy_n(plane->known.data() + first, brick_edge, distances.known.data() + NodeBricks::at(0, j, k));
        }
        float* nearest_in = distances.to_inside.data() + NodeBricks::at(0, j, k);
        float* nearest_out = distances.to_outside.data() + NodeBricks::at(0, j, k);
        for (int i = 0; i < brick_edge; ++i) {
          nearest_in[i] = std::min(nearest_in[i], in[i] + farther);
          nearest_out[i] = std::min(nearest_out[i], out[i] + farther);
        }
      }
    }
  }
}

/// Adds the brick where the surface comes near; else says on which side it lies.
std::int32_t take_brick(const OutlinePlanes& planes, const glm::ivec3& brick, const BrickDistances& distances,
                        Layer& layer) {
  const auto band = static_cast<float>(planes.band_mm * planes.band_mm);
  bool near = false;
  float nearest_inside = PlaneDistances::far;
  float nearest_outside = PlaneDistances::far;
  for (std::size_t n = 0; n < brick_nodes; ++n) {
    near = near || std::max(distances.to_inside[n], distances.to_outside[n]) < band;
    nearest_inside = std::min(nearest_inside, distances.to_inside[n]);
    nearest_outside = std::min(nearest_outside, distances.to_outside[n]);
  }
  if (!near) {
    return nearest_inside < nearest_outside ? NodeBricks::inside : NodeBricks::outside;
  }
  const auto play = static_cast<float>(planes.play_mm);
  const Vec3& spacing = planes.lattice.spacing;
  // On its own side, and not on the surface itself.
  const float least = 0.01F * static_cast<float>(std::min({spacing.x, spacing.y, spacing.z}));
  for (std::size_t n = 0; n < brick_nodes; ++n) {
    const float in = std::sqrt(std::min(distances.to_inside[n], band));
    const float out = std::sqrt(std::min(distances.to_outside[n], band));
    float lower = -in;
    float upper = out;
    // Not where nothing is known around the node: beyond the lattice that was outlined on.
    if (out > play && in <= play) lower = std::max(lower, out - play);
    if (in > play && out <= play) upper = std::min(upper, play - in);
    if (const float known = distances.known[n]; !std::isnan(known)) {
      lower = std::max(lower, known - known_to * play);
      upper = std::min(upper, known + known_to * play);
    }
    if (in == 0) lower = std::max(lower, least);
    if (out == 0) upper = std::min(upper, -least);
    layer.lower.push_back(std::min(lower, upper));
    layer.upper.push_back(std::max(lower, upper));
  }
  layer.place.push_back(brick);
  return static_cast<std::int32_t>(layer.place.size() - 1);
}

Layer make_layer(const OutlinePlanes& planes, int z, PlaneWindow& window) {
  Layer layer;
  const NodeLattice& lattice = planes.lattice;
  const auto near = window.near(z * brick_edge, z * brick_edge + brick_edge - 1);
  BrickDistances distances;
  for (int y = 0; y < lattice.bricks.y; ++y) {
    for (int x = 0; x < lattice.bricks.x; ++x) {
      nearest_of_planes(near, lattice, {x, y, z}, distances);
      layer.kind.push_back(take_brick(planes, {x, y, z}, distances, layer));
    }
  }
  return layer;
}

}  // namespace

DistanceBounds bounds_of(const OutlinePlanes& planes, int threads) {
  const NodeLattice& lattice = planes.lattice;
  const auto layers = static_cast<std::size_t>(lattice.bricks.z);
  std::vector<Layer> made(layers);
  constexpr std::size_t layers_of_a_run = 4;  // what a run computes, the next layer in it reads again
  const std::size_t runs = (layers + layers_of_a_run - 1) / layers_of_a_run;
  internal::parallel_for(
      runs,
      [&](std::size_t run) {
        PlaneWindow window(planes);
        const std::size_t end = std::min(layers, (run + 1) * layers_of_a_run);
        for (std::size_t z = run * layers_of_a_run; z < end; ++z) {
          made[z] = make_layer(planes, static_cast<int>(z), window);
        }
      },
      {}, threads);
  DistanceBounds bounds;
  bounds.bricks.lattice = lattice;
  for (const Layer& layer : made) {
    const auto first = static_cast<std::int32_t>(bounds.bricks.count());
    for (const std::int32_t kind : layer.kind) {
      bounds.bricks.slot.push_back(kind < 0 ? kind : kind + first);
    }
    bounds.bricks.place.insert(bounds.bricks.place.end(), layer.place.begin(), layer.place.end());
    bounds.lower.insert(bounds.lower.end(), layer.lower.begin(), layer.lower.end());
    bounds.upper.insert(bounds.upper.end(), layer.upper.begin(), layer.upper.end());
  }
  return bounds;
}

}  // namespace palpate::io

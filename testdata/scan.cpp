#include "testdata/scan.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace palpate::testdata {
namespace {

constexpr double ct_intercept = -1024;
constexpr std::int16_t ct_padding = -2000;

/// splitmix64 (Steele, Lea and Flood 2014): noise by voxel number, so that it depends on nothing else.
std::uint64_t mix(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31);
}

double unit_normal(std::uint64_t seed, std::uint64_t number) {
  const std::uint64_t a = mix(mix(seed) ^ number);
  const std::uint64_t b = mix(a);
  constexpr double scale = 1.0 / 9007199254740992.0;  // 2^-53
  const double u = (static_cast<double>(a >> 11) + 0.5) * scale;
  const double v = static_cast<double>(b >> 11) * scale;
  return std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * v);
}

void check(const Grid& grid) {
  constexpr double tolerance = 1e-6;
  for (int axis = 0; axis < 3; ++axis) {
    if (grid.size[axis] < 1) {
      throw std::invalid_argument("grid: a size is below 1");
    }
    if (!(grid.spacing[axis] > 0)) {
      throw std::invalid_argument("grid: a spacing is not above 0 mm");
    }
  }
  if (std::abs(glm::length(grid.direction_i) - 1) > tolerance ||
      std::abs(glm::length(grid.direction_j) - 1) > tolerance ||
      std::abs(glm::dot(grid.direction_i, grid.direction_j)) > tolerance) {
    throw std::invalid_argument("grid: the directions are not perpendicular unit vectors");
  }
  if (std::abs(grid.tilt_degrees) >= 90) {
    throw std::invalid_argument("grid: a gantry does not tilt by 90 degrees or more");
  }
  if (2 * std::abs(grid.uneven_mm) >= grid.spacing.z) {
    throw std::invalid_argument("grid: uneven slices would change places");
  }
}

template <typename Stored>
void store(std::vector<Stored>& voxels, std::size_t at, double value) {
  if constexpr (std::is_integral_v<Stored>) {
    const double rounded = std::round(value);
    if (rounded < std::numeric_limits<Stored>::min() || rounded > std::numeric_limits<Stored>::max()) {
      throw std::range_error("scan: a value of " + std::to_string(value) + " does not fit in the stored type");
    }
    voxels[at] = static_cast<Stored>(rounded);
  } else {
    voxels[at] = static_cast<Stored>(value);
  }
}

template <typename Stored>
std::vector<Stored> voxelise(const Phantom& phantom, const io::Volume& volume, const Acquisition& acquisition) {
  const io::Geometry& g = volume.geometry;
  const Vec3 normal = glm::normalize(glm::cross(g.direction_i, g.direction_j));
  const double thickness =
      acquisition.slice_thickness > 0 ? acquisition.slice_thickness : std::abs(glm::dot(g.step, normal));
  const Vec3 edges[3] = {g.spacing_i * g.direction_i, g.spacing_j * g.direction_j, thickness * normal};
  const double middle_i = 0.5 * (g.dimensions.x - 1);
  const double middle_j = 0.5 * (g.dimensions.y - 1);
  std::vector<Stored> voxels(volume.offset(0, 0, g.dimensions.z));
  for (int k = 0; k < g.dimensions.z; ++k) {
    for (int j = 0; j < g.dimensions.y; ++j) {
      for (int i = 0; i < g.dimensions.x; ++i) {
        const std::size_t at = volume.offset(i, j, k);
        const double from_middle = std::hypot((i - middle_i) * g.spacing_i, (j - middle_j) * g.spacing_j);
        if (acquisition.circle_radius > 0 && from_middle > acquisition.circle_radius) {
          voxels[at] = static_cast<Stored>(ct_padding);
          continue;
        }
        const Vec3 center = g.slice_positions[static_cast<std::size_t>(k)] + static_cast<double>(i) * edges[0] +
                            static_cast<double>(j) * edges[1];
        double value = mean_value(phantom, center, edges);
        if (acquisition.noise > 0) {
          value += acquisition.noise * unit_normal(acquisition.seed, at);
        }
        store(voxels, at, (value - volume.intercept) / volume.slope);
      }
    }
  }
  return voxels;
}

}  // namespace

io::Geometry make_geometry(const Grid& grid) {
  check(grid);
  const glm::dquat lean = glm::angleAxis(glm::radians(grid.tilt_degrees), grid.direction_i);
  io::Geometry g;
  g.direction_i = grid.direction_i;
  g.direction_j = lean * grid.direction_j;
  g.spacing_i = grid.spacing.x;
  g.spacing_j = grid.spacing.y;
  const Vec3 table = glm::cross(grid.direction_i, grid.direction_j);
  const Vec3 corner = grid.center - 0.5 * ((grid.size.x - 1) * g.spacing_i * g.direction_i +
                                           (grid.size.y - 1) * g.spacing_j * g.direction_j +
                                           (grid.size.z - 1) * grid.spacing.z * table);
  for (int k = 0; k < grid.size.z; ++k) {
    if (std::find(grid.missing.begin(), grid.missing.end(), k) != grid.missing.end()) {
      const int before = static_cast<int>(g.slice_positions.size()) - 1;
      if (before >= 0 && (g.gaps.empty() || g.gaps.back() != before)) {
        g.gaps.push_back(before);
      }
      continue;
    }
    const double along = k * grid.spacing.z + (grid.uneven_mm == 0 ? 0 : grid.uneven_mm * std::sin(2.4 * k));
    g.slice_positions.push_back(corner + along * table);
  }
  const int slices = static_cast<int>(g.slice_positions.size());
  if (slices == 0) {
    throw std::invalid_argument("grid: every slice is missing");
  }
  if (!g.gaps.empty() && g.gaps.back() == slices - 1) {
    g.gaps.pop_back();
  }
  g.dimensions = {grid.size.x, grid.size.y, slices};
  g.step = slices > 1 ? (g.slice_positions.back() - g.slice_positions.front()) / static_cast<double>(slices - 1)
                      : grid.spacing.z * table;
  g.uniform = grid.uneven_mm == 0 && g.gaps.empty();
  return g;
}

Grid rotated(Grid grid, const Vec3& axis, double degrees) {
  const glm::dquat turn = glm::angleAxis(glm::radians(degrees), glm::normalize(axis));
  grid.direction_i = glm::normalize(turn * grid.direction_i);
  const Vec3 j = turn * grid.direction_j;
  grid.direction_j = glm::normalize(j - glm::dot(j, grid.direction_i) * grid.direction_i);
  return grid;
}

io::Volume scan(const Phantom& phantom, const io::Geometry& geometry, const Acquisition& acquisition) {
  io::Volume volume;
  volume.geometry = geometry;
  volume.unit = "HU";
  volume.modality = "CT";
  volume.intercept = acquisition.quantised ? ct_intercept : 0;
  if (acquisition.circle_radius > 0) {
    volume.padding = {ct_padding, ct_padding};
  }
  if (acquisition.quantised) {
    volume.voxels = voxelise<std::int16_t>(phantom, volume, acquisition);
  } else {
    volume.voxels = voxelise<float>(phantom, volume, acquisition);
  }
  return volume;
}

}  // namespace palpate::testdata

#include "modes/scene/regions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <span>
#include <type_traits>
#include <utility>
#include <variant>

#include "io/padding.h"
#include "io/parallel.h"

namespace palpate::modes::internal {
namespace {

constexpr double cell_mm = 2.5;
constexpr float most_air_hu = -400, most_empty_hu = -900;
constexpr float least_lung_hu = -960, most_lung_hu = -500;
constexpr double thick_mm = 15;
// Air in a body may be as thick as this, in a table not. Around it even a thin wall is the body's.
constexpr double thick_air_mm = 50;
// A thin thing that lies on the body is part of it, as an ear is, unless it is as long as a table.
constexpr double most_of_body_mm = 120;
constexpr float padding = std::numeric_limits<float>::quiet_NaN();

struct Grid {
  glm::ivec3 size{0};
  glm::dvec3 mm{1};  // of a cell
  std::array<bool, 3> has_sides{};
  std::vector<float> values;

  std::size_t count() const { return values.size(); }
  std::size_t step(int axis) const {
    const auto x = static_cast<std::size_t>(size.x), y = static_cast<std::size_t>(size.y);
    return axis == 0 ? 1 : axis == 1 ? x : x * y;
  }
  glm::ivec3 cell(std::size_t at) const {
    const auto x = static_cast<std::size_t>(size.x), y = static_cast<std::size_t>(size.y);
    return {static_cast<int>(at % x), static_cast<int>(at / x % y), static_cast<int>(at / (x * y))};
  }
  /// The six neighbors of a cell that are in the grid.
  template <class Use>
  void neighbors(std::size_t at, const Use& use) const {
    const glm::ivec3 here = cell(at);
    for (int axis = 0; axis < 3; ++axis) {
      if (here[axis] > 0) use(at - step(axis));
      if (here[axis] + 1 < size[axis]) use(at + step(axis));
    }
  }
};

struct CellSum {
  double sum = 0;
  int count = 0;
};

/// Adds a row of voxels to its cells, those left out that are padding or no number.
template <typename Stored>
void add_row(const io::Volume& volume, const Stored* stored, int count, int per_cell,
             const io::internal::StoredPadding<Stored>& padding_of, CellSum* cell) {
  for (int i = 0; i < count; ++cell) {
    for (const int end = std::min(i + per_cell, count); i < end; ++i) {
      const double value = volume.slope * static_cast<double>(stored[i]) + volume.intercept;
      const bool counts = padding_of(stored[i]) == 0 && std::isfinite(value);
      cell->sum += counts ? value : 0;
      cell->count += counts ? 1 : 0;
    }
  }
}

Grid coarse(const io::Volume& volume, const glm::ivec3& per_cell, int threads) {
  const io::Geometry& g = volume.geometry;
  Grid grid;
  grid.size = (g.dimensions + per_cell - 1) / per_cell;
  grid.mm = glm::dvec3(g.spacing_i, g.spacing_j, g.slice_spacing()) * glm::dvec3(per_cell);
  // The body goes on beyond the scan's ends towards head and feet, so that nothing follows from what is cut there.
  const std::array axes{g.direction_i, g.direction_j, glm::cross(g.direction_i, g.direction_j)};
  for (std::size_t a = 0; a < 3; ++a) grid.has_sides[a] = std::abs(axes[a].z) < std::sqrt(0.5);
  grid.values.resize(static_cast<std::size_t>(grid.size.x) * static_cast<std::size_t>(grid.size.y) *
                     static_cast<std::size_t>(grid.size.z));
  const auto fill_layer = [&](std::size_t z) {
    std::vector<CellSum> sums(grid.step(2));
    const int first = static_cast<int>(z) * per_cell.z, end = std::min(first + per_cell.z, g.dimensions.z);
    std::visit(
        [&](const auto& voxels) {
          const io::internal::StoredPadding<typename std::decay_t<decltype(voxels)>::value_type> padding_of(volume);
          for (int k = first; k < end; ++k) {
            for (int j = 0; j < g.dimensions.y; ++j) {
              add_row(volume, voxels.data() + volume.offset(0, j, k), g.dimensions.x, per_cell.x, padding_of,
                      sums.data() + static_cast<std::size_t>(j / per_cell.y) * grid.step(1));
            }
          }
        },
        volume.voxels);
    std::ranges::transform(
        sums, grid.values.begin() + static_cast<std::ptrdiff_t>(z * grid.step(2)),
        [](const CellSum& cell) { return cell.count > 0 ? static_cast<float>(cell.sum / cell.count) : padding; });
  };
  io::internal::parallel_for(static_cast<std::size_t>(grid.size.z), fill_layer, {}, threads);
  return grid;
}

/// All cells connected with the first that `is_in`; they are taken out of it.
std::vector<std::size_t> take_component(const Grid& grid, std::size_t first, std::vector<char>& is_in) {
  std::vector<std::size_t> cells{first};
  is_in[first] = 0;
  for (std::size_t next = 0; next < cells.size(); ++next) {
    grid.neighbors(cells[next], [&](std::size_t at) {
      if (is_in[at] == 0) return;
      is_in[at] = 0;
      cells.push_back(at);
    });
  }
  return cells;
}

bool is_rooms(const Grid& grid, std::span<const std::size_t> air) {
  std::size_t sides = 0, empty = 0;
  for (const std::size_t at : air) {
    const glm::ivec3 cell = grid.cell(at);
    bool is_side = false;
    for (int axis = 0; axis < 3; ++axis) {
      if (!grid.has_sides[static_cast<std::size_t>(axis)]) continue;
      is_side = is_side || cell[axis] == 0 || cell[axis] + 1 == grid.size[axis] ||
                std::isnan(grid.values[at - grid.step(axis)]) || std::isnan(grid.values[at + grid.step(axis)]);
    }
    if (!is_side) continue;
    ++sides;
    empty += grid.values[at] < most_empty_hu ? 1 : 0;
  }
  return 2 * empty > sides;
}

/// Whether it is thick somewhere, and most of it has a lung's values: gas that is thin has them too, from its walls.
bool is_lung(const Grid& grid, std::span<const std::size_t> air, const std::vector<char>& thick) {
  const auto has_its_values = [&](std::size_t at) {
    return grid.values[at] > least_lung_hu && grid.values[at] < most_lung_hu;
  };
  return std::ranges::any_of(air, [&](std::size_t at) { return thick[at] != 0; }) &&
         2 * static_cast<std::size_t>(std::ranges::count_if(air, has_its_values)) > air.size();
}

/// What is left of the cells where `depth` cells are taken off on all sides; beyond the grid everything is solid.
std::vector<char> eroded(const Grid& grid, std::vector<char> cells, const glm::ivec3& depth) {
  const auto layer = static_cast<int>(grid.step(2));
  for (int z = 0; z < grid.size.z; ++z) {
    cv::Mat slice(grid.size.y, grid.size.x, CV_8U, cells.data() + static_cast<std::ptrdiff_t>(z) * layer);
    cv::erode(slice, slice, cv::Mat::ones(2 * depth.y + 1, 2 * depth.x + 1, CV_8U));
  }
  cv::Mat all(grid.size.z, layer, CV_8U, cells.data());
  cv::erode(all, all, cv::Mat::ones(2 * depth.z + 1, 1, CV_8U));
  return cells;
}

/// Cells of `solid` that are reached from `body` in so many steps.
void grow(const Grid& grid, const std::vector<char>& solid, int steps, std::vector<char>& body) {
  std::vector<std::size_t> front, next;
  for (std::size_t at = 0; at < grid.count(); ++at) {
    if (body[at] != 0) front.push_back(at);
  }
  for (int step = 0; step < steps && !front.empty(); ++step) {
    next.clear();
    for (const std::size_t from : front) {
      grid.neighbors(from, [&](std::size_t at) {
        if (solid[at] == 0 || body[at] != 0) return;
        body[at] = 1;
        next.push_back(at);
      });
    }
    front.swap(next);
  }
}

double longest_mm(const Grid& grid, std::span<const std::size_t> cells) {
  glm::ivec3 least(std::numeric_limits<int>::max()), most(-1);
  for (const std::size_t at : cells) {
    least = glm::min(least, grid.cell(at));
    most = glm::max(most, grid.cell(at));
  }
  const glm::dvec3 extent = glm::dvec3(most - least + 1) * grid.mm;
  return std::max({extent.x, extent.y, extent.z});
}

glm::ivec3 depth_of(const Grid& grid, double thickness_mm) {
  return glm::ivec3(glm::ceil(0.5 * thickness_mm / grid.mm));
}

using Cells = std::vector<std::size_t>;

/// The components of a set of cells.
std::vector<Cells> components_of(const Grid& grid, std::vector<char> cells) {
  std::vector<Cells> components;
  for (std::size_t first = 0; first < grid.count(); ++first) {
    if (cells[first] != 0) components.push_back(take_component(grid, first, cells));
  }
  return components;
}

/// Solid cells that are the patient's. `thick_air`: air around which all is.
std::vector<char> body_of(const Grid& grid, const std::vector<char>& solid, const std::vector<char>& thick_air) {
  std::vector<char> full = solid;
  for (std::size_t at = 0; at < grid.count(); ++at) full[at] = full[at] != 0 || thick_air[at] != 0 ? 1 : 0;
  const glm::ivec3 depth = depth_of(grid, thick_mm);
  std::vector<char> body = eroded(grid, full, depth);
  // The way back to its surface, and around what is rounder than the box that was taken off.
  grow(grid, full, depth.x + depth.y + std::min(depth.z, 2), body);
  std::vector<char> rest(grid.count());
  for (std::size_t at = 0; at < grid.count(); ++at) rest[at] = solid[at] != 0 && body[at] == 0 ? 1 : 0;
  for (const Cells& thin : components_of(grid, std::move(rest))) {
    bool is_on_body = false;
    for (const std::size_t cell : thin) {
      grid.neighbors(cell, [&](std::size_t at) { is_on_body = is_on_body || body[at] == 1; });
    }
    if (!is_on_body || longest_mm(grid, thin) > most_of_body_mm) continue;
    for (const std::size_t cell : thin) body[cell] = 2;
  }
  // Where no body outweighs what is thin, as beside a dry skull, which of the two is the table is a guess.
  std::ptrdiff_t bodies = 0, solids = 0;
  for (std::size_t at = 0; at < grid.count(); ++at) {
    solids += solid[at];
    bodies += solid[at] != 0 && body[at] != 0 ? 1 : 0;
  }
  return 2 * bodies > solids ? body : solid;
}

/// Whether most of the solids around some air are the body's: else it is within the table.
bool is_within_body(const Grid& grid, std::span<const std::size_t> air, const std::vector<Region>& regions) {
  std::ptrdiff_t body = 0;
  for (const std::size_t cell : air) {
    grid.neighbors(cell, [&](std::size_t at) {
      if (regions[at] == Region::body) ++body;
      if (regions[at] == Region::table) --body;
    });
  }
  return body > 0;
}

std::vector<char> mask_of(const Grid& grid, std::span<const Cells> components) {
  std::vector<char> mask(grid.count());
  for (const Cells& cells : components) {
    for (const std::size_t at : cells) mask[at] = 1;
  }
  return mask;
}

/// Those of the components of air that are thick, as no table's is.
std::vector<char> thick_air(const Grid& grid, std::span<const Cells> inside) {
  const std::vector<char> cores = eroded(grid, mask_of(grid, inside), depth_of(grid, thick_air_mm));
  std::vector<char> thick(grid.count());
  for (const Cells& air : inside) {
    if (std::ranges::none_of(air, [&](std::size_t at) { return cores[at] != 0; })) continue;
    for (const std::size_t at : air) thick[at] = 1;
  }
  return thick;
}

std::vector<Region> regions_of(const Grid& grid) {
  std::vector<char> air(grid.count()), solid(grid.count());
  for (std::size_t at = 0; at < grid.count(); ++at) {
    air[at] = grid.values[at] < most_air_hu ? 1 : 0;
    solid[at] = grid.values[at] >= most_air_hu ? 1 : 0;
  }
  std::vector<Region> regions(grid.count(), Region::none);
  std::vector<Cells> inside = components_of(grid, std::move(air));
  std::erase_if(inside, [&](const Cells& cells) {
    if (!is_rooms(grid, cells)) return false;
    for (const std::size_t at : cells) regions[at] = Region::room;
    return true;
  });
  const std::vector<char> body = body_of(grid, solid, thick_air(grid, inside));
  for (std::size_t at = 0; at < grid.count(); ++at) {
    if (solid[at] != 0) regions[at] = body[at] != 0 ? Region::body : Region::table;
  }
  const std::vector<char> thick = eroded(grid, mask_of(grid, inside), depth_of(grid, thick_mm));
  for (const Cells& cells : inside) {
    const Region region = !is_within_body(grid, cells, regions) ? Region::table
                          : is_lung(grid, cells, thick)         ? Region::lung
                                                                : Region::inner_air;
    for (const std::size_t at : cells) regions[at] = region;
  }
  return regions;
}

}  // namespace

Regions::Regions(const io::Volume& volume, int threads) {
  const io::Geometry& g = volume.geometry;
  const glm::dvec3 spacing(g.spacing_i, g.spacing_j, g.slice_spacing());
  voxels_per_cell_ = glm::max(glm::ivec3(glm::round(cell_mm / spacing)), 1);
  const Grid grid = coarse(volume, voxels_per_cell_, threads);
  cells_ = grid.size;
  cell_ml_ = 1e-3 * grid.mm.x * grid.mm.y * grid.mm.z;
  regions_ = regions_of(grid);
}

Region Regions::at(const glm::dvec3& index) const noexcept {
  const glm::ivec3 cell = glm::ivec3(glm::floor((index + 0.5) / glm::dvec3(voxels_per_cell_)));
  if (glm::any(glm::lessThan(cell, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(cell, cells_))) {
    return Region::none;
  }
  return regions_[(static_cast<std::size_t>(cell.z) * static_cast<std::size_t>(cells_.y) +
                   static_cast<std::size_t>(cell.y)) *
                      static_cast<std::size_t>(cells_.x) +
                  static_cast<std::size_t>(cell.x)];
}

Sides Regions::sides(const io::Geometry& geometry, const glm::ivec3& voxel, const glm::dvec3& gradient,
                     double reach_mm) const {
  const double length = glm::length(gradient);
  Sides sides;
  if (!(length > 0)) return sides;
  const glm::dvec3 here(voxel);
  const glm::dvec3 per_mm = geometry.to_index(geometry.to_patient(here) + gradient / length) - here;
  constexpr double step_mm = 0.5;
  Region farthest = Region::none;
  for (double mm = 0; mm <= reach_mm && (sides.low == Region::none || sides.high == Region::none); mm += step_mm) {
    const Region low = at(here - mm * per_mm), high = at(here + mm * per_mm);
    if (sides.low == Region::none && is_air(low)) sides.low = low;
    if (sides.high == Region::none && (high == Region::body || high == Region::table)) sides.high = high;
    if (high != Region::none) farthest = high;
  }
  if (sides.high == Region::none) sides.high = farthest;
  return sides;
}

double Regions::milliliters(Region region) const noexcept {
  return cell_ml_ * static_cast<double>(std::ranges::count(regions_, region));
}

}  // namespace palpate::modes::internal

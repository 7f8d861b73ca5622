#include "testdata/phantom.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace palpate::testdata {
namespace {

constexpr double fraction_tolerance = 1e-4;
constexpr int deepest_split = 4;

struct Cell {
  Vec3 center;
  Vec3 edges[3];
};

double longest_half_diagonal(const Cell& c) {
  double longest = 0;
  for (const double sj : {-0.5, 0.5}) {
    for (const double sk : {-0.5, 0.5}) {
      longest = std::max(longest, glm::length(0.5 * c.edges[0] + sj * c.edges[1] + sk * c.edges[2]));
    }
  }
  return longest;
}

double mean_in(const Phantom& phantom, const Cell& cell, double half_diagonal, int depth);

double mean_of_parts(const Phantom& phantom, const Cell& cell, double half_diagonal, int depth) {
  double sum = 0;
  Cell part{cell.center, {0.5 * cell.edges[0], 0.5 * cell.edges[1], 0.5 * cell.edges[2]}};
  for (int octant = 0; octant < 8; ++octant) {
    part.center = cell.center;
    for (int axis = 0; axis < 3; ++axis) {
      part.center += ((octant >> axis) & 1 ? 0.25 : -0.25) * cell.edges[axis];
    }
    sum += mean_in(phantom, part, half_diagonal / 2, depth + 1);
  }
  return sum / 8;
}

/// Whether a surface of this curvature is as good as flat in a cell `depth` splits below its voxel: its mean sag over
/// the cell, h^2 / 12 R, against the voxel's size.
bool is_flat(double curvature, double half_diagonal, int depth) {
  const double cell = 2 * half_diagonal;
  return cell * cell * curvature / 12 <= fraction_tolerance * cell * std::exp2(depth);
}

double mean_in(const Phantom& phantom, const Cell& cell, double half_diagonal, int depth) {
  double below = phantom.background;  // what the body in hand is painted over
  double above = phantom.background;
  const Shape* cutter = nullptr;
  Distance cut;
  int cutters = 0;
  for (const Body& body : phantom.bodies) {
    const Distance d = distance_to(body.shape, cell.center);
    if (d.signed_mm <= -half_diagonal) {
      below = above = body.value;
      cutters = 0;
    } else if (d.signed_mm < half_diagonal) {
      ++cutters;
      cutter = &body.shape;
      cut = d;
      above = body.value;
    }
  }
  if (cutters == 0) {
    return above;
  }
  if (depth < deepest_split && (cutters > 1 || !is_flat(curvature_of(*cutter), half_diagonal, depth))) {
    return mean_of_parts(phantom, cell, half_diagonal, depth);
  }
  if (cutters > 1) {
    return value_at(phantom, cell.center);
  }
  const double fraction = fraction_behind_plane(cut.normal, -cut.signed_mm, cell.edges);
  return fraction * above + (1 - fraction) * below;
}

}  // namespace

double value_at(const Phantom& phantom, const Vec3& position_mm) noexcept {
  double value = phantom.background;
  for (const Body& body : phantom.bodies) {
    if (distance_to(body.shape, position_mm).signed_mm <= 0) {
      value = body.value;
    }
  }
  return value;
}

double mean_value(const Phantom& phantom, const Vec3& center_mm, const Vec3 (&edges)[3]) {
  const Cell cell{center_mm, {edges[0], edges[1], edges[2]}};
  return mean_in(phantom, cell, longest_half_diagonal(cell), 0);
}

Phantom make_slab(const Vec3& inward, std::span<const Layer> layers, double background) {
  Phantom phantom{background, {}};
  for (const Layer& layer : layers) {
    phantom.bodies.push_back({HalfSpace{-inward, -layer.depth}, layer.value});
  }
  return phantom;
}

Phantom make_sphere(double radius, double value, double background) {
  return {background, {{Ball{Vec3(0), radius}, value}}};
}

Phantom make_shell(double inner_radius, double outer_radius, double wall, double lumen, double background) {
  return {background, {{Ball{Vec3(0), outer_radius}, wall}, {Ball{Vec3(0), inner_radius}, lumen}}};
}

Phantom make_tube(double radius, const Vec3& axis, double lumen, double background) {
  return {background, {{Cylinder{Vec3(0), axis, radius}, lumen}}};
}

Phantom make_wedge(double angle_degrees, double first, double second, double background) {
  const double angle = glm::radians(angle_degrees);
  const Vec3 interface_normal(std::sin(angle), 0, std::cos(angle));
  return {first, {{HalfSpace{interface_normal, 0}, second}, {HalfSpace{Vec3(0, 0, -1), 0}, background}}};
}

Phantom make_chest() {
  const Vec3 z(0, 0, 1), back(0, 1, 0);
  return {air_hu,
          {{HalfSpace{-back, -168}, table_hu},
           {HalfSpace{-back, -180}, air_hu},
           {Cylinder{Vec3(0), z, 160}, fat_hu},
           {Cylinder{Vec3(0), z, 150}, soft_tissue_hu},
           {Cylinder{Vec3(-75, -10, 0), z, 55}, lung_hu},
           {Cylinder{Vec3(75, -10, 0), z, 55}, lung_hu},
           {Ball{Vec3(15, -40, -40), 45}, soft_tissue_hu},
           {Cylinder{Vec3(0, 30, 0), z, 9}, air_hu},
           {Cylinder{Vec3(0, 100, 0), z, 18}, bone_hu / 2}}};
}

}  // namespace palpate::testdata

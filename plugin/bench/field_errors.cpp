#include "plugin/bench/field_errors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <random>
#include <string>
#include <vector>

#include "io/fields/volume_fields.h"
#include "plugin/bench/csv_table.h"
#include "testdata/scan.h"

namespace palpate::plugin {
namespace {

using io::Vec3;
constexpr io::FieldSet both = io::FieldSet::value | io::FieldSet::gradient;

/// Slope of a ball of 1040 HU blurred by a Gaussian, at its surface.
double slope_at_surface(double radius, double scale) {
  const double z = radius / scale;
  const double density = 1040 / (scale * std::sqrt(2 * std::acos(-1.0)));
  return density * (1 + std::exp(-2 * z * z) - (1 - std::exp(-2 * z * z)) / (z * z));
}

struct NamedGrid {
  const char* name;
  testdata::Grid grid;
};

std::vector<NamedGrid> grids() {
  testdata::Grid even;
  even.size = glm::ivec3(64);
  testdata::Grid thick = even;
  thick.spacing.z = 5;
  thick.size.z = 14;
  testdata::Grid oblique = rotated(even, {1, 2, 3}, 35);
  testdata::Grid tilted = even;
  tilted.tilt_degrees = 20;
  tilted.size = {64, 70, 70};
  testdata::Grid thick_tilted = thick;
  thick_tilted.tilt_degrees = 20;
  thick_tilted.size = {64, 70, 16};
  testdata::Grid uneven = even;
  uneven.uneven_mm = 0.3;
  return {{"1x1x1", even},
          {"1x1x5", thick},
          {"1x1x1 oblique", oblique},
          {"1x1x1 tilted 20", tilted},
          {"1x1x5 tilted 20", thick_tilted},
          {"1x1x1 uneven 0.3", uneven}};
}

struct Method {
  std::string name;
  io::GradientMethod gradient = io::GradientMethod::gaussian;
  double scale_mm = 0;
};

std::vector<Method> methods() {
  return {{"gaussian", io::GradientMethod::gaussian, 1.0},      {"gaussian", io::GradientMethod::gaussian, 1.5},
          {"gaussian", io::GradientMethod::gaussian, 2.0},      {"gaussian", io::GradientMethod::gaussian, 3.0},
          {"central", io::GradientMethod::central_differences}, {"b-spline", io::GradientMethod::cubic}};
}

/// What voxels do to a Gaussian's width along a normal: averaging over a voxel adds a twelfth of its edge's square, and
/// linear interpolation between voxels f (1 - f) of it.
double widened(double scale, const io::Geometry& g, const Vec3& position, const Vec3& normal) {
  const Vec3 index = g.to_index(position);
  const Vec3 f = index - glm::floor(index);
  const Vec3 edges[] = {g.spacing_i * g.direction_i, g.spacing_j * g.direction_j,
                        g.slice_spacing() * glm::cross(g.direction_i, g.direction_j)};
  const Vec3 steps[] = {edges[0], edges[1], g.step};
  double variance = scale * scale;
  for (int axis = 0; axis < 3; ++axis) {
    const double edge = glm::dot(edges[axis], normal);
    const double step = glm::dot(steps[axis], normal);
    variance += edge * edge / 12 + f[axis] * (1 - f[axis]) * step * step;
  }
  return std::sqrt(variance);
}

struct Errors {
  double direction_worst = 0;
  double direction_rms = 0;
  double magnitude_worst = 0;    ///< against the Gaussian alone
  double unexplained_worst = 0;  ///< against the Gaussian that voxels have widened
};

/// At points spread evenly over a sphere, sampled as a proxy would.
Errors errors_on_sphere(const std::shared_ptr<const io::Volume>& volume, const Method& method, double radius) {
  constexpr int points = 2000;
  const io::VolumeFields fields(volume, both, method.scale_mm,
                                {.gradient = method.gradient, .brick_bytes = 0, .background = false});
  Errors errors;
  for (int n = 0; n < points; ++n) {
    const double z = 1 - (2 * n + 1.0) / points;  // Fibonacci's spiral
    const double angle = n * 2.399963229728653;
    const double r = std::sqrt(1 - z * z);
    const Vec3 normal(r * std::cos(angle), r * std::sin(angle), z);
    const Vec3 g = fields.sample(radius * normal, both).gradient;
    const double degrees = glm::degrees(std::atan2(glm::length(glm::cross(normal, g)), -glm::dot(normal, g)));
    errors.direction_worst = std::max(errors.direction_worst, degrees);
    errors.direction_rms += degrees * degrees / points;
    if (method.scale_mm > 0) {
      const double wide = widened(method.scale_mm, volume->geometry, radius * normal, normal);
      const auto off = [&](double scale) { return std::abs(glm::length(g) / slope_at_surface(radius, scale) - 1); };
      errors.magnitude_worst = std::max(errors.magnitude_worst, off(method.scale_mm));
      errors.unexplained_worst = std::max(errors.unexplained_worst, off(wide));
    }
  }
  errors.direction_rms = std::sqrt(errors.direction_rms);
  return errors;
}

}  // namespace

void tabulate_gradient_errors(const std::filesystem::path& folder) {
  constexpr double radius = 20;
  CsvTable table(
      "grid,noise_hu,method,scale_mm,direction_worst_deg,direction_rms_deg,magnitude_worst_percent,"
      "beyond_voxel_blur_percent");
  for (const auto& [name, grid] : grids()) {
    for (const double noise : {0.0, 20.0}) {
      const auto volume = std::make_shared<const io::Volume>(
          testdata::scan(testdata::make_sphere(radius), testdata::make_geometry(grid), {.noise = noise}));
      for (const Method& method : methods()) {
        const Errors e = errors_on_sphere(volume, method, radius);
        const std::string magnitude =
            method.scale_mm > 0 ? fmt::format("{},{:.2f},{:.2f},{:.1f},{:.1f}", method.scale_mm, e.direction_worst,
                                              e.direction_rms, 100 * e.magnitude_worst, 100 * e.unexplained_worst)
                                : fmt::format(",{:.2f},{:.2f},,", e.direction_worst, e.direction_rms);
        table.add(fmt::format("{},{:.0f},{},{}", name, noise, method.name, magnitude));
      }
    }
  }
  table.save(folder, "gradient_errors.csv");
}

void tabulate_direction_jitter(const std::shared_ptr<const io::Volume>& volume, const std::filesystem::path& folder) {
  constexpr double tremor_mm = 0.05;  // rms along each axis
  constexpr int wanted = 500;
  constexpr int shakes = 20;
  CsvTable table("scale_mm,points,direction_rms_deg,direction_p95_deg");
  for (const double scale : {1.0, 1.5, 2.0, 3.0}) {
    const io::VolumeFields fields(volume, both, scale, {.brick_bytes = 0, .background = false});
    std::mt19937 random(1);
    std::normal_distribution<double> tremor(0, tremor_mm);
    std::uniform_real_distribution<double> anywhere(0, 1);
    std::vector<double> angles;
    int points = 0;
    for (int n = 0; n < 200 * wanted && points < wanted; ++n) {
      const Vec3 index =
          Vec3(anywhere(random), anywhere(random), anywhere(random)) * Vec3(volume->geometry.dimensions - 1);
      const Vec3 p = volume->geometry.to_patient(index);
      const Vec3 g = fields.sample(p, both).gradient;
      constexpr double boundary = 40;  // per mm: skin and bone of a CT are far above
      if (glm::length(g) < boundary) continue;
      ++points;
      for (int m = 0; m < shakes; ++m) {
        const Vec3 h = fields.sample(p + Vec3(tremor(random), tremor(random), tremor(random)), both).gradient;
        angles.push_back(glm::degrees(std::atan2(glm::length(glm::cross(g, h)), glm::dot(g, h))));
      }
    }
    if (angles.empty()) {
      table.add(fmt::format("{},0,,", scale));
      continue;
    }
    double squares = 0;
    for (const double a : angles) squares += a * a;
    std::sort(angles.begin(), angles.end());
    table.add(fmt::format("{},{},{:.3f},{:.3f}", scale, points, std::sqrt(squares / static_cast<double>(angles.size())),
                          angles[angles.size() * 95 / 100]));
  }
  table.save(folder, "direction_jitter.csv");
}

}  // namespace palpate::plugin

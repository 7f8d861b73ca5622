// The scan's own edges against phantoms with known surfaces.
#include "io/structures/scan_edge.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <memory>
#include <numeric>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "io/fields/filtered.h"
#include "io/fields/volume_fields.h"
#include "solver/text/testing/sanitized.h"
#include "testdata/scan.h"

namespace palpate::io {
namespace {

constexpr double scanner_mm = 0.6;  // standard deviation of the scanner's blur
constexpr double within_mm = 5;

/// What a scanner with a blur of its own makes of a phantom.
std::shared_ptr<const Volume> scanned(const testdata::Phantom& phantom, const Geometry& geometry, double noise = 0,
                                      unsigned seed = 1) {
  const auto sharp = std::make_shared<const Volume>(testdata::scan(phantom, geometry, {.quantised = false}));
  Volume volume = *filtered(sharp, {.type = find_filter_type("gaussian"), .sigma_mm = scanner_mm});
  volume.filtered_from = nullptr;
  std::mt19937 random(seed);
  std::normal_distribution<float> normal(0, static_cast<float>(noise));
  if (noise > 0) {
    for (float& value : std::get<std::vector<float>>(volume.voxels)) value += normal(random);
  }
  return std::make_shared<const Volume>(std::move(volume));
}

Mask labels_of(const Geometry& geometry, const std::function<bool(const glm::ivec3&)>& inside) {
  Mask mask;
  mask.geometry = geometry;
  mask.size = geometry.dimensions;
  for (int k = 0; k < mask.size.z; ++k) {
    for (int j = 0; j < mask.size.y; ++j) {
      for (int i = 0; i < mask.size.x; ++i) mask.occupancy.push_back(inside({i, j, k}) ? Mask::full : 0);
    }
  }
  return mask;
}

VolumeFields fields_of_values(const std::shared_ptr<const Volume>& volume) {
  return {volume, FieldSet::value | FieldSet::gradient, 1, {.gradient = GradientMethod::cubic, .brick_bytes = 0}};
}

/// Where a ray (from inside) leaves the structure.
double crossing(const DistanceField& structure, const Vec3& from, const Vec3& way, double reach) {
  double in = 0, out = reach;
  for (int halving = 0; halving < 50; ++halving) {
    const double middle = 0.5 * (in + out);
    (structure.sample(from + middle * way).mm > 0 ? in : out) = middle;
  }
  return in;
}

struct Lattice {
  std::string name;
  testdata::Grid grid;
  double tolerance_mm = 0;  // of a single place without noise: a tenth of the thickest voxel and a little more
};

std::vector<Lattice> lattices() {
  const auto oblique = [](const testdata::Grid& grid) {
    return testdata::rotated(grid, glm::normalize(Vec3(1, 2, 0.5)), 23);
  };
  std::vector<Lattice> all{
      {"even", {.size = {32, 32, 32}}, 0.05},
      {"thick slices", {.size = {40, 40, 12}, .spacing = {0.8, 0.8, 3}}, 0.45},
      {"oblique", oblique({.size = {32, 35, 26}, .spacing = {1, 0.9, 1.3}}), 0.13},
      {"tilted", oblique({.size = {32, 36, 22}, .spacing = {1.1, 0.9, 1.7}, .tilt_degrees = 18}), 0.25},
      {"uneven slices", {.size = {35, 35, 20}, .spacing = {0.9, 0.9, 1.6}, .uneven_mm = 0.3}, 0.45}};
  all.resize(static_cast<std::size_t>(repeats(5, 1)));
  return all;
}

struct Errors {
  std::vector<double> mm;
  int none = 0, within_known = 0;

  void add(double error_mm, double known_to_mm) {
    mm.push_back(error_mm);
    within_known += std::abs(error_mm) <= known_to_mm ? 1 : 0;
  }
  double mean() const { return std::accumulate(mm.begin(), mm.end(), 0.0) / static_cast<double>(mm.size()); }
  double rms() const {
    return std::sqrt(std::inner_product(mm.begin(), mm.end(), mm.begin(), 0.0) / static_cast<double>(mm.size()));
  }
  double largest() const {
    double most = 0;
    for (const double one : mm) most = std::max(most, std::abs(one));
    return most;
  }
};

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double operator()() { return normal_(engine_); }
  Vec3 vector() {
    const double x = normal_(engine_), y = normal_(engine_), z = normal_(engine_);
    return {x, y, z};
  }

 private:
  std::mt19937 engine_;
  std::normal_distribution<double> normal_;
};

/// Of a plane at any place and angle, whose labels end `beside_mm` before it. `slant`: of the rays to its normal.
Errors errors_on_a_plane(const Geometry& geometry, double beside_mm, double slant, double noise, unsigned seed) {
  Errors errors;
  Random random(seed);
  const Vec3 outward = glm::normalize(random.vector());
  const double offset = random();
  const auto volume =
      scanned({.background = -100, .bodies = {{testdata::HalfSpace{outward, offset}, 60}}}, geometry, noise, seed);
  const auto structure = distance_of(labels_of(geometry, [&](const glm::ivec3& at) {
    return glm::dot(geometry.to_patient(Vec3(at)), outward) < offset - beside_mm;
  }));
  const VolumeFields values = fields_of_values(volume);
  for (int ray = 0; ray < 8; ++ray) {
    const Vec3 aside = glm::normalize(glm::cross(outward, random.vector()));
    const Vec3 way = std::cos(slant) * outward + std::sin(slant) * aside;
    const Vec3 from = random.vector() - 5.0 * way;
    const double at = crossing(*structure, from, way, 14);
    const auto edge = scan_edge({values, geometry}, *structure, from + at * way, way, within_mm);
    if (!edge) {
      ++errors.none;
    } else {
      errors.add(glm::dot(from + (at + edge->mm) * way, outward) - offset, edge->known_to_mm * std::cos(slant));
    }
  }
  return errors;
}

TEST(ScanEdge, LiesOnAPlaneWhereverItsLabelsEnd) {
  for (const Lattice& lattice : lattices()) {
    SCOPED_TRACE(lattice.name);
    const Geometry geometry = testdata::make_geometry(lattice.grid);
    for (const double beside_mm : {2.0, -2.0}) {
      SCOPED_TRACE(beside_mm);
      const Errors errors = errors_on_a_plane(geometry, beside_mm, 0, 0, 5);
      EXPECT_EQ(errors.none, 0);
      EXPECT_LE(errors.largest(), lattice.tolerance_mm);
      EXPECT_LE(std::abs(errors.mean()), 0.5 * lattice.tolerance_mm);
    }
    const Errors slanted = errors_on_a_plane(geometry, 1, 1.0, 0, 6);
    EXPECT_LE(slanted.none, 1);
    EXPECT_LE(slanted.largest(), 2 * lattice.tolerance_mm);
  }
}

// The structure's edge is exact here: fractions of voxels tell where it lies. Neither end is tied to the samples.
TEST(ScanEdge, TellsTwoMillimetersWhereTwoAreTrue) {
  const Geometry geometry = testdata::make_geometry({.size = {24, 16, 16}});
  Random random(7);
  for (int n = 0; n < 12; ++n) {
    const double edge_mm = random();
    const double beside_mm = n % 2 == 0 ? 2 : -2;
    Mask mask = labels_of(geometry, [](const glm::ivec3&) { return true; });
    mask.fractions = Mask::Fractions::occupancy;
    for (std::size_t at = 0; at < mask.occupancy.size(); ++at) {
      const double x = geometry.to_patient({static_cast<double>(at % 24), 0, 0}).x;
      mask.occupancy[at] = static_cast<std::uint8_t>(std::lround(Mask::full * std::clamp(edge_mm - x + 0.5, 0.0, 1.0)));
    }
    const auto volume =
        scanned({.background = -100, .bodies = {{testdata::HalfSpace{{1, 0, 0}, edge_mm + beside_mm}, 60}}}, geometry);
    const VolumeFields values = fields_of_values(volume);
    const auto edge = scan_edge({values, geometry}, *distance_of(mask), {edge_mm, 0.3, -0.2}, {1, 0, 0}, within_mm);
    ASSERT_TRUE(edge) << edge_mm;
    EXPECT_NEAR(edge->mm, beside_mm, 0.05) << edge_mm;
    EXPECT_NEAR(edge->rise, -160, 5) << edge_mm;
  }
}

/// Of a ball whose labels are the values above the middle, as a threshold gives them. `slant`: of the rays to its
/// normals, where they leave it.
Errors errors_on_a_ball(const Geometry& geometry, double radius, double noise, unsigned seed, double slant = 0) {
  Errors errors;
  Random random(seed);
  const Vec3 center = 0.5 * random.vector();
  const auto volume =
      scanned({.background = -100, .bodies = {{testdata::Ball{center, radius}, 60}}}, geometry, noise, seed);
  const auto structure = distance_of(labels_of(geometry, [&](const glm::ivec3& at) {
    return volume->value_at(at.x, at.y, at.z) > -20 &&
           glm::distance(geometry.to_patient(Vec3(at)), center) < radius + 2;
  }));
  const VolumeFields values = fields_of_values(volume);
  for (int ray = 0; ray < 40; ++ray) {
    const Vec3 way = glm::normalize(random.vector());
    const Vec3 aside = slant > 0 ? glm::normalize(glm::cross(way, random.vector())) : Vec3(0);
    const Vec3 from = center + radius * std::sin(slant) * aside;
    const double at = crossing(*structure, from, way, radius + 4);
    const auto edge = scan_edge({values, geometry}, *structure, from + at * way, way, within_mm);
    if (!edge) {
      ++errors.none;
    } else {
      errors.add(glm::distance(from + (at + edge->mm) * way, center) - radius, edge->known_to_mm);
    }
  }
  return errors;
}

TEST(ScanEdge, IsNotShiftedByBlurOnABall) {
  const Geometry geometry = testdata::make_geometry({.size = {32, 32, 32}});
  for (const auto& [radius, rms_mm] : {std::pair{11.0, 0.02}, {3.0, 0.06}}) {
    SCOPED_TRACE(radius);
    const Errors errors = errors_on_a_ball(geometry, radius, 0, 3);
    EXPECT_EQ(errors.none, 0);
    EXPECT_LE(errors.rms(), rms_mm);
    EXPECT_LE(std::abs(errors.mean()), 0.7 * rms_mm);
  }
}

// The blur is the same however the ray is slanted to the surface, though along the ray the edge is wider.
TEST(ScanEdge, IsNotShiftedByBlurOnABallThatARayLeavesAtASlant) {
  const Geometry geometry = testdata::make_geometry({.size = {32, 32, 32}});
  for (const double slant : {0.5, 0.8, 1.0}) {
    SCOPED_TRACE(slant);
    const Errors errors = errors_on_a_ball(geometry, 11, 0, 3, slant);
    EXPECT_EQ(errors.none, 0);
    EXPECT_LE(errors.rms(), 0.06);
    EXPECT_LE(std::abs(errors.mean()), 0.05);
  }
}

TEST(ScanEdge, IsKnownAsWellAsItSays) {
  Errors all;
  for (const Lattice& lattice : lattices()) {
    const Geometry geometry = testdata::make_geometry(lattice.grid);
    const Errors errors = errors_on_a_ball(geometry, 9, 15, 4);
    EXPECT_LE(std::abs(errors.mean()), 0.1) << lattice.name;
    EXPECT_LE(errors.none, 8) << lattice.name;
    all.mm.insert(all.mm.end(), errors.mm.begin(), errors.mm.end());
    all.within_known += errors.within_known;
  }
  EXPECT_GE(all.within_known, 0.9 * static_cast<double>(all.mm.size())) << "of " << all.mm.size();
}

// Liver against muscle: only noise.
TEST(ScanEdge, IsNoneWhereTheValuesAreAlike) {
  const Geometry geometry = testdata::make_geometry({.size = {32, 32, 32}});
  const auto volume = scanned({.background = 60, .bodies = {}}, geometry, 15, 8);
  const auto structure = distance_of(
      labels_of(geometry, [&](const glm::ivec3& at) { return glm::length(geometry.to_patient(Vec3(at))) < 8; }));
  const VolumeFields values = fields_of_values(volume);
  Random random(9);
  int found = 0;
  constexpr int rays = 300;
  for (int ray = 0; ray < rays; ++ray) {
    const Vec3 way = glm::normalize(random.vector());
    const double at = crossing(*structure, Vec3(0), way, 12);
    found += scan_edge({values, geometry}, *structure, at * way, way, within_mm) ? 1 : 0;
  }
  EXPECT_LE(found, rays / 50);
}

/// A phantom that changes along x alone, and a structure that ends at x = 1 mm.
struct AlongX {
  explicit AlongX(const testdata::Phantom& phantom)
      : geometry(testdata::make_geometry({.size = {32, 24, 24}})),
        structure(distance_of(
            labels_of(geometry, [&](const glm::ivec3& voxel) { return geometry.to_patient(Vec3(voxel)).x < 1; }))),
        values(fields_of_values(scanned(phantom, geometry))),
        at(crossing(*structure, {-6, 0.2, 0.4}, {1, 0, 0}, 14) - 6) {}

  std::optional<ScanEdge> edge(const Vec3& way) const {
    return scan_edge({values, geometry}, *structure, {at, 0.2, 0.4}, way, within_mm);
  }

  Geometry geometry;
  std::shared_ptr<const DistanceField> structure;
  VolumeFields values;
  double at;  ///< mm: x of the structure's surface
};

// Fat of 4 mm between the organ and the wall: the nearer of two edges, though the other one is as steep.
TEST(ScanEdge, IsTheNearestAndNotShiftedByItsNeighbor) {
  for (const auto& [fat_mm, tolerance_mm] : {std::pair{3.0, 0.15}, {4.0, 0.07}}) {
    const AlongX scan(
        {.background = 60,
         .bodies = {{testdata::HalfSpace{{1, 0, 0}, 0.3 + fat_mm}, -100}, {testdata::HalfSpace{{1, 0, 0}, 0.3}, 60}}});
    const auto edge = scan.edge({1, 0, 0});
    ASSERT_TRUE(edge);
    EXPECT_NEAR(scan.at + edge->mm, 0.3, tolerance_mm) << fat_mm;
    EXPECT_LT(edge->rise, 0);
    // The same seen the other way.
    const auto back = scan.edge({-1, 0, 0});
    ASSERT_TRUE(back);
    EXPECT_NEAR(back->mm, -edge->mm, 1e-9);
    EXPECT_NEAR(back->rise, -edge->rise, 1e-6);
  }
}

// The scan ends beyond the structure, less than a millimeter away.
TEST(ScanEdge, IsTheSameSeenEitherWayUpToTheEndOfTheScan) {
  const Geometry geometry = testdata::make_geometry({.size = {32, 24, 24}});
  const double end = geometry.to_patient({31, 0, 0}).x;
  const auto volume =
      scanned({.background = -100, .bodies = {{testdata::HalfSpace{{1, 0, 0}, end - 4.2}, 60}}}, geometry);
  const auto structure = distance_of(
      labels_of(geometry, [&](const glm::ivec3& voxel) { return geometry.to_patient(Vec3(voxel)).x < end - 0.5; }));
  const VolumeFields values = fields_of_values(volume);
  for (const double left_mm : {0.1, 0.3, 0.6, 0.9, 1.4}) {
    const Vec3 place(end - left_mm, 0.2, 0.4);
    const auto on = scan_edge({values, geometry}, *structure, place, {1, 0, 0}, within_mm);
    const auto back = scan_edge({values, geometry}, *structure, place, {-1, 0, 0}, within_mm);
    ASSERT_TRUE(on && back) << left_mm;
    EXPECT_NEAR(on->mm, left_mm - 4.2, 0.15) << left_mm;
    EXPECT_NEAR(back->mm, -on->mm, 1e-6) << left_mm;
    EXPECT_NEAR(back->rise, -on->rise, 1e-3) << left_mm;
  }
}

// From bone by soft tissue to fat: the value falls twice, by steps of the same size.
TEST(ScanEdge, IsOneStepOfTwo) {
  const AlongX scan({.background = -100,
                     .bodies = {{testdata::HalfSpace{{1, 0, 0}, 3.9}, 0}, {testdata::HalfSpace{{1, 0, 0}, 0.3}, 100}}});
  const auto edge = scan.edge({1, 0, 0});
  ASSERT_TRUE(edge);
  EXPECT_NEAR(scan.at + edge->mm, 0.3, 0.022) << "cut off at both ends alike";
  EXPECT_NEAR(edge->rise, -100, 6);
}

TEST(ScanEdge, IsNoneAlongTheSurfaceAndBeyondTheSearch) {
  const Geometry geometry = testdata::make_geometry({.size = {32, 24, 24}});
  const auto volume = scanned({.background = -100, .bodies = {{testdata::HalfSpace{{1, 0, 0}, 6.3}, 60}}}, geometry);
  const auto structure =
      distance_of(labels_of(geometry, [&](const glm::ivec3& at) { return geometry.to_patient(Vec3(at)).x < 0; }));
  const VolumeFields values = fields_of_values(volume);
  const Vec3 place(crossing(*structure, {-6, 0, 0}, {1, 0, 0}, 14) - 6, 0, 0);
  EXPECT_FALSE(scan_edge({values, geometry}, *structure, place, glm::normalize(Vec3(0.1, 1, 0)), 20));
  EXPECT_FALSE(scan_edge({values, geometry}, *structure, place, {1, 0, 0}, within_mm));
  const auto farther = scan_edge({values, geometry}, *structure, place, {1, 0, 0}, 8);
  ASSERT_TRUE(farther);
  EXPECT_NEAR(place.x + farther->mm, 6.3, 0.05);
}

}  // namespace
}  // namespace palpate::io

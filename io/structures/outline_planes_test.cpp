// The planes of contours and masks: distances in each plane against every edge, and which planes exist, on oblique
// planes.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <utility>
#include <vector>

#include "io/errors.h"
#include "io/structures/beyond_slices.h"
#include "io/structures/contour_planes.h"

namespace palpate::io {
namespace {

/// Planes that lie obliquely; points are given along them and by their height.
struct ObliquePlanes {
  Vec3 u = glm::normalize(Vec3(0.9, 0.3, -0.2)), v = glm::normalize(glm::cross(Vec3(0.2, -0.4, 1), u));
  Vec3 n = glm::cross(u, v), first{30, -40, 50};

  Vec3 at(double x, double y, double height) const { return first + x * u + y * v + height * n; }
  Contour contour(const std::vector<glm::dvec2>& points, double height) const {
    Contour all;
    for (const glm::dvec2& p : points) all.push_back(at(p.x, p.y, height));
    return all;
  }
};

using Points = std::vector<glm::dvec2>;

double squared_distance(const Points& polygon, const glm::dvec2& at) {
  double least = 1e12;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const glm::dvec2 a = polygon[k], along = polygon[(k + 1) % polygon.size()] - a;
    const double part = std::clamp(glm::dot(at - a, along) / glm::dot(along, along), 0.0, 1.0);
    least = std::min(least, glm::dot(at - a - part * along, at - a - part * along));
  }
  return least;
}

/// By the sum of the angles under which its edges are seen: once round, or not at all.
bool is_within(const Points& polygon, const glm::dvec2& at) {
  double turn = 0;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const glm::dvec2 a = polygon[k] - at, b = polygon[(k + 1) % polygon.size()] - at;
    turn += std::atan2(a.x * b.y - a.y * b.x, glm::dot(a, b));
  }
  return std::abs(turn) > 3;
}

TEST(OutlineOfContours, HasTheDistanceOfEveryNodeToItsEdges) {
  const ObliquePlanes planes;
  const Points outer{{0, 0}, {17, 2}, {21, 13}, {6, 19}, {9, 9}}, hole{{11, 5}, {15, 6}, {14, 10}};
  std::vector<Contour> contours;
  for (int k = 0; k < 3; ++k) {
    contours.push_back(planes.contour(outer, 3.0 * k));
    contours.push_back(planes.contour(hole, 3.0 * k));
  }
  const ContourStack stack = stack_of(contours);
  EXPECT_DOUBLE_EQ(stack.step_mm, 3);
  const OutlinePlanes outline = planes_of(stack, {});
  const NodeLattice& lattice = outline.lattice;
  const double band = outline.band_mm;
  const glm::ivec2 size(lattice.bricks * NodeBricks::edge);
  int drawn = 0;
  for (std::size_t plane = 0; plane < outline.node.size(); ++plane) {
    PlaneDistances distances;
    outline.compute(plane, distances);
    const Vec3 corner = lattice.position({0, 0, outline.node[plane]}) - planes.first;
    const double height = glm::dot(corner, planes.n);
    EXPECT_NEAR(height, 3 * std::round(height / 3), 1e-6) << "on a plane of the contours, or as far beyond";
    const bool empty = height < -1 || height > 7;
    drawn += empty ? 0 : 1;
    for (int n = 0; n < size.x * size.y; ++n) {
      const Vec3 node = lattice.position({n % size.x, n / size.x, outline.node[plane]}) - planes.first;
      const glm::dvec2 at(glm::dot(node, planes.u), glm::dot(node, planes.v));
      const bool inside = !empty && is_within(outer, at) && !is_within(hole, at);
      const double squared = empty ? 1e12 : std::min(squared_distance(outer, at), squared_distance(hole, at));
      const auto index = static_cast<std::size_t>(n);
      const double other = inside ? distances.to_inside[index] : distances.to_outside[index];
      const double own = inside ? distances.to_outside[index] : distances.to_inside[index];
      if (squared < 1e-12) continue;
      ASSERT_EQ(other, 0) << at.x << ' ' << at.y;
      if (squared <= band * band) {
        ASSERT_NEAR(own, squared, 1e-4 * (1 + squared)) << at.x << ' ' << at.y;
      } else {
        ASSERT_GE(own, band * band) << at.x << ' ' << at.y;
      }
    }
  }
  EXPECT_EQ(drawn, 3);
  EXPECT_EQ(lattice.spacing.x, 1);
  EXPECT_EQ(lattice.spacing.y, 1);
}

std::size_t planes_with_something(const OutlinePlanes& outline) {
  std::size_t count = 0;
  for (std::size_t plane = 0; plane < outline.node.size(); ++plane) {
    PlaneDistances distances;
    outline.compute(plane, distances);
    count += std::ranges::any_of(distances.to_outside, [](float mm) { return mm > 0; }) ? 1 : 0;
  }
  return count;
}

const Points drawn_square{{0, 0}, {20, 0}, {20, 20}, {0, 20}};

// Up to four planes may be missing; where five are, there are two bodies, with empty planes between them.
TEST(OutlineOfContours, GoesOnThroughFewMissingPlanes) {
  const ObliquePlanes planes;
  for (const int apart : {1, 4, 5, 7}) {
    std::vector<Contour> contours;
    for (const int k : {0, 1, 2, 2 + apart, 3 + apart, 4 + apart})
      contours.push_back(planes.contour(drawn_square, 2.0 * k));
    const ContourStack stack = stack_of(contours);
    const OutlinePlanes outline = planes_of(stack, {});
    const auto beyond = static_cast<int>(std::ceil((outline.band_mm + 2 * outline.lattice.spacing.x) / 2));
    EXPECT_EQ(outline.node.size(), static_cast<std::size_t>(6 + 2 * beyond + (apart > 4 ? apart - 1 : 0))) << apart;
    EXPECT_EQ(planes_with_something(outline), 6U);
    EXPECT_TRUE(std::is_sorted(outline.node.begin(), outline.node.end()));
  }
}

// Pixels are as fine as the planes are apart, from half a millimeter to one.
TEST(OutlineOfContours, LatticeIsAsFineAsItsPlanes) {
  for (const auto& [step, fine] : {std::pair{0.2, 0.5}, {0.5, 0.5}, {0.7, 0.7}, {1.0, 1.0}, {4.0, 1.0}}) {
    const ObliquePlanes planes;
    std::vector<Contour> contours;
    for (int k = 0; k < 4; ++k) contours.push_back(planes.contour(drawn_square, step * k));
    const ContourStack stack = stack_of(contours);
    const NodeLattice lattice = planes_of(stack, {}).lattice;
    EXPECT_NEAR(lattice.spacing.x, fine, 1e-9) << step;
    EXPECT_NEAR(lattice.spacing.y, fine, 1e-9) << step;
    EXPECT_LE(lattice.spacing.z, 1.5) << step;
    EXPECT_NEAR(step / lattice.spacing.z, std::round(step / lattice.spacing.z), 1e-9) << step;
  }
}

// Where the scan ends with the contours nobody has seen an end; elsewhere they end.
TEST(OutlineOfContours, GoesOnWhereTheScanEnds) {
  const ObliquePlanes planes;
  std::vector<Contour> contours;
  for (int k = 0; k < 8; ++k) contours.push_back(planes.contour(drawn_square, 2.0 * k));
  const ContourStack stack = stack_of(contours);
  const OutlinePlanes alone = planes_of(stack, {});
  const std::size_t beyond = (alone.node.size() - 8) / 2;
  for (const bool ends_below : {false, true}) {
    for (const bool ends_above : {false, true}) {
      Geometry scan;
      scan.dimensions = {50, 50, 8 + (ends_below ? 0 : 40) + (ends_above ? 0 : 40)};
      scan.direction_i = planes.u;
      scan.direction_j = planes.v;
      scan.step = 2.0 * planes.n;
      for (int k = 0; k < scan.dimensions.z; ++k) {
        scan.slice_positions.push_back(planes.at(-10, -10, 2.0 * (k - (ends_below ? 0 : 40))));
      }
      DistanceOptions options;
      options.scan = &scan;
      EXPECT_EQ(planes_with_something(planes_of(stack, options)),
                8 + (ends_below ? beyond : 0) + (ends_above ? beyond : 0));
    }
  }
}

// Each end goes on as it is there: contours differ from plane to plane, and so do the ends.
TEST(OutlineOfContours, EachEndGoesOnAsItself) {
  const ObliquePlanes planes;
  const auto wide_at = [](int k) { return 6.0 + 4 * k; };
  std::vector<Contour> contours;
  for (int k = 0; k < 5; ++k) {
    const double wide = wide_at(k);
    contours.push_back(planes.contour({{0, 0}, {wide, 0}, {wide, 10}, {0, 10}}, 2.0 * k));
  }
  Geometry scan;  // of the contours' slices alone
  scan.dimensions = {50, 50, 5};
  scan.direction_i = planes.u;
  scan.direction_j = planes.v;
  scan.step = 2.0 * planes.n;
  for (int k = 0; k < 5; ++k) scan.slice_positions.push_back(planes.at(-10, -10, 2.0 * k));
  for (const bool turned : {false, true}) {  // contours in either order, and so a normal of either sense
    if (turned) {
      std::ranges::reverse(contours);
      for (Contour& contour : contours) std::ranges::reverse(contour);
    }
    const ContourStack stack = stack_of(contours);
    const OutlinePlanes outline = planes_of(stack, {.scan = &scan});
    const NodeLattice& lattice = outline.lattice;
    const glm::ivec2 size(lattice.bricks * NodeBricks::edge);
    std::array<int, 3> met{};
    for (std::size_t plane = 0; plane < outline.node.size(); ++plane) {
      PlaneDistances distances;
      outline.compute(plane, distances);
      const auto place_of = [&](int n) {
        return lattice.position({n % size.x, n / size.x, outline.node[plane]}) - planes.first;
      };
      const int k = static_cast<int>(std::lround(glm::dot(place_of(0), planes.n) / 2));
      ++met[k < 0 ? 0 : k > 4 ? 2 : 1];
      const double wide = wide_at(std::clamp(k, 0, 4));
      for (int n = 0; n < size.x * size.y; ++n) {
        const double x = glm::dot(place_of(n), planes.u), y = glm::dot(place_of(n), planes.v);
        const double depth = std::min({x, wide - x, y, 10 - y});
        if (std::abs(depth) < 1e-6) continue;
        ASSERT_EQ(distances.to_inside[static_cast<std::size_t>(n)] == 0, depth > 0) << k << ' ' << x << ' ' << y;
      }
    }
    EXPECT_EQ(met[1], 5);
    EXPECT_GE(met[0], 3) << "below";
    EXPECT_EQ(met[0], met[2]) << "above";
  }
}

TEST(ContourStacks, AreOfTheLargestContoursPlane) {
  const ObliquePlanes planes;
  const Points tiny{{5, 5}, {5.2, 5}, {5, 5.2}};
  for (const bool first : {false, true}) {
    std::vector<Contour> contours{planes.contour(drawn_square, 0), planes.contour(drawn_square, 2)};
    Contour tilted = planes.contour(tiny, 2);
    tilted[1] += 0.2 * planes.n;
    contours.insert(first ? contours.begin() : contours.end(), tilted);
    const ContourStack stack = stack_of(contours);
    EXPECT_LT(glm::length(glm::cross(stack.axes[2], planes.n)), 1e-9) << first;
  }
}

// Heights within a twentieth of a millimeter are one plane, where others are clearly farther apart; a contour leans by
// half a millimeter at most.
TEST(ContourStacks, PlanesAreMoreThanATwentiethOfAMillimeterApart) {
  const ObliquePlanes planes;
  const auto planes_at = [&](double height) {
    return stack_of({planes.contour(drawn_square, 0), planes.contour(drawn_square, 4),
                     planes.contour(drawn_square, 4 + height)})
        .planes.size();
  };
  EXPECT_EQ(planes_at(1e-4), 2U);
  EXPECT_EQ(planes_at(0.045), 2U);
  EXPECT_EQ(planes_at(0.055), 3U);
  EXPECT_EQ(planes_at(0.3), 3U);
  for (const auto& [leaning, fits] : {std::pair{0.49, true}, {0.51, false}}) {
    Contour contour = planes.contour({{3, 3}, {9, 3}, {9, 9}}, 2);
    contour[1] += leaning * planes.n;
    const std::vector<Contour> contours{planes.contour(drawn_square, 0), contour};
    if (fits) {
      EXPECT_NO_THROW(stack_of(contours));
    } else {
      EXPECT_THROW(stack_of(contours), DicomError);
    }
  }
}

// Along the patient's axes as long as rounding can have turned the normal, and along its own beyond that.
TEST(ContourStacks, LieAlongThePatientsAxesWhereTheyNearlyDo) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const auto& [lean, along] : {std::pair{1e-5, true}, {1e-4, false}, {0.01, false}, {0.3, false}}) {
      Vec3 normal(0);
      normal[axis] = 1;
      normal[(axis + 1) % 3] = lean;
      normal = glm::normalize(normal);
      const Vec3 u = glm::normalize(glm::cross(normal, Vec3(0.3, 0.5, 0.7))), v = glm::cross(normal, u);
      const ContourStack stack = stack_of({{3.0 * u, 3.0 * v, -3.0 * u}, {3.0 * u + normal, 3.0 * v + normal, normal}});
      Vec3 expected = normal;
      if (along) {
        expected = Vec3(0);
        expected[axis] = 1;
      }
      EXPECT_LT(std::min(glm::distance(stack.axes[2], expected), glm::distance(stack.axes[2], -expected)), 1e-9)
          << axis << ' ' << lean;
      EXPECT_NEAR(glm::determinant(stack.axes), 1, 1e-9);
    }
  }
}

Geometry lattice_with(int slices, const Vec3& first, const Vec3& step) {
  const ObliquePlanes planes;
  Geometry g;
  g.dimensions = {12, 10, slices};
  g.direction_i = planes.u;
  g.direction_j = planes.v;
  g.spacing_i = 0.8;
  g.spacing_j = 1.1;
  g.step = step;
  for (int k = 0; k < slices; ++k) g.slice_positions.push_back(first + static_cast<double>(k) * step);
  return g;
}

// Up to half a voxel beyond the scan's outermost ones, along each of its axes. What lies beyond on another axis does
// not count.
TEST(PlacesThatAScanHasSeen, EndHalfAVoxelBeyondIt) {
  const ObliquePlanes planes;
  const Geometry scan = lattice_with(5, planes.first, 2.0 * planes.n + 0.3 * planes.v);
  const DistanceOptions options{.scan = &scan};
  const std::array normals{planes.u, planes.v, planes.n};
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool behind : {false, true}) {
      for (const auto& [beyond, seen] : {std::pair{-1.0, true}, {0.45, true}, {0.55, false}, {4.0, false}}) {
        for (const double aside : {0.0, -30.0, 50.0}) {
          for (const double sense : {-1.0, 1.0}) {
            Vec3 index(3, 2, 1);
            index[(axis + 1) % 3] += aside;
            index[axis] = behind ? scan.dimensions[axis] - 1 + beyond : -beyond;
            const Vec3 normal = glm::normalize(sense * normals.at(static_cast<std::size_t>(axis)) + 0.1 * planes.u);
            EXPECT_EQ(is_seen(options, scan.to_patient(index), normal), seen) << axis << behind << ' ' << beyond;
            EXPECT_TRUE(is_seen({}, scan.to_patient(index), normal));
          }
        }
      }
    }
  }
}

// Contours that end within the scan end there, wherever their middle lies beside the scan; at the scan's own ends they
// go on.
TEST(PlacesThatAScanHasSeen, EndContoursWhereverTheirMiddleLies) {
  const glm::dmat3 straight(1), turned(ObliquePlanes().u, ObliquePlanes().v, ObliquePlanes().n);
  for (const glm::dmat3& axes : {straight, turned}) {
    Geometry scan;
    scan.dimensions = {24, 20, 22};
    scan.direction_i = axes[0];
    scan.direction_j = axes[1];
    scan.step = axes[2];
    for (int k = 0; k < 22; ++k) scan.slice_positions.push_back(static_cast<double>(k) * axes[2]);
    DistanceOptions options{.scan = &scan};
    for (int axis = 0; axis < 3; ++axis) {
      for (const auto& [x, y] : {std::pair{10.0, 10.0}, {-4.0, 8.0}, {9.0, 27.0}, {-3.0, -3.0}, {26.0, 27.0}}) {
        for (const bool through : {false, true}) {
          const int first = through ? 0 : 7, last = through ? scan.dimensions[axis] - 1 : 12;
          const auto at = [&, x = x, y = y](double beside, double along, double height) {
            Vec3 index(0);
            index[axis] = height;
            index[(axis + 1) % 3] = x + beside;
            index[(axis + 2) % 3] = y + along;
            return scan.to_patient(index);
          };
          std::vector<Contour> contours;
          for (int k = first; k <= last; ++k) {
            contours.push_back({at(-13, -13, k), at(13, -13, k), at(13, 13, k), at(-13, 13, k)});
          }
          const ContourStack stack = stack_of(contours);
          const OutlinePlanes planes = planes_of(stack, options);
          const double low = glm::dot(at(0, 0, first), stack.axes[2]), high = glm::dot(at(0, 0, last), stack.axes[2]);
          int beyond = 0;
          for (std::size_t n = 0; n < planes.node.size(); ++n) {
            const double height = glm::dot(planes.lattice.position({0, 0, planes.node[n]}), stack.axes[2]);
            const double away = std::max(std::min(low, high) - height, height - std::max(low, high));
            if (away < 0.1 || away > 4.1) continue;
            PlaneDistances distances;
            planes.compute(n, distances);
            const auto inside = std::ranges::count(distances.to_inside, 0.0F);
            EXPECT_EQ(inside > 0, through) << axis << ' ' << x << ' ' << y;
            ++beyond;
          }
          EXPECT_EQ(beyond, 8);
        }
      }
    }
  }
}

}  // namespace
}  // namespace palpate::io

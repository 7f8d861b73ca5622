// Every mode's force law on scanned bodies: slab, sphere, tube and wedge as voxels show them, sampled as a session
// samples them. A probe rests on a boundary and is then moved; what the mode's one primitive does to it has a closed
// form (equations 2 to 6) with the body's true normal and the strength that was asked for.
//
// What means nothing: a tube's direction on bodies that are no tubes (it is that of least curvature, whatever that is;
// its force law is held there all the same), and a body's normal for landmarks, whose place and direction are the
// user's own (the body says only how strong they are). Follow and force along a vector field read none of a body's
// shape either: a flow through the same four bodies is in scanned_flow_test.cpp, here they read the gradient.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "io/fields/volume_fields.h"
#include "modes/testing/scanned_bodies.h"
#include "modes/testing/test_rig.h"

namespace palpate::modes {
namespace {

using namespace testing;

constexpr double strength_n = 0.5;  // wherever a mode acts
constexpr io::FieldSet fields = io::FieldSet::value | io::FieldSet::gradient | io::FieldSet::tube;

struct Scanned {
  std::shared_ptr<const io::Volume> volume;
  double scale_mm = 0;
  std::unique_ptr<const io::VolumeFields> source;

  Scanned(const testdata::Phantom& phantom, const testdata::Grid& grid)
      : volume(std::make_shared<const io::Volume>(testdata::scan(phantom, testdata::make_geometry(grid)))),
        scale_mm(io::default_gradient_scale_mm(volume->geometry)),
        source(std::make_unique<const io::VolumeFields>(volume, fields, scale_mm)) {}
};

/// Of a step's gradient at its place.
double steepest(const Spot& spot, double scale_mm) {
  return (spot.high - spot.low) / (scale_mm * std::sqrt(2 * std::numbers::pi));
}

/// Acts with its full strength at the boundary, and not at all where there is none.
Mode at_boundary(const char* type, const Spot& spot, double scale_mm) {
  Mode mode;
  mode.type = type;
  mode.strength_of = Datum::gradient_magnitude;
  const double peak = steepest(spot, scale_mm);
  mode.strength_n = TransferFunction({{0.2 * peak, 0}, {0.5 * peak, strength_n}});
  mode.direction_of = DirectionField::gradient;
  return mode;
}

Vec3 at_most(const Vec3& force, double most) {
  const double length = glm::length(force);
  return length > most ? force * (most / length) : force;
}

// The primitives' laws: what a probe feels that is `d` mm from where they stand.
Vec3 point_law(const Vec3& d) {
  return at_most(-stiffness_n_per_mm * d, strength_n);
}
Vec3 line_law(const Vec3& d, const Vec3& q) {
  return at_most(-stiffness_n_per_mm * (d - q * glm::dot(q, d)), strength_n);
}
Vec3 plane_law(const Vec3& d, const Vec3& q) {
  return q * std::clamp(-stiffness_n_per_mm * glm::dot(q, d), 0.0, strength_n);
}

/// Rests at each spot, is moved by up to 3 mm any way, and compares.
void expect_law(const Body& body, const Scanned& scanned, const std::function<Mode(const Spot&)>& mode,
                const std::function<Vec3(const Vec3& d, const Spot& spot)>& law, double tolerance) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> any(-1, 1);
  int slid = 0, stuck = 0;
  for (const Spot& spot : body.spots) {
    Hand hand(tick_by_tick(mode(spot)), *scanned.source);
    hand.move_to(spot.at);
    ASSERT_EQ(hand.result.primitives.size(), 1U);
    const double x = any(random), y = any(random), z = any(random);
    const Vec3 d = 1.7 * Vec3(x, y, z);
    hand.move_to(spot.at + d);
    const Vec3 expected = law(d, spot);
    EXPECT_LE(glm::length(hand.force() - expected), tolerance * stiffness_n_per_mm * glm::length(d) + 1e-9)
        << "moved " << d.x << ' ' << d.y << ' ' << d.z;
    (glm::length(expected) > 0.999 * strength_n ? slid : stuck) += 1;
  }
  EXPECT_GT(slid, 0);  // both sides of the law were met
  EXPECT_GT(stuck, 0);
}

/// The gradient's magnitude beside a boundary that a Gaussian has blurred, mm uphill; the leading term where the radius
/// is large beside the scale.
double gradient_beside(const Spot& spot, double uphill_mm, double scale_mm) {
  const double z = uphill_mm / scale_mm;
  const double bend = spot.bends == 0 ? 1 : std::pow(spot.radius / (spot.radius - uphill_mm), 0.5 * spot.bends);
  return steepest(spot, scale_mm) * std::exp(-0.5 * z * z) * bend;
}

struct Case {
  std::string name;
  Body body;
  Scanned scanned;
  double tolerance = 0;  ///< of directions, as a length beside 1
};

/// Every body, however it was scanned; made once.
const std::vector<Case>& cases() {
  static const std::vector<Case> all = [] {
    std::vector<Case> made;
    for (const Body& body : {slab(), sphere(), tube(), wedge()}) {
      for (const NamedGrid& sampling : samplings()) {
        // The normal of a round body between slices of 5 mm is off by some degrees; everywhere else by less than one.
        const bool is_undersampled = sampling.name == "thick" && (body.name == "sphere" || body.name == "tube");
        made.push_back({body.name + ", " + sampling.name, body, Scanned(body.phantom, sampling.grid),
                        is_undersampled ? 0.1 : 0.017});
      }
    }
    return made;
  }();
  return all;
}

void on_each_scan(const std::function<void(const Body& body, const Scanned& scanned, double tolerance)>& test) {
  for (const Case& made : cases()) {
    SCOPED_TRACE(made.name);
    test(made.body, made.scanned, made.tolerance);
  }
}

TEST(ScannedLaw, surface_pushes_back_along_the_normal_by_what_it_holds) {
  on_each_scan([](const Body& body, const Scanned& scanned, double tolerance) {
    for (const Side side : {Side::entering, Side::leaving}) {
      expect_law(
          body, scanned,
          [&](const Spot& spot) {
            Mode mode = at_boundary("surface", spot, scanned.scale_mm);
            mode.side = side;
            return mode;
          },
          [&](const Vec3& d, const Spot& spot) {
            return plane_law(d, side == Side::entering ? uphill(spot) * -1.0 : uphill(spot));
          },
          tolerance);
    }
  });
}

TEST(ScannedLaw, follow_is_free_along_the_gradient_and_resists_across_it) {
  on_each_scan([](const Body& body, const Scanned& scanned, double tolerance) {
    expect_law(
        body, scanned, [&](const Spot& spot) { return at_boundary("follow", spot, scanned.scale_mm); },
        [](const Vec3& d, const Spot& spot) { return line_law(d, uphill(spot)); }, tolerance);
  });
}

TEST(ScannedLaw, friction_holds_up_to_its_strength_whatever_way_it_is_pulled) {
  on_each_scan([](const Body& body, const Scanned& scanned, double) {
    const auto friction = [](const Spot& spot) {
      Mode mode;
      mode.type = "friction";
      const double middle = 0.5 * (spot.low + spot.high), step = spot.high - spot.low;
      // Full from a quarter of the step below the middle on: at the boundary, and in what is denser.
      mode.strength_n = TransferFunction({{middle - 0.4 * step, 0}, {middle - 0.25 * step, strength_n}});
      return mode;
    };
    // No direction is read: it is exact.
    expect_law(
        body, scanned, friction, [](const Vec3& d, const Spot&) { return point_law(d); }, 0);
    for (const Spot& spot : body.spots) {
      Hand hand(tick_by_tick(friction(spot)), *scanned.source);
      const Vec3 thinner = spot.at - (2 * scanned.scale_mm + 2) * uphill(spot);
      hand.move_to(thinner);
      hand.move_to(thinner - 0.5 * uphill(spot));
      EXPECT_EQ(hand.force(), Vec3(0)) << "friction where its strength is zero";
    }
  });
}

TEST(ScannedLaw, force_pushes_uphill_by_the_strength_of_the_gradient_there) {
  on_each_scan([](const Body& body, const Scanned& scanned, double tolerance) {
    for (const Spot& spot : body.spots) {
      const double peak = steepest(spot, scanned.scale_mm);
      Mode mode = at_boundary("force", spot, scanned.scale_mm);
      mode.strength_n = TransferFunction({{0, 0}, {2 * peak, 0.4}});
      Hand hand(tick_by_tick(mode), *scanned.source);
      for (const double along : {-0.8, 0.0, 0.8}) {
        // The proxy is drawn ahead of the probe, until the force there is the pull: it settles within some ticks.
        for (int tick = 0; tick < 30; ++tick) {
          hand.move_to(spot.at + along * scanned.scale_mm * uphill(spot));
        }
        const double from_edge = glm::dot(hand.proxy_mm() - spot.at, uphill(spot));
        const double expected = 0.2 / peak * gradient_beside(spot, from_edge, scanned.scale_mm);
        // Voxels widen the Gaussian by what is said in io/README.md: less at the edge, more beside it.
        EXPECT_NEAR(glm::length(hand.force()) / expected, 1, scanned.volume->geometry.step.z > 4 ? 0.3 : 0.1) << along;
        EXPECT_LE(glm::length(glm::normalize(hand.force()) - uphill(spot)), tolerance + 0.01) << along;
      }
    }
  });
}

TEST(ScannedLaw, landmark_acts_at_its_own_place_as_strongly_as_the_tissue_at_the_proxy_says) {
  on_each_scan([](const Body& body, const Scanned& scanned, double) {
    const Vec3 direction = glm::normalize(Vec3(2, -1, 3));
    for (const Shape shape : {Shape::point, Shape::line, Shape::plane}) {
      std::mt19937 random(11);
      std::uniform_real_distribution<double> any(-1, 1);
      for (const Spot& spot : body.spots) {
        const double middle = 0.5 * (spot.low + spot.high), step = spot.high - spot.low;
        Mode mode;
        mode.type = "landmark";
        mode.shape = shape;
        mode.strength_n = TransferFunction({{middle - 0.4 * step, 0}, {middle - 0.25 * step, strength_n}});
        mode.position_mm = spot.at + 1.0 * uphill(spot);
        mode.direction = direction;
        Hand hand(tick_by_tick(mode), *scanned.source);
        const double x = any(random), y = any(random), z = any(random);
        const Vec3 d = 1.7 * Vec3(x, y, z);
        hand.move_to(mode.position_mm);
        hand.move_to(mode.position_mm + d);
        const Vec3 expected = shape == Shape::point  ? point_law(d)
                              : shape == Shape::line ? line_law(d, direction)
                                                     : plane_law(d, direction);
        EXPECT_LE(glm::length(hand.force() - expected), 1e-9);
        Hand elsewhere(tick_by_tick(mode), *scanned.source);
        elsewhere.move_to(spot.at - (2 * scanned.scale_mm + 2) * uphill(spot));
        EXPECT_EQ(elsewhere.force(), Vec3(0)) << "felt in tissue where its strength is zero";
      }
    }
  });
}

TEST(ScannedLaw, tube_is_free_along_a_vessel_and_resists_across_it) {
  const Vec3 axis = glm::normalize(Vec3(0.3, 0.5, 1));
  Body vessel{"vessel", testdata::make_tube(3, axis, 300), {}};
  std::mt19937 random(12);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int i = 0; i < spots_of_each; ++i) {
    const double along = any(random), off = any(random);
    vessel.spots.push_back({12 * along * axis + 0.8 * off * across(axis), axis, testdata::soft_tissue_hu, 300});
  }
  const auto tube_mode = [](const Spot&) {
    Mode mode;
    mode.type = "tube";
    mode.strength_n = TransferFunction({{145, 0}, {155, strength_n}});
    return mode;
  };
  for (const NamedGrid& sampling : samplings()) {
    if (sampling.name == "thick") {
      continue;  // a vessel of 6 mm is hardly more than a slice of 5
    }
    SCOPED_TRACE(sampling.name);
    const Scanned scanned(vessel.phantom, sampling.grid);
    expect_law(
        vessel, scanned, tube_mode, [&](const Vec3& d, const Spot&) { return line_law(d, axis); }, 0.05);
    Hand hand(tick_by_tick(tube_mode(vessel.spots[0])), *scanned.source);
    hand.move_to(20.0 * across(axis));
    EXPECT_TRUE(hand.result.primitives.empty()) << "there is no vessel here";
  }
}

/// Where no vessel is, whatever direction the curvature gives: what is felt is that line's law.
TEST(ScannedLaw, tube_obeys_its_law_on_bodies_that_are_no_tubes) {
  on_each_scan([](const Body& body, const Scanned& scanned, double) {
    Mode mode;
    mode.type = "tube";
    mode.strength_n = TransferFunction(strength_n);
    for (const Spot& spot : body.spots) {
      const Vec3 q = scanned.source->sample(spot.at, fields).tube;
      Hand hand(tick_by_tick(mode), *scanned.source);
      hand.move_to(spot.at);
      const Vec3 d(0.7, -0.9, 0.4);
      hand.move_to(spot.at + d);
      EXPECT_LE(glm::length(hand.force() - (q == Vec3(0) ? Vec3(0) : line_law(d, q))), 1e-9);
    }
  });
}

}  // namespace
}  // namespace palpate::modes

// The sphere of the force laws: R = 25 mm, voxels of 1 mm, default gradient scale, up to 50 mm/s.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <memory>

#include "io/fields/volume_fields.h"
#include "modes/testing/test_rig.h"
#include "testdata/scan.h"

namespace palpate::modes {
namespace {

using testing::stiffness_n_per_mm;

constexpr double radius_mm = 25.0;

/// Voxels of 1 mm at the default gradient scale, as a scanner would show the sphere.
io::VolumeFields scanned_sphere() {
  auto volume =
      std::make_shared<const io::Volume>(testdata::scan(testdata::make_sphere(radius_mm), testdata::make_geometry({})));
  const double scale_mm = io::default_gradient_scale_mm(volume->geometry);
  return {std::move(volume), io::FieldSet::value | io::FieldSet::gradient, scale_mm};
}

struct Slide {
  double worst_degrees = 0;                      ///< of the force against the radial direction, beyond v dt / R
  double worst_change = 0;                       ///< |force change| of a tick over its bound
  double least_felt_mm = 1e9, most_felt_mm = 0;  ///< radius of the proxy
};

Slide slide(const io::FieldSource& source, double depth_mm, double speed_mm_per_ms) {
  testing::Hand hand(testing::scene_of({testing::surface(TransferFunction({{-490, 0}, {-470, 3}}), Datum::value)}),
                     source);
  const Vec3 a = glm::normalize(Vec3(0.2, 0.5, 0.9));
  const Vec3 b = glm::normalize(glm::cross(a, Vec3(0.7, -0.1, 0.4)));
  const double pressed = radius_mm - depth_mm;
  hand.stroke((radius_mm + 3) * a, pressed * a, 2000);
  Slide slide;
  Vec3 force = hand.force();
  Vec3 probe = pressed * a;
  const double angle_step = speed_mm_per_ms / pressed;
  const int ticks = static_cast<int>(6.283 / angle_step);
  for (int i = 1; i <= ticks; ++i) {
    // A great circle that also presses and eases by 0.2 mm, at 1/5 of the speed at most.
    const double angle = angle_step * i;
    const double r = pressed + 0.2 * std::sin(angle * pressed);
    const Vec3 next = r * (std::cos(angle) * a + std::sin(angle) * b);
    hand.move_to(next);
    const Vec3 radial = glm::normalize(hand.proxy_mm());
    const double cosine = glm::dot(glm::normalize(hand.force()), radial);
    const double degrees = std::acos(std::min(1.0, cosine)) * 180 / M_PI;
    slide.worst_degrees = std::max(slide.worst_degrees, degrees - glm::length(next - probe) / radius_mm * 180 / M_PI);
    const double radial_step = std::abs(glm::length(next) - glm::length(probe));
    const double tangential_step =
        std::sqrt(std::max(0.0, glm::dot(next - probe, next - probe) - radial_step * radial_step));
    // Depth below the surface that is felt: with voxels its radius is off by up to 0.1 mm (below), much of a shallow
    // press.
    const double d = std::max(radius_mm - glm::length(next), glm::length(force) / stiffness_n_per_mm);
    const double bound = 1.2 * stiffness_n_per_mm * (radial_step + d * tangential_step / (radius_mm - d)) + 1e-6;
    slide.worst_change = std::max(slide.worst_change, glm::length(hand.force() - force) / bound);
    slide.least_felt_mm = std::min(slide.least_felt_mm, glm::length(hand.proxy_mm()));
    slide.most_felt_mm = std::max(slide.most_felt_mm, glm::length(hand.proxy_mm()));
    force = hand.force();
    probe = next;
  }
  return slide;
}

TEST(Sphere, voxels_of_1_mm_give_the_direction_within_1_degree_and_no_jump_of_force) {
  const io::VolumeFields source = scanned_sphere();
  // From 1 mm on: what the felt radius varies by along the way (0.1 mm) is not little beside a shallower press.
  for (const double depth : {1.0, 2.0, 4.0}) {
    for (const double speed : {0.005, 0.05}) {
      const Slide felt = slide(source, depth, speed);
      SCOPED_TRACE(::testing::Message() << "depth " << depth << " mm, speed " << speed << " mm/ms");
      EXPECT_LE(felt.worst_degrees, 1.0);
      EXPECT_LE(felt.worst_change, 1.0);
      EXPECT_GE(felt.least_felt_mm, radius_mm - 0.2);
      EXPECT_LE(felt.most_felt_mm, radius_mm + 0.2);
    }
  }
}

}  // namespace
}  // namespace palpate::modes

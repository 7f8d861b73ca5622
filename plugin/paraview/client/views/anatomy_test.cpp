#include "plugin/paraview/client/views/anatomy.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <set>

namespace palpate::plugin {
namespace {

constexpr Plane planes[] = {Plane::axial, Plane::coronal, Plane::sagittal};
const std::array<glm::dvec3, 3> axial_scan{glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)};
// As scanners acquire them: columns to the patient's left and rows to the feet; columns to the back and rows to the
// feet.
const std::array<glm::dvec3, 3> coronal_scan{glm::dvec3(1, 0, 0), glm::dvec3(0, 0, -1), glm::dvec3(0, 1, 0)};
const std::array<glm::dvec3, 3> sagittal_scan{glm::dvec3(0, 1, 0), glm::dvec3(0, 0, -1), glm::dvec3(-1, 0, 0)};

/// Letters at the right, left, top and bottom edge of the screen.
std::array<std::string, 4> edges(const Sight& sight) {
  const glm::dvec3 right = glm::cross(sight.along, sight.up);
  return {letters_of(right), letters_of(-right), letters_of(sight.up), letters_of(-sight.up)};
}

TEST(Letters, NameTheSixDirectionsOfThePatient) {
  EXPECT_EQ(letters_of({1, 0, 0}), "L");
  EXPECT_EQ(letters_of({-2, 0, 0}), "R");
  EXPECT_EQ(letters_of({0, 1, 0}), "P");
  EXPECT_EQ(letters_of({0, -1, 0}), "A");
  EXPECT_EQ(letters_of({0, 0, 3}), "H");
  EXPECT_EQ(letters_of({0, 0, -1}), "F");
  EXPECT_EQ(letters_of({0, 0, 0}), "");
}

TEST(Letters, AreTwoFromTenDegreesOffOnTheNearerFirst) {
  const auto leaning = [](double degrees) {
    const double angle = degrees * std::numbers::pi / 180;
    return letters_of({0, -std::cos(angle), -std::sin(angle)});
  };
  EXPECT_EQ(leaning(9), "A");
  EXPECT_EQ(leaning(11), "AF");
  EXPECT_EQ(leaning(50), "FA");
  EXPECT_EQ(leaning(85), "F");
}

TEST(PlaceText, SaysHowFarToWhichSideOfThePatient) {
  EXPECT_EQ(place_text({12.34, 4, 88.06}), "L 12.3 P 4.0 H 88.1 mm");
  EXPECT_EQ(place_text({-12.34, -4, -88.06}), "R 12.3 A 4.0 F 88.1 mm");
  EXPECT_EQ(place_text({-0.04, 0.04, -0.0}), "L 0.0 P 0.0 H 0.0 mm");
}

TEST(PlaceText, TurnsLeftAndPosteriorRoundForRas) {
  EXPECT_EQ(place_text({12.34, 4, 88.06}, Coordinates::ras), "RAS -12.3 -4.0 88.1 mm");
  EXPECT_EQ(place_text({-0.01, 0, -5}, Coordinates::ras), "RAS 0.0 0.0 -5.0 mm");
}

TEST(Sight, ShowsEveryPlaneAsRadiologyDoesHoweverTheScanWasAcquired) {
  for (const auto& scan : {axial_scan, coronal_scan, sagittal_scan}) {
    EXPECT_THAT(edges(sight_of(Plane::axial, scan)), ::testing::ElementsAre("L", "R", "A", "P"));
    EXPECT_THAT(edges(sight_of(Plane::coronal, scan)), ::testing::ElementsAre("L", "R", "H", "F"));
    EXPECT_THAT(edges(sight_of(Plane::sagittal, scan)), ::testing::ElementsAre("P", "A", "H", "F"));
  }
}

TEST(Sight, LooksStraightAtASliceOfAnObliqueOrTiltedScan) {
  const double tilt = 25 * std::numbers::pi / 180;
  const std::array<glm::dvec3, 3> tilted{glm::dvec3(1, 0, 0), glm::dvec3(0, std::cos(tilt), std::sin(tilt)),
                                         glm::dvec3(0, 0, 1)};
  const std::array<glm::dvec3, 3> oblique{glm::dvec3(0.8, 0.6, 0), glm::dvec3(-0.48, 0.64, 0.6),
                                          glm::dvec3(0.36, -0.48, 0.8)};
  for (const auto& scan : {tilted, oblique}) {
    std::set<int> axes;
    for (const Plane plane : planes) {
      const Sight sight = sight_of(plane, scan);
      axes.insert(sight.index_axis);
      EXPECT_NEAR(glm::dot(sight.along, scan[static_cast<std::size_t>((sight.index_axis + 1) % 3)]), 0, 1e-12);
      EXPECT_NEAR(glm::dot(sight.along, scan[static_cast<std::size_t>((sight.index_axis + 2) % 3)]), 0, 1e-12);
      EXPECT_NEAR(glm::dot(sight.along, sight.up), 0, 1e-12);
      EXPECT_NEAR(glm::length(sight.up), 1, 1e-12);
    }
    EXPECT_EQ(axes.size(), 3U) << "two planes show the same slices";
  }
  EXPECT_THAT(edges(sight_of(Plane::axial, tilted)), ::testing::ElementsAre("L", "R", "AF", "PH"));
}

}  // namespace
}  // namespace palpate::plugin

// Contours in files: at heights that rounding once split into two planes, in a time proportional to their points, and
// with the thickness given by the file, its other ROIs or the scan.
#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

#include "io/structures/edits.h"
#include "io/structures/structure.h"
#include "io/testing/test_image.h"

namespace palpate::io {
namespace {

using internal::TestFolder;

struct RoiContour {
  double radius = 10, height = 0;
  int points = 40;
  std::string thickness;  // empty: not said
  const char* type = "CLOSED_PLANAR";
};

std::string circle_points(const RoiContour& contour) {
  std::string text;
  std::array<char, 80> point{};
  for (int n = 0; n < contour.points; ++n) {
    const double angle = 2 * std::numbers::pi * n / contour.points;
    std::snprintf(point.data(), point.size(), "%s%.6f\\%.6f\\%.6f", n == 0 ? "" : "\\",
                  contour.radius * std::cos(angle), contour.radius * std::sin(angle), contour.height);
    text += point.data();
  }
  return text;
}

double circle_area(double radius, int points) {
  return points / 2.0 * radius * radius * std::sin(2 * std::numbers::pi / points);
}

DcmItem& added_item(DcmItem& item, const DcmTagKey& sequence) {
  DcmItem* added = nullptr;
  internal::succeed(item.findOrCreateSequenceItem(sequence, added, -2));
  return *added;
}

/// A file with these ROIs, numbered from 1; or with all of them as items of ROI 1.
std::vector<Structure> rois_in(const std::vector<std::vector<RoiContour>>& rois, const TestFolder& folder,
                               bool is_one = false) {
  internal::TestImage image;
  image.edit = [&](DcmDataset& dataset) {
    dataset.findAndDeleteElement(DCM_PixelData);
    internal::put(dataset, DCM_SOPClassUID, "1.2.840.10008.5.1.4.1.1.481.3");
    for (std::size_t n = 0; n < rois.size(); ++n) {
      const std::string number = std::to_string(is_one ? 1 : n + 1);
      if (n == 0 || !is_one)
        added_item(dataset, DCM_StructureSetROISequence).putAndInsertString(DCM_ROINumber, number.c_str());
      DcmItem& drawn = added_item(dataset, DCM_ROIContourSequence);
      drawn.putAndInsertString(DCM_ReferencedROINumber, number.c_str());
      for (const RoiContour& contour : rois[n]) {
        DcmItem& item = added_item(drawn, DCM_ContourSequence);
        item.putAndInsertString(DCM_ContourGeometricType, contour.type);
        if (!contour.thickness.empty()) {
          internal::succeed(item.putAndInsertString(DcmTagKey(0x3006, 0x0044), contour.thickness.c_str()));
        }
        item.putAndInsertString(DCM_ContourData, circle_points(contour).c_str());
      }
    }
  };
  internal::write(image, folder / "rt.dcm");
  return find_structures(std::array{folder.path()}).structures;
}

TEST(ContourFiles, AHollowOrganHasItsVolumeWhateverTheDigitsOfItsHeights) {
  for (const double first : {-120.0, -87.995, 3.005, 0.015, 211.125, -0.005, 912.345}) {
    for (const double step : {1.0, 1.25, 2.5, 3.0}) {
      std::vector<RoiContour> contours;
      double expected = 0;
      for (int k = 0; k < 7; ++k) {
        const double height = first + k * step;
        contours.push_back({20, height, 61 + 17 * k});
        contours.push_back({11, height, 40 + 3 * k});
        expected += (circle_area(20, 61 + 17 * k) - circle_area(11, 40 + 3 * k)) * step;
      }
      const TestFolder folder;
      const std::vector<Structure> found = rois_in({contours}, folder);
      ASSERT_EQ(found.size(), 1U);
      EXPECT_EQ(found[0].unfit, "");
      EXPECT_TRUE(found[0].warnings.empty()) << first << ' ' << found[0].warnings.front();
      EXPECT_NEAR(measure(found[0]).volume_mm3, expected, 1e-3) << first << ' ' << step;
    }
  }
}

TEST(ContourFiles, AreReadInATimeThatGrowsWithTheirPoints) {
  const auto seconds_for = [](int points) {
    const TestFolder folder;
    rois_in({{{50, 0, points}, {50, 3, points}}}, folder);
    double least = std::numeric_limits<double>::infinity();
    for (int turn = 0; turn < 3; ++turn) {
      const std::clock_t begin = std::clock();  // of the processor: other programs may run beside
      const auto found = find_structures(std::array{folder.path()});
      least = std::min(least, static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
      EXPECT_EQ(found.structures.at(0).unfit, "");
    }
    return least;
  };
  // Eight times as many: 8 times as long, and 64 with the square.
  EXPECT_LT(seconds_for(20000), 24 * seconds_for(2500));
}

/// Of three others the one in the middle counts, in whatever order they are listed.
TEST(ContourFiles, APlaneAloneIsAsThickAsTheOthersUsuallyAre) {
  std::vector<double> steps{2, 4, 12};
  do {
    for (const std::size_t place : {0U, 1U, 3U}) {
      std::vector<std::vector<RoiContour>> rois;
      for (const double step : steps) rois.push_back({{9, 0}, {9, step}, {9, 2 * step}});
      rois.insert(rois.begin() + static_cast<std::ptrdiff_t>(place), std::vector<RoiContour>{{10, 4}});
      const TestFolder folder;
      const auto found = rois_in(rois, folder);
      EXPECT_NEAR(measure(found.at(place)).volume_mm3, 4 * circle_area(10, 40), 1e-3)
          << steps[0] << ' ' << steps[1] << ' ' << steps[2] << ", at " << place;
    }
  } while (std::ranges::next_permutation(steps).found);
}

TEST(ContourFiles, APlaneAloneIsAsThickAsTheFileOrTheScanSays) {
  const double area = circle_area(10, 40);
  const auto volume = [](const Structure& structure, const Geometry* scan = nullptr) {
    return measure(structure, scan).volume_mm3;
  };
  Geometry scan;
  scan.dimensions = {60, 60, 30};
  scan.spacing_i = 0.5;
  scan.spacing_j = 0.75;
  scan.step = {0, 0, 1.5};
  for (int k = 0; k < 30; ++k) scan.slice_positions.emplace_back(-15, -22, 1.5 * k - 20);
  {
    const TestFolder folder;
    const auto found = rois_in({{{10, 4, 40, "2.5"}}, {{10, 4}}, {{9, 0}, {9, 4}, {9, 8}}}, folder);
    EXPECT_NEAR(volume(found.at(0)), 2.5 * area, 1e-3) << "said";
    EXPECT_NEAR(volume(found.at(0), &scan), 2.5 * area, 1e-3) << "said";
    EXPECT_NEAR(volume(found.at(1)), 4 * area, 1e-3) << "as its neighbors'";
    EXPECT_TRUE(measure(found.at(1)).warnings.empty());
  }
  const TestFolder folder;
  const auto alone = rois_in({{{10, 4}}}, folder);
  EXPECT_NEAR(volume(alone.at(0), &scan), 1.5 * area, 1e-3) << "of the scan's slices";
  EXPECT_TRUE(measure(alone.at(0), &scan).warnings.empty());
  EXPECT_NEAR(volume(alone.at(0)), area, 1e-3);
  ASSERT_EQ(measure(alone.at(0)).warnings.size(), 1U);
  EXPECT_EQ(measure(alone.at(0)).warnings[0],
            "its contours lie in one plane, and nothing says how thick it is: it counts as 1 mm");
  // Slices that stand across the contours: what counts is how far a voxel reaches along their normal.
  Geometry across = scan;
  across.direction_i = {0, 0, 1};
  across.direction_j = {0, 1, 0};
  across.step = {1.5, 0, 0};
  EXPECT_NEAR(volume(alone.at(0), &across), 0.5 * area, 1e-3);
}

TEST(ContourFiles, AnExclusiveOrTakesAwayWhatTwoHold) {
  const TestFolder folder;
  std::vector<RoiContour> contours;
  for (const double height : {0.0, 2.0}) {
    for (const double radius : {10.0, 10.0, 10.0, 7.0}) {
      contours.push_back({radius, height, 40, "", "CLOSEDPLANAR_XOR"});
    }
  }
  const auto found = rois_in({contours}, folder);
  EXPECT_NEAR(measure(found.at(0)).volume_mm3, 4 * (circle_area(10, 40) - circle_area(7, 40)), 1e-3);
}

// A plane alone is as thick as the scan's voxels, whether it is drawn or read, and wherever it lies between two slices.
TEST(PlanesAlone, AreTheSameReadAndDrawn) {
  for (const double slices_mm : {0.3, 1.0, 5.0}) {
    for (const double height : {0.0, 0.35, -0.1}) {
      Geometry scan;
      scan.dimensions = {60, 60, 41};
      scan.step = {0, 0, slices_mm};
      for (int k = -20; k <= 20; ++k) scan.slice_positions.emplace_back(-30, -30, k * slices_mm);
      DistanceOptions options;
      options.scan = &scan;
      const RoiContour circle{.radius = 10, .height = height * slices_mm};
      const TestFolder folder;
      const auto read = load_distance(rois_in({{circle}}, folder).at(0), options);
      ContoursEdit drawn{.loops_mm = {{}}};
      for (int n = 0; n < circle.points; ++n) {
        const double angle = 2 * std::numbers::pi * n / circle.points;
        drawn.loops_mm[0].emplace_back(10 * std::cos(angle), 10 * std::sin(angle), circle.height);
      }
      EditOptions edit;
      edit.distance.scan = &scan;
      const auto made = apply_edit(nullptr, drawn, edit);
      double most = 0;
      for (double z = -1.5; z <= 1.5; z += 0.1) {
        for (double x = 0; x < 14; x += 0.7) {
          const Vec3 at(x, 0.4 * x, z * slices_mm);
          most = std::max(most, std::abs(made->sample(at).mm - read->sample(at).mm));
        }
      }
      EXPECT_LT(most, 0.05) << slices_mm << ' ' << height;
    }
  }
}

// Programs may write several items of one ROI: each adds its contours, in any order.
TEST(ContourFiles, ItemsOfOneRoiAddTheirContours) {
  std::vector<std::vector<RoiContour>> parts(3);
  for (int k = 0; k < 12; ++k) parts[static_cast<std::size_t>(k % 3)].push_back({.height = 2.0 * k});
  std::vector<RoiContour> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  const TestFolder folder;
  const StructureMeasures whole = measure(rois_in({all}, folder).at(0));
  for (int turn = 0; turn < 3; ++turn) {
    const TestFolder other;
    const Structure one = rois_in(parts, other, true).at(0);
    EXPECT_TRUE(one.unfit.empty()) << one.unfit;
    EXPECT_EQ(measure(one).contours, 12U);
    EXPECT_NEAR(measure(one).volume_mm3, whole.volume_mm3, 1e-6);
    std::rotate(parts.begin(), parts.begin() + 1, parts.end());
  }
  // One without a contour, first or last, takes nothing away.
  for (const auto& with_none : {std::vector{all, std::vector<RoiContour>()}, {{}, all}}) {
    const TestFolder other;
    const Structure one = rois_in(with_none, other, true).at(0);
    EXPECT_TRUE(one.unfit.empty()) << one.unfit;
    EXPECT_NEAR(measure(one).volume_mm3, whole.volume_mm3, 1e-6);
  }
}

// What cannot be read in part is no outline: a part of an organ would be felt as the whole.
TEST(ContourFiles, ARoiWithAnItemThatCannotBeReadIsUnfitWhereverItStands) {
  const std::vector<RoiContour> sound{{.height = 0}, {.height = 2}}, broken{{.height = 4, .points = 0}};
  std::vector<std::vector<RoiContour>> items{broken, sound, sound};
  for (int turn = 0; turn < 3; ++turn) {
    const TestFolder folder;
    const Structure one = rois_in(items, folder, true).at(0);
    EXPECT_EQ(one.unfit, "a contour of it has 0 numbers, not three for each point") << turn;
    std::rotate(items.begin(), items.begin() + 1, items.end());
  }
}

// What is said of contours that are not closed is the same in one item or in several, in any order.
TEST(ContourFiles, ItemsOfOneRoiTellOfAllTheirContours) {
  const auto told = [](const std::vector<std::vector<RoiContour>>& items) {
    const TestFolder folder;
    const Structure one = rois_in(items, folder, true).at(0);
    std::vector<std::string> words{std::string(one.unfit)};
    for (const Text& warning : one.warnings) words.emplace_back(warning);
    return words;
  };
  const std::vector<RoiContour> closed{{.height = 0}, {.height = 2}}, none;
  const std::vector<RoiContour> points{{.type = "POINT"}, {.type = "POINT"}}, lines{{.type = "OPEN_PLANAR"}};
  for (const bool has_closed : {true, false}) {
    std::vector<std::vector<RoiContour>> items{points, lines, none};
    if (has_closed) items.push_back(closed);
    std::vector<RoiContour> all;
    for (const auto& item : items) all.insert(all.end(), item.begin(), item.end());
    const std::vector<std::string> whole = told({all});
    EXPECT_EQ(whole.size(), has_closed ? 2U : 1U);
    EXPECT_NE(whole.back().find("1 OPEN_PLANAR, 2 POINT"), std::string::npos) << whole.back();
    std::vector<std::size_t> order(items.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    do {
      std::vector<std::vector<RoiContour>> turned;
      for (const std::size_t n : order) turned.push_back(items[n]);
      EXPECT_EQ(told(turned), whole);
    } while (std::ranges::next_permutation(order).found);
  }
}

}  // namespace
}  // namespace palpate::io

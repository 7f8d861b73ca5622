// Which images form one series, and the messages about it, on both sides of each limit.
#include "io/dicom/grouping.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <string>
#include <vector>

#include "io/fields/gradient.h"

namespace palpate::io::internal {
namespace {

using ::testing::Contains;
using ::testing::IsEmpty;

using Edit = std::function<void(int, FileHeader&)>;

/// Eight slices 4 mm apart and as thick, for each of `times`: of MR, axial.
std::vector<FileHeader> slices(int times, const Edit& edit = {}) {
  std::vector<FileHeader> headers;
  for (int n = 0; n < 8 * times; ++n) {
    FileHeader header;
    header.path = "/scan/" + std::to_string(n);
    header.series = "1.2.3.4";
    header.modality = "MR";
    header.columns = header.rows = 6;
    header.thickness = header.details.thickness_mm = 4;
    header.instance_number = n;
    Plane plane;
    plane.placement = Placement{};
    plane.placement->position = {0, 0, 4.0 * (n % 8)};
    plane.placement->direction_i = {1, 0, 0};
    plane.placement->direction_j = {0, 1, 0};
    plane.placement->spacing_i = 0.75;
    plane.placement->spacing_j = 0.5;
    if (times > 1) plane.labels[static_cast<std::size_t>(Label::time_point)] = std::to_string(n / 8 + 1);
    header.planes = {plane};
    if (edit) edit(n, header);
    headers.push_back(std::move(header));
  }
  return headers;
}

std::vector<Series> series_of(std::vector<FileHeader> headers) {
  std::vector<SkippedFile> skipped;
  std::vector<Series> series = group_into_series(std::move(headers), skipped);
  EXPECT_TRUE(skipped.empty());
  return series;
}

/// How many volumes there are where the upper half of the slices is another.
std::size_t volumes_where(const std::function<void(FileHeader&)>& other) {
  return series_of(slices(1,
                          [&](int n, FileHeader& header) {
                            if (n >= 4) other(header);
                          }))
      .size();
}

TEST(Grouping, SlicesFitTogetherUpToTheLastDigitsOfTheirGrid) {
  EXPECT_EQ(volumes_where([](FileHeader&) {}), 1U);
  for (const double sign : {-1.0, 1.0}) {
    for (const auto& [part, volumes] : {std::pair{0.9, 1U}, {1.1, 2U}}) {
      SCOPED_TRACE(sign * part);
      const double spacing = 1 + sign * part * 1e-3, turn = sign * part * 1e-3;
      EXPECT_EQ(volumes_where([&](FileHeader& h) { h.planes[0].placement->spacing_i *= spacing; }), volumes);
      EXPECT_EQ(volumes_where([&](FileHeader& h) { h.planes[0].placement->spacing_j *= spacing; }), volumes);
      EXPECT_EQ(volumes_where([&](FileHeader& h) {
                  h.planes[0].placement->direction_i = {std::cos(turn), 0, std::sin(turn)};
                }),
                volumes);
      EXPECT_EQ(volumes_where([&](FileHeader& h) {
                  h.planes[0].placement->direction_j = {0, std::cos(turn), std::sin(turn)};
                }),
                volumes);
    }
  }
  EXPECT_EQ(volumes_where([](FileHeader& h) { h.columns = 7; }), 2U);
  EXPECT_EQ(volumes_where([](FileHeader& h) { h.rows = 7; }), 2U);
  EXPECT_EQ(volumes_where([](FileHeader& h) { h.modality = "CT"; }), 2U);
  EXPECT_EQ(volumes_where([](FileHeader& h) { h.frame_of_reference = "1.9"; }), 1U) << "the others do not say theirs";
}

// As far as the first or the last slice of any time lies from that of the first time; a fiftieth of a pixel is none.
TEST(Grouping, FramesThatLieApartAreTold) {
  const auto words = [](double first, double last) {
    const std::vector<Series> series = series_of(slices(3, [&](int n, FileHeader& header) {
      if (n / 8 == 1) header.planes[0].placement->position.z += first + (last - first) * (n % 8) / 7;
    }));
    EXPECT_EQ(series.size(), 1U);
    EXPECT_EQ(series.at(0).frames_per_position, 3);
    return std::vector<std::string>(series.at(0).warnings.begin(), series.at(0).warnings.end());
  };
  const auto apart = [](const char* mm) {
    return Contains(std::string("its frames lie up to ") + mm + " apart: each is felt where it is");
  };
  EXPECT_THAT(words(0.3, 0.4), apart("0.40 mm"));
  EXPECT_THAT(words(-0.4, -0.3), apart("0.40 mm"));
  EXPECT_THAT(words(0.5, 0.2), apart("0.50 mm"));
  EXPECT_THAT(words(0, 0), IsEmpty()) << "as many slices, too, are at every time";
}

// Of images that are no volume, the largest stack is the series' one line in the list.
TEST(Grouping, OfStacksWithoutAVolumeTheLargestIsListed) {
  for (const int alone : {0, 7}) {
    const std::vector<Series> series = series_of(slices(1, [=](int n, FileHeader& header) {
      header.image_type = "ORIGINAL\\PRIMARY\\LOCALIZER";
      if (n == alone) header.planes[0].placement->direction_j = {0, 0, 1};
    }));
    ASSERT_EQ(series.size(), 1U);
    EXPECT_FALSE(series[0].usable);
    EXPECT_EQ(series[0].geometry.dimensions.z, 7);
    EXPECT_EQ(series[0].files.size(), 8U);
  }
}

// The next slice has little weight in a gradient from two of its scales on.
TEST(Grouping, SlicesThatAGradientDoesNotSpanAreTold) {
  std::size_t spanned = 0;
  constexpr std::size_t tries = 40;
  for (std::size_t n = 0; n < tries; ++n) {
    const double spacing = 0.05 * std::pow(1.1, static_cast<double>(n));
    const std::vector<Series> series = series_of(slices(1, [=](int, FileHeader& header) {
      header.planes[0].placement->spacing_i = header.planes[0].placement->spacing_j = spacing;
    }));
    const bool told = !series.at(0).warnings.empty();
    EXPECT_EQ(told, 4 > 2 * largest_gradient_scale_mm(series[0].geometry)) << spacing;
    spanned += told ? 0U : 1U;
  }
  EXPECT_GT(spanned, 3U);
  EXPECT_LT(spanned, tries - 3);
}

// MR leaves a little between its slices; half of their thickness is more than that.
TEST(Grouping, GapsBetweenSlicesAreTold) {
  for (const auto& [thickness, told] : {std::pair{2.7, false}, {2.6, true}, {0.0, false}}) {
    const std::vector<Series> series = series_of(slices(1, [&, thickness = thickness](int, FileHeader& header) {
      header.thickness = header.details.thickness_mm = thickness;
    }));
    const std::vector<std::string> words(series.at(0).warnings.begin(), series.at(0).warnings.end());
    if (told) {
      EXPECT_THAT(words,
                  Contains("slices are 2.60 mm thick and 4.00 mm apart: what lies between them was not scanned"));
    } else {
      EXPECT_THAT(words, IsEmpty()) << thickness;
    }
  }
}

// Up to 20 degrees from an axis of the patient, to either side and about either of the other two.
TEST(Grouping, OrientationIsThatOfTheNearestAxis) {
  const std::array<const char*, 3> names{"sagittal", "coronal", "axial"};
  for (int axis = 0; axis < 3; ++axis) {
    for (const double degrees : {0.0, 19.5, -19.5, 20.5, -20.5, 35.0}) {
      for (const int toward : {1, 2}) {
        Vec3 normal(0);
        normal[axis] = std::cos(glm::radians(degrees));
        normal[(axis + toward) % 3] = std::sin(glm::radians(degrees));
        for (const double sense : {1.0, -1.0}) {
          Geometry geometry;
          geometry.direction_i = glm::normalize(glm::cross(normal, Vec3(0.3, 0.5, 0.7)));
          geometry.direction_j = sense * glm::cross(normal, geometry.direction_i);
          EXPECT_EQ(orientation_of(geometry),
                    std::abs(degrees) < 20 ? names.at(static_cast<std::size_t>(axis)) : "oblique")
              << axis << ' ' << degrees;
        }
      }
    }
  }
}

}  // namespace
}  // namespace palpate::io::internal

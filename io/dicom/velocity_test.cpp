#include "io/dicom/velocity.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcuid.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "io/testing/test_image.h"

namespace palpate::io::internal {
namespace {

using ::testing::SizeIs;

// Enhanced phase contrast: magnitude and three directions in one file, frame by frame.
TEST(Velocity, OfAnEnhancedFileIsJoined) {
  const TestFolder folder;
  std::vector<double> heights;
  for (int n = 0; n < 12; ++n) heights.push_back(2.0 * (n % 3));
  TestImage image;
  image.columns = 4;
  image.rows = 3;
  image.value = [](int i, int) { return 2048 + 100 * i; };
  image.edit = [&](DcmDataset& d) {
    put(d, DCM_BitsStored, 12);
    put(d, DCM_HighBit, 11);
    repeat_pixels(d, heights.size());
    make_multi_frame(d, heights, [&](std::size_t n, DcmItem& frame) {
      const bool magnitude = n < 3;
      DcmItem& type = group(frame, DCM_MRImageFrameTypeSequence);
      succeed(type.putAndInsertString(DCM_ComplexImageComponent, magnitude ? "MAGNITUDE" : "PHASE"));
      if (magnitude) return;
      DcmItem& velocity = group(frame, DCM_MRVelocityEncodingSequence);
      std::array<double, 3> along{};
      along[n / 3 - 1] = 1;
      succeed(velocity.putAndInsertFloat64Array(DCM_VelocityEncodingDirection, along.data(), 3));
      succeed(velocity.putAndInsertFloat64(DCM_VelocityEncodingMaximumValue, 150));
    });
  };
  write(image, folder / "enhanced");
  const Catalogue found = find_in(folder);
  ASSERT_THAT(found.series, SizeIs(1));
  EXPECT_EQ(found.series[0].frames_per_position, 4);
  ASSERT_THAT(found.velocity_fields, SizeIs(1));
  const Volume volume = load(found.velocity_fields[0]);
  ASSERT_TRUE(volume.vectors);
  for (int i = 0; i < 4; ++i) {
    const double speed = 1.5 * 100 * i / 2048;  // of 1.5 m/s at full range
    for (const auto& component : volume.vectors->along) EXPECT_NEAR(component->value_at(i, 1, 1), speed, 1e-12);
    EXPECT_NEAR(volume.value_at(i, 1, 1), std::sqrt(3.0) * speed, 1e-6);
  }
}

// Frames that name the unit of their rescale are in it, whatever largest velocity they were encoded for.
TEST(Velocity, OfAnEnhancedFileIsInTheUnitOfItsRescale) {
  struct Unit {
    const char* name;
    double meters_per_second, slope, intercept;
  };
  for (const Unit& unit : {Unit{"m/s", 1, 0.002, -3}, {"cm/s", 0.01, 0.25, -400}, {"mm/s", 0.001, -2, 3000}}) {
    for (const bool has_largest : {false, true}) {
      for (const bool shared : {false, true}) {
        SCOPED_TRACE(::testing::Message() << unit.name << ' ' << has_largest << ' ' << shared);
        const auto rescale = [&](DcmItem& groups) {
          DcmItem& values = group(groups, DCM_PixelValueTransformationSequence);
          succeed(values.putAndInsertString(DCM_RescaleType, unit.name));
          succeed(values.putAndInsertString(DCM_RescaleSlope, std::to_string(unit.slope).c_str()));
          succeed(values.putAndInsertString(DCM_RescaleIntercept, std::to_string(unit.intercept).c_str()));
        };
        const TestFolder folder;
        std::vector<double> heights;
        for (int n = 0; n < 9; ++n) heights.push_back(2.0 * (n % 3));
        TestImage image;
        image.value = [](int i, int j) { return 1000 + 100 * i + 7 * j; };
        image.edit = [&](DcmDataset& d) {
          repeat_pixels(d, heights.size());
          make_multi_frame(d, heights, [&](std::size_t n, DcmItem& frame) {
            succeed(group(frame, DCM_MRImageFrameTypeSequence).putAndInsertString(DCM_ComplexImageComponent, "PHASE"));
            DcmItem& velocity = group(frame, DCM_MRVelocityEncodingSequence);
            std::array<double, 3> along{};
            along[n / 3] = 1;
            succeed(velocity.putAndInsertFloat64Array(DCM_VelocityEncodingDirection, along.data(), 3));
            if (has_largest) succeed(velocity.putAndInsertFloat64(DCM_VelocityEncodingMaximumValue, 150));
            if (!shared) rescale(frame);
          });
          if (shared) rescale(group(d, DCM_SharedFunctionalGroupsSequence));
        };
        write(image, folder / "enhanced");
        const Catalogue found = find_in(folder);
        ASSERT_THAT(found.velocity_fields, SizeIs(1));
        const Volume volume = load(found.velocity_fields[0]);
        ASSERT_TRUE(volume.vectors);
        for (const auto& component : volume.vectors->along) {
          for (int i = 0; i < 6; ++i) {
            const double speed = unit.meters_per_second * (unit.slope * (1000 + 100 * i + 14) + unit.intercept);
            EXPECT_NEAR(component->value_at(i, 2, 1), speed, 1e-9);
          }
        }
      }
    }
  }
}

TEST(Velocity, NamedByTheSequenceIsJoined) {
  const TestFolder folder;
  constexpr std::array names{"*fl3d1_v80rl", "*fl3d1_v80ap", "*fl3d1_v80hf"};  // the last against the z axis
  for (std::size_t n = 0; n < names.size(); ++n) {
    std::filesystem::create_directory(folder / names[n]);
    write_stack(folder / names[n], 3, [&](int, TestImage& image) {
      image.series = "1.2.3." + std::to_string(n + 1);
      image.value = [](int, int) { return 49152; };  // half of the range above its middle
      image.edit = [&](DcmDataset& d) { put(d, DCM_SequenceName, names[n]); };
    });
  }
  const Catalogue found = find_in(folder);
  EXPECT_THAT(found.series, SizeIs(3));
  ASSERT_THAT(found.velocity_fields, SizeIs(1));
  EXPECT_THAT(found.velocity_fields[0].uid, ::testing::MatchesRegex("1.2.3.[1-3][+]1.2.3.[1-3][+]1.2.3.[1-3]"));
  // What cannot be known from public documents is said: once of the field, and of each series.
  EXPECT_THAT(found.velocity_fields[0].warnings, ::testing::Contains(::testing::HasSubstr("may be reversed")).Times(1));
  for (const Series& series : found.series) {
    EXPECT_THAT(series.warnings, ::testing::Contains(::testing::HasSubstr("may be reversed")));
  }
  const VectorComponents vectors = *load(found.velocity_fields[0]).vectors;
  Vec3 along;
  for (int n = 0; n < 3; ++n) along[n] = vectors.along[static_cast<std::size_t>(n)]->value_at(2, 2, 1);
  EXPECT_LT(glm::length(vectors.to_patient * along - Vec3(0.4, 0.4, -0.4)), 1e-12);
}

using Vector = std::array<double, 3>;

/// Three series of one study, each of the velocities along its own direction; `change` has the last word of one.
void write_directions(const TestFolder& folder, const std::array<Vector, 3>& directions,
                      const std::function<void(std::size_t, DcmDataset&)>& change) {
  for (std::size_t n = 0; n < 3; ++n) {
    const std::string name = numbered("v", static_cast<int>(n));
    std::filesystem::create_directory(folder / name);
    write_stack(folder / name, 3, [&](int k, TestImage& image) {
      image.series = numbered("1.2.3.", static_cast<int>(n) + 1);
      image.value = [n, k](int i, int j) { return 1000 + 500 * static_cast<int>(n) + 100 * k + 30 * i + 7 * j; };
      image.edit = [&](DcmDataset& d) {
        put(d, DCM_SOPClassUID, UID_MRImageStorage);
        put(d, DCM_Modality, "MR");
        succeed(d.putAndInsertFloat64Array(DCM_VelocityEncodingDirection, directions[n].data(), 3));
        change(n, d);
      };
    });
  }
}

/// Unit vectors, neither along the patient's axes nor quite perpendicular to each other.
constexpr std::array<Vector, 3> oblique{Vector{0.8, 0.6, 0}, Vector{-0.48, 0.64, 0.6}, Vector{0, -0.6, 0.8}};

Vec3 of(const Vector& v) {
  return {v[0], v[1], v[2]};
}

/// Every voxel's vector has, along each direction, the component that was stored for it.
void expect_components(const Volume& field, const std::function<double(int)>& meters_per_second) {
  ASSERT_TRUE(field.vectors);
  EXPECT_EQ(field.unit, "m/s");
  for (const auto& [i, j, k] : {std::array{0, 0, 0}, std::array{5, 0, 1}, std::array{1, 3, 2}, std::array{4, 2, 0}}) {
    Vec3 along;
    for (int n = 0; n < 3; ++n) along[n] = field.vectors->along[static_cast<std::size_t>(n)]->value_at(i, j, k);
    const Vec3 vector = field.vectors->to_patient * along;
    for (int n = 0; n < 3; ++n) {
      const double expected = meters_per_second(1000 + 500 * n + 100 * k + 30 * i + 7 * j);
      EXPECT_NEAR(glm::dot(of(oblique[static_cast<std::size_t>(n)]), vector), expected, 1e-9) << n;
    }
    EXPECT_NEAR(field.value_at(i, j, k), glm::length(vector), 1e-5);
  }
}

TEST(Velocity, HasItsComponentsAlongObliqueDirectionsInEveryUnit) {
  struct Unit {
    const char* name;
    double meters_per_second, slope, intercept;
  };
  for (const Unit& unit : {Unit{"m/s", 1, 0.002, -3}, {"cm/s", 0.01, 0.25, -400}, {"mm/s", 0.001, -2, 3000}}) {
    const TestFolder folder;
    write_directions(folder, oblique, [&](std::size_t, DcmDataset& d) {
      put(d, DCM_RescaleType, unit.name);
      put(d, DCM_RescaleSlope, std::to_string(unit.slope));
      put(d, DCM_RescaleIntercept, std::to_string(unit.intercept));
    });
    const Catalogue found = find_in(folder);
    ASSERT_THAT(found.velocity_fields, SizeIs(1)) << unit.name;
    EXPECT_THAT(found.velocity_fields[0].files, SizeIs(9));
    expect_components(load(found.velocity_fields[0]),
                      [&](int stored) { return unit.meters_per_second * (unit.slope * stored + unit.intercept); });
  }
}

TEST(Velocity, WithoutAUnitIsOfTheLargestVelocityAtFullRange) {
  for (const bool is_signed : {false, true}) {
    const TestFolder folder;
    write_directions(folder, oblique, [&](std::size_t, DcmDataset& d) {
      put(d, DCM_BitsStored, 13);
      put(d, DCM_HighBit, 12);
      put(d, DCM_PixelRepresentation, is_signed ? 1 : 0);
      succeed(d.putAndInsertFloat64(DCM_VelocityEncodingMaximumValue, 250));
    });
    const Catalogue found = find_in(folder);
    ASSERT_THAT(found.velocity_fields, SizeIs(1));
    expect_components(load(found.velocity_fields[0]),
                      [&](int stored) { return 2.5 * (is_signed ? stored : stored - 4096) / 4096; });
  }
}

std::size_t fields_of(const std::array<Vector, 3>& directions,
                      const std::function<void(std::size_t, DcmDataset&)>& change) {
  const TestFolder folder;
  write_directions(folder, directions, [&](std::size_t n, DcmDataset& d) {
    put(d, DCM_RescaleType, "cm/s");
    put(d, DCM_RescaleSlope, "0.1");
    put(d, DCM_RescaleIntercept, "-200");
    change(n, d);
  });
  return find_in(folder).velocity_fields.size();
}

TEST(Velocity, IsJoinedOfThreeDirectionsOnOneGridOnly) {
  const auto as_it_is = [](std::size_t, DcmDataset&) {};
  EXPECT_EQ(fields_of(oblique, as_it_is), 1U);
  EXPECT_EQ(fields_of({oblique[0], oblique[1], oblique[0]}, as_it_is), 0U) << "two directions";
  EXPECT_EQ(fields_of({Vector{1, 0, 0}, Vector{0, 1, 0}, Vector{0.6, 0.8, 0}}, as_it_is), 0U) << "in a plane";
  EXPECT_EQ(fields_of({oblique[0], oblique[1], Vector{0, -1.2, 1.6}}, as_it_is), 0U) << "no unit vector";
  const auto last_is = [&](const DcmTagKey& tag, const std::string& text) {
    return fields_of(oblique, [&](std::size_t n, DcmDataset& d) {
      if (n == 2) put(d, tag, text);
    });
  };
  EXPECT_EQ(last_is(DCM_StudyInstanceUID, "1.2.4"), 0U);
  EXPECT_EQ(last_is(DCM_ImageType, "ORIGINAL\\PRIMARY\\M\\ND"), 0U);
  EXPECT_EQ(last_is(DCM_ImageType, "ORIGINAL\\PRIMARY\\P\\ND"), 1U);
  EXPECT_EQ(last_is(DCM_PixelSpacing, "0.5\\0.76"), 0U);
  EXPECT_EQ(last_is(DCM_PixelSpacing, "0.51\\0.75"), 0U);
  EXPECT_EQ(last_is(DCM_PixelSpacing, "0.50001\\0.75001"), 1U);
  EXPECT_EQ(last_is(DCM_ImageOrientationPatient, "0.99995\\0.01\\0\\-0.01\\0.99995\\0"), 0U);
  EXPECT_EQ(last_is(DCM_ImageOrientationPatient, "1\\0\\0\\0\\0.99995\\0.01"), 0U);
  // Placed elsewhere: less than a fiftieth of a pixel is rounding.
  const auto last_is_at = [&](double x) {
    return fields_of(oblique, [&](std::size_t n, DcmDataset& d) {
      OFString z;
      d.findAndGetOFString(DCM_ImagePositionPatient, z, 2);
      if (n == 2) put(d, DCM_ImagePositionPatient, std::to_string(x) + "\\0\\" + z.c_str());
    });
  };
  EXPECT_EQ(last_is_at(0.008), 1U);
  EXPECT_EQ(last_is_at(0.012), 0U);
}

// Velocities against a direction are none along it; and a direction that was measured more often than another leaves no
// field at any time.
TEST(Velocity, EachDirectionIsThatOfOneSenseAndOfTheSameTimes) {
  for (const bool opposite : {false, true}) {
    for (std::size_t again = 0; again < (opposite ? 1U : 3U); ++again) {
      const TestFolder folder;
      const auto in_cm = [&](const std::string& name, const std::array<Vector, 3>& directions, int first) {
        const TestFolder part;
        write_directions(part, directions, [&](std::size_t n, DcmDataset& d) {
          put(d, DCM_RescaleType, "cm/s");
          put(d, DCM_RescaleSlope, "0.1");
          put(d, DCM_RescaleIntercept, "-200");
          put(d, DCM_SeriesInstanceUID, numbered("1.2.3.", first + static_cast<int>(n)));
        });
        std::filesystem::copy(part.path(), folder / name, std::filesystem::copy_options::recursive);
      };
      in_cm("a", oblique, 1);
      if (opposite) {
        in_cm("b", {Vector{-0.8, -0.6, 0}, Vector{0.48, -0.64, -0.6}, Vector{0, 0.6, -0.8}}, 11);
      } else {
        in_cm("b", {oblique[again], oblique[again], oblique[again]}, 11);  // three times more
      }
      EXPECT_THAT(find_in(folder).velocity_fields, SizeIs(0)) << again;
    }
  }
}

// What is padding of any component is no vector.
TEST(Velocity, HasNoVectorWhereAComponentIsPadding) {
  for (std::size_t with_padding = 0; with_padding < 3; ++with_padding) {
    std::array<Volume, 3> components;
    for (std::size_t n = 0; n < 3; ++n) {
      Volume& component = components[n];
      component.geometry.dimensions = {4, 1, 1};
      component.geometry.slice_positions = {Vec3(0)};
      component.voxels = std::vector<float>{1, 2, 3, 4};
      if (n == with_padding) component.padding = {2, 3};
    }
    const Volume field = vector_field(std::move(components), {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)});
    for (int i = 0; i < 4; ++i) {
      const bool padding = i == 1 || i == 2;
      EXPECT_EQ(field.is_padding(i, 0, 0), padding) << with_padding << ' ' << i;
      if (!padding) {
        EXPECT_NEAR(field.value_at(i, 0, 0), std::sqrt(3.0) * (i + 1), 1e-6);
      }
    }
  }
}

TEST(Velocity, TellsHowMuchOfItsThreeDirectionsIsRead) {
  const TestFolder folder;
  write_directions(folder, oblique, [&](std::size_t, DcmDataset& d) { put(d, DCM_RescaleType, "cm/s"); });
  const Catalogue found = find_in(folder);
  ASSERT_THAT(found.velocity_fields, SizeIs(1));
  std::vector<double> told;
  LoadOptions options;
  options.threads = 1;
  options.progress = [&](double part) {
    told.push_back(part);
    return true;
  };
  load(found.velocity_fields[0], options);
  ASSERT_FALSE(told.empty());
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_EQ(told.back(), 1);
  for (const double whole : {1.0 / 3, 2.0 / 3}) {
    EXPECT_THAT(told, ::testing::Contains(::testing::DoubleNear(whole, 1e-12)));
  }
}

TEST(Velocity, OfTheSequencesNamesHasItsSignsInThePatient) {
  struct Named {
    const char* suffix;
    Vec3 direction;
  };
  // The first is where from, the second where to: right, left, front (anterior), back, foot, head; in LPS.
  const std::array opposite{std::array{Named{"rl", {1, 0, 0}}, Named{"ap", {0, 1, 0}}, Named{"fh", {0, 0, 1}}},
                            std::array{Named{"lr", {-1, 0, 0}}, Named{"pa", {0, -1, 0}}, Named{"hf", {0, 0, -1}}}};
  for (const auto& named : opposite) {
    const TestFolder folder;
    write_directions(folder, oblique, [&](std::size_t n, DcmDataset& d) {
      d.findAndDeleteElement(DCM_VelocityEncodingDirection);
      put(d, DCM_SequenceName, std::string("*fl3d1_v125") + named[n].suffix);
    });
    const Catalogue found = find_in(folder);
    ASSERT_THAT(found.velocity_fields, SizeIs(1));
    const Volume field = load(found.velocity_fields[0]);
    ASSERT_TRUE(field.vectors);
    Vec3 expected(0);
    for (std::size_t n = 0; n < 3; ++n) {
      // Of the voxel (2, 1, 1), by which series holds the direction.
      const double stored = 1000 + 500 * static_cast<double>(n) + 100 + 60 + 7;
      expected += 1.25 * (stored - 32768) / 32768 * named[n].direction;
    }
    Vec3 along;
    for (int n = 0; n < 3; ++n) along[n] = field.vectors->along[static_cast<std::size_t>(n)]->value_at(2, 1, 1);
    EXPECT_LT(glm::distance(field.vectors->to_patient * along, expected), 1e-9);
  }
}

}  // namespace
}  // namespace palpate::io::internal

// NIfTI-1: every voxel at the position of the standard's formulas, in LPS.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>

#include "io/load.h"
#include "io/series.h"
#include "io/structures/structure.h"
#include "io/testing/file_bytes.h"
#include "io/testing/test_image.h"
#include "io/testing/voxel_files.h"

namespace palpate::io::internal {
namespace {

namespace fs = std::filesystem;
using ::testing::SizeIs;

TEST(Nifti, LiesWhereItsSformSaysInEveryForm) {
  for (const Rows& rows : {oblique(), flipped()}) {
    for (const bool big : {false, true}) {
      for (const bool gzipped : {false, true}) {
        const TestFolder folder;
        const std::string bytes = Nifti(big).sform(rows).bytes() + voxels<std::int16_t>(big);
        const fs::path file = folder / (gzipped ? "a.nii.gz" : "a.nii");
        write_bytes(file, gzipped ? packed(bytes, 31) : bytes);
        expect_all(
            only_volume(file), [&](int a, int b, int c) { return ras_to_lps * place_of(rows, a, b, c); }, stored);
      }
    }
  }
}

// The qform's own words: a quaternion, the spacings, and qfac, the hand of the third axis (nifti1.h, method 2). Here a
// quarter turn about z: i points along +y, j along -x.
TEST(Nifti, LiesWhereItsQformSaysWhereThereIsNoSform) {
  for (const float qfac : {1.0F, -1.0F, 0.0F}) {  // 0 is 1
    const TestFolder folder;
    Nifti header;
    header.put<std::int16_t>(252, 1).put<float>(76, qfac).put<float>(80, 2).put<float>(84, 3).put<float>(88, 4);
    header.put<float>(264, std::sqrt(0.5F)).put<float>(268, 10).put<float>(272, 20).put<float>(276, 30);
    write_bytes(folder / "a.nii", header.bytes() + voxels<std::int16_t>());
    const double sense = qfac < 0 ? -1 : 1;
    const Rows rows{{{0, -3, 0, 10}, {2, 0, 0, 20}, {0, 0, 4 * sense, 30}}};
    expect_all(
        only_volume(folder / "a.nii"), [&](int a, int b, int c) { return ras_to_lps * place_of(rows, a, b, c); },
        stored);
  }
}

TEST(Nifti, TheSformGoesBeforeTheQform) {
  const TestFolder folder;
  const Rows rows = oblique();
  Nifti header;
  header.sform(rows).put<std::int16_t>(252, 1).put<float>(268, 99);
  write_bytes(folder / "a.nii", header.bytes() + voxels<std::int16_t>());
  expect_all(
      only_volume(folder / "a.nii"), [&](int a, int b, int c) { return ras_to_lps * place_of(rows, a, b, c); }, stored);
}

// A turn about no axis of the patient, by Rodrigues' formula; the quaternion's half angle is the one of nifti1.h.
TEST(Nifti, LiesWhereItsQformSaysAboutAnyAxis) {
  const Vec3 axis(2.0 / 7, 3.0 / 7, 6.0 / 7);
  const double angle = 0.8;
  const auto turned = [&](const Vec3& v) {
    return v * std::cos(angle) + glm::cross(axis, v) * std::sin(angle) +
           axis * glm::dot(axis, v) * (1 - std::cos(angle));
  };
  const Vec3 quaternion = axis * std::sin(angle / 2), first(10, 20, 30);
  Nifti header;
  header.put<std::int16_t>(252, 1).put<float>(76, 1).put<float>(80, 2).put<float>(84, 3).put<float>(88, 4);
  for (int n = 0; n < 3; ++n) {
    const auto at = 4 * static_cast<std::size_t>(n);
    header.put(256 + at, static_cast<float>(quaternion[n])).put(268 + at, static_cast<float>(first[n]));
  }
  const TestFolder folder;
  write_bytes(folder / "a.nii", header.bytes() + voxels<std::int16_t>());
  expect_all(
      only_volume(folder / "a.nii"),
      [&](int a, int b, int c) { return ras_to_lps * (first + turned(Vec3(2 * a, 3 * b, 4 * c))); }, stored);
}

// xyzt_units: 1 m, 2 mm, 3 micrometers, and 0 is not said; the further bits are the unit of time (nifti1.h).
TEST(Nifti, PlacesMayBeInOtherUnits) {
  struct Unit {
    std::uint8_t code;
    double mm;
  };
  for (const Unit& unit : {Unit{0, 1}, Unit{1, 1000}, Unit{2, 1}, Unit{3, 0.001}, Unit{8 + 1, 1000}}) {
    Rows in_unit = oblique();
    for (auto& row : in_unit) {
      for (double& number : row) number /= unit.mm;
    }
    const TestFolder folder;
    write_bytes(folder / "a.nii", Nifti().sform(in_unit).put(123, unit.code).bytes() + voxels<std::int16_t>());
    expect_all(
        only_volume(folder / "a.nii"), [&](int a, int b, int c) { return ras_to_lps * place_of(oblique(), a, b, c); },
        stored);
  }
}

// Slices sheared against each other are a gantry's tilt. Where two other axes are at right angles, these are the
// slices; where none are, nothing that is felt could lie there.
TEST(Nifti, ShearedOnesAreHeldAsFarAsTheyCanBe) {
  const Rows tilted{{{1, 0, 0, 0}, {0, 1, 1.5, 0}, {0, 0, 3, 0}}};
  const Rows in_the_plane{{{1, 0.4, 0, 5}, {0, 1, 0, 6}, {0, 0, 3, 7}}};
  const Rows only_j_k{{{1, 0.4, 0, 5}, {0, 1, 0, 6}, {0.5, 0, 3, 7}}};
  for (const Rows& rows : {tilted, in_the_plane, only_j_k}) {
    const TestFolder folder;
    write_bytes(folder / "a.nii", Nifti().sform(rows).bytes() + voxels<std::int16_t>());
    const auto lps = [&](int a, int b, int c) { return ras_to_lps * place_of(rows, a, b, c); };
    const Series series = find_series(std::array{folder / "a.nii"}).series.at(0);
    expect_all(load(series), lps, stored);
    for (int k = 0; k < series.geometry.dimensions.z; ++k) {  // a slice alone is that of the whole
      const Volume slice = load(series, {.slices = LoadOptions::Range{k, 1}});
      EXPECT_EQ(slice.geometry.slice_positions.at(0), series.geometry.slice_positions[static_cast<std::size_t>(k)]);
      EXPECT_EQ(slice.value_at(1, 1, 0), load(series).value_at(1, 1, k));
    }
  }
  const TestFolder folder;
  const Rows everywhere{{{1, 0.4, 0.4, 0}, {0, 1, 0.4, 0}, {0, 0, 1, 0}}};
  write_bytes(folder / "a.nii", Nifti().sform(everywhere).bytes() + voxels<std::int16_t>());
  const Catalogue found = find_series(std::array{folder / "a.nii"});
  ASSERT_THAT(found.skipped, SizeIs(1));
  EXPECT_EQ(found.skipped[0].reason,
            "its voxels are on no lattice that can be felt (no size, or axes that are sheared): resample it with axes "
            "at right angles");
}

// scl_slope and scl_inter; a slope of 0 stands for none (nifti1.h).
TEST(Nifti, ValuesAreScaled) {
  for (const float slope : {0.5F, 0.0F}) {
    const TestFolder folder;
    Nifti header;
    header.sform(oblique()).put<float>(112, slope).put<float>(116, 7).put<float>(120, 99);
    write_bytes(folder / "a.nii", header.bytes() + voxels<std::int16_t>());
    const auto value = [&](int a, int b, int c) { return slope == 0 ? stored(a, b, c) : 0.5 * stored(a, b, c) + 7; };
    expect_all(
        only_volume(folder / "a.nii"), [&](int a, int b, int c) { return ras_to_lps * place_of(oblique(), a, b, c); },
        value);
    header.put<std::int16_t>(70, 16).put<std::int16_t>(72, 32);  // floating point, scaled as it is read
    write_bytes(folder / "a.nii", header.bytes() + voxels<float>());
    expect_all(
        only_volume(folder / "a.nii"), [&](int a, int b, int c) { return ras_to_lps * place_of(oblique(), a, b, c); },
        value);
  }
}

TEST(Nifti, EachVolumeIsAFrame) {
  const TestFolder folder;
  Nifti header;
  header.sform(oblique()).put<std::int16_t>(40, 4).put<std::int16_t>(48, 3);
  write_bytes(folder / "a.nii.gz", packed(header.bytes() + voxels<std::int16_t>(false, 3), 31));
  EXPECT_EQ(find_series(std::array{folder / "a.nii.gz"}).series.at(0).frames_per_position, 3);
  const Volume first = only_volume(folder / "a.nii.gz"), last = only_volume(folder / "a.nii.gz", 2);
  EXPECT_EQ(last.value_at(2, 1, 3), first.value_at(2, 1, 3) + 2000);
}

TEST(Nifti, NumbersOfAllTypes) {
  const auto expect = [](std::int16_t code, const std::string& data, double bias) {
    const TestFolder folder;
    write_bytes(folder / "a.nii", Nifti().sform(oblique()).put(70, code).bytes() + data);
    expect_all(
        only_volume(folder / "a.nii"), [&](int a, int b, int c) { return ras_to_lps * place_of(oblique(), a, b, c); },
        [&](int a, int b, int c) { return stored(a, b, c) + bias; });
  };
  expect(4, voxels<std::int16_t>(), 0);
  expect(8, voxels<std::int32_t>(), 0);
  expect(16, voxels<float>(), 0);
  expect(64, voxels<double>(), 0);
  expect(1024, voxels<std::int64_t>(), 0);
}

// cal_max and cal_min: the values that are shown brightest and darkest (nifti1.h).
TEST(Nifti, TellsTheWindowThatItsValuesAreShownIn) {
  const auto window_of = [](float darkest, float brightest) {
    const TestFolder folder;
    write_bytes(folder / "a.nii",
                Nifti().sform(oblique()).put(124, brightest).put(128, darkest).bytes() + voxels<std::int16_t>());
    return find_series(std::array{folder / "a.nii"}).series.at(0).window;
  };
  ASSERT_TRUE(window_of(-160, 240));
  EXPECT_EQ(window_of(-160, 240)->level, 40);
  EXPECT_EQ(window_of(-160, 240)->width, 400);
  EXPECT_FALSE(window_of(0, 0));
  EXPECT_FALSE(window_of(5, -5));
  EXPECT_FALSE(window_of(0, std::numeric_limits<float>::infinity()));
}

// dim[4] to dim[7] all count volumes, as far as dim[0] says; a size of 0 is 1.
TEST(Nifti, VolumesAreOfAllFurtherAxes) {
  for (int axes = 3; axes <= 7; ++axes) {
    const TestFolder folder;
    Nifti header;
    header.sform(oblique()).put(40, static_cast<std::int16_t>(axes));
    const std::array<std::int16_t, 4> sizes{2, 0, 3, 2};
    int volumes = 1;
    for (std::size_t n = 0; n < sizes.size(); ++n) {
      header.put(48 + 2 * n, sizes[n]);
      if (static_cast<int>(n) + 4 <= axes) volumes *= std::max<int>(1, sizes[n]);
    }
    write_bytes(folder / "a.nii", header.bytes() + voxels<std::int16_t>(false, volumes));
    EXPECT_EQ(find_series(std::array{folder / "a.nii"}).series.at(0).frames_per_position, volumes) << axes;
    EXPECT_EQ(only_volume(folder / "a.nii", volumes - 1).value_at(2, 1, 3),
              only_volume(folder / "a.nii").value_at(2, 1, 3) + 1000 * (volumes - 1));
  }
}

// Behind the header, up to vox_offset, lie extensions: here the table of labels of the Connectome Workbench.
TEST(Nifti, NamesLabelsByTheTableInItsExtension) {
  const std::string table =
      "<LabelTable><Label Key=\"0\" Red=\"1\" Green=\"1\" Blue=\"1\" Alpha=\"0\">none</Label>"
      "<Label Key=\"7\" Red=\"0.2\" Green=\"0.4\" Blue=\"1\" Alpha=\"1\"><![CDATA[left kidney]]></Label>"
      "<Label Key=\"9\" Red=\"1\" Green=\"0\" Blue=\"0.6\" Alpha=\"1\">spleen</Label></LabelTable>";
  const TestFolder folder;
  Nifti header;
  header.sform(oblique()).put<float>(108, static_cast<float>(352 + table.size()));
  write_bytes(folder / "a.nii", header.bytes() + table + labels());
  const std::vector<Structure> found = find_structures(std::array{folder / "a.nii"}).structures;
  EXPECT_EQ(std::ranges::count(found, 0, &Structure::number), 0) << "the background";
  const auto numbered = [&](int number) { return *std::ranges::find(found, number, &Structure::number); };
  ASSERT_EQ(std::ranges::count(found, 7, &Structure::number), 1);
  EXPECT_EQ(numbered(7).name, "left kidney");
  EXPECT_EQ(numbered(7).color, "#3366ff");
  EXPECT_EQ(measure(numbered(7)).voxels, static_cast<std::uint64_t>(3 * nx * ny));
  ASSERT_EQ(std::ranges::count(found, 9, &Structure::number), 1);
  EXPECT_EQ(numbered(9).name, "spleen");
  EXPECT_EQ(numbered(9).color, "#ff0099");
  EXPECT_FALSE(numbered(9).unfit.empty()) << "nobody outlined it";
}

// intent_code 1002: what looks like an image, a label a voxel, is a map of labels where the file says so.
TEST(Nifti, IsAMapOfLabelsWhereItsIntentSaysSo) {
  std::string data;
  for (int n = 0; n < nx * ny * nz; ++n) data += as_bytes(static_cast<std::int16_t>(1 + n));
  for (const int intent : {0, 1001, 1002, 1003}) {
    const TestFolder folder;
    write_bytes(folder / "a.nii", Nifti().sform(oblique()).put(68, static_cast<std::int16_t>(intent)).bytes() + data);
    EXPECT_EQ(find_structures(std::array{folder / "a.nii"}).structures.size(),
              intent == 1002 ? static_cast<std::size_t>(nx * ny * nz) : 0U)
        << intent;
  }
}

TEST(Nifti, WhatIsNoNumberIsPadding) {
  const TestFolder folder;
  std::string data = voxels<float>();
  std::ranges::copy(as_bytes(std::numeric_limits<float>::quiet_NaN()), data.begin());
  const Rows straight{{{-1, 0, 0, 0}, {0, -1, 0, 0}, {0, 0, 1, 0}}};
  write_bytes(folder / "a.nii", Nifti().sform(straight).put<std::int16_t>(70, 16).bytes() + data);
  const Volume volume = only_volume(folder / "a.nii");
  EXPECT_TRUE(volume.is_padding(0, 0, 0));
  EXPECT_EQ(statistics_without_padding(volume).count, static_cast<std::uint64_t>(nx * ny * nz - 1));
  EXPECT_EQ(statistics_without_padding(volume).minimum, stored(1, 0, 0));
}

}  // namespace
}  // namespace palpate::io::internal

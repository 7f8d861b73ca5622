// NIfTI-1 that is written, byte by byte, against nifti1.h.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <string>

#include "io/interchange/label_bytes.h"
#include "io/structures/label_image.h"
#include "io/testing/written_labels.h"

namespace palpate::io::internal {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// Rows of four to a place in LPS, mm.
Vec3 place_by(const std::array<std::array<double, 4>, 3>& rows, const Vec3& voxel) {
  Vec3 ras(0);
  for (int r = 0; r < 3; ++r) {
    const auto& row = rows[static_cast<std::size_t>(r)];
    ras[r] = row[0] * voxel.x + row[1] * voxel.y + row[2] * voxel.z + row[3];
  }
  return {-ras.x, -ras.y, ras.z};
}

/// nifti1.h, method 2: the rotation of a quaternion, the spacings, and qfac.
std::array<std::array<double, 4>, 3> rows_of_quaternion(const std::string& bytes) {
  const auto real = [&](std::size_t at) { return static_cast<double>(number_at<float>(bytes, at)); };
  const double b = real(256), c = real(260), d = real(264), a = std::sqrt(std::max(0.0, 1 - b * b - c * c - d * d));
  const std::array<std::array<double, 3>, 3> turn{
      {{a * a + b * b - c * c - d * d, 2 * b * c - 2 * a * d, 2 * b * d + 2 * a * c},
       {2 * b * c + 2 * a * d, a * a + c * c - b * b - d * d, 2 * c * d - 2 * a * b},
       {2 * b * d - 2 * a * c, 2 * c * d + 2 * a * b, a * a + d * d - c * c - b * b}}};
  const double qfac = real(76) < 0 ? -1 : 1;
  std::array<std::array<double, 4>, 3> rows{};
  for (std::size_t r = 0; r < 3; ++r) {
    rows[r] = {turn[r][0] * real(80), turn[r][1] * real(84), turn[r][2] * real(88) * qfac, real(268 + 4 * r)};
  }
  return rows;
}

void expect_places(const std::array<std::array<double, 4>, 3>& rows, const LabelImage& image) {
  const glm::ivec3 last = image.geometry.dimensions - 1;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 voxel((corner & 1) * last.x, (corner >> 1 & 1) * last.y, (corner >> 2) * last.z);
    EXPECT_LT(glm::length(place_by(rows, voxel) - image.geometry.to_patient(voxel)), 1e-4) << corner;
  }
}

TEST(WriteLabelMap, NiftiHasEachFieldOfTheStandard) {
  for (const LabelImage& image : images()) {
    const std::string bytes = nifti_bytes(image, ".nii");
    ASSERT_GT(bytes.size(), 352U);
    const auto code = [&](std::size_t at) { return number_at<std::int16_t>(bytes, at); };
    EXPECT_EQ(number_at<std::int32_t>(bytes, 0), 348);
    const glm::ivec3& size = image.geometry.dimensions;
    const std::array<int, 8> dim{3, size.x, size.y, size.z, 1, 1, 1, 1};
    for (std::size_t n = 0; n < 8; ++n) EXPECT_EQ(code(40 + 2 * n), dim[n]) << n;
    EXPECT_EQ(code(68), 1002) << "NIFTI_INTENT_LABEL";
    EXPECT_EQ(code(70), 2) << "DT_UINT8";
    EXPECT_EQ(code(72), 8) << "bitpix";
    const Geometry& g = image.geometry;
    const std::array<double, 4> pixdim{1, g.spacing_i, g.spacing_j, glm::length(g.step)};
    for (std::size_t n = 0; n < 4; ++n)
      EXPECT_EQ(number_at<float>(bytes, 76 + 4 * n), static_cast<float>(pixdim[n])) << n;
    EXPECT_EQ(number_at<float>(bytes, 112), 1) << "scl_slope";
    EXPECT_EQ(number_at<float>(bytes, 116), 0) << "scl_inter";
    EXPECT_EQ(bytes[123], 2) << "NIFTI_UNITS_MM";
    EXPECT_EQ(bytes.substr(344, 4), std::string("n+1\0", 4));
    std::array<std::array<double, 4>, 3> sform{};
    for (std::size_t n = 0; n < 12; ++n)
      sform[n / 4][n % 4] = static_cast<double>(number_at<float>(bytes, 280 + 4 * n));
    EXPECT_EQ(code(254), 1) << "NIFTI_XFORM_SCANNER_ANAT";
    expect_places(sform, image);
    EXPECT_EQ(code(252), is_straight(image) ? 1 : 0) << "a quaternion says nothing of a sheared lattice";
    if (is_straight(image)) expect_places(rows_of_quaternion(bytes), image);
    const auto at = static_cast<std::size_t>(number_at<float>(bytes, 108));
    ASSERT_EQ(bytes.size(), at + image.inside.size());
    EXPECT_EQ(bytes.substr(at), voxels_in(image));
    EXPECT_EQ(inflated(nifti_bytes(image, ".nii.gz"), gzip_bits), bytes);
  }
}

/// Turned by any angle about any axis: also where the quaternion's first number, which nobody writes, is below 0.
TEST(WriteLabelMap, NiftiHasTheQuaternionOfEveryRotation) {
  for (const Vec3& axis :
       {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(1, 1, 1), Vec3(1, -2, 3), Vec3(-3, 1, 2)}) {
    for (int degrees = 10; degrees < 360; degrees += 20) {
      const glm::dquat turn = glm::angleAxis(glm::radians(static_cast<double>(degrees)), glm::normalize(axis));
      const auto in_lps = [&](const Vec3& ras) { return Vec3(-1, -1, 1) * (turn * ras); };
      const LabelImage image = image_on(0.75 * in_lps({1, 0, 0}), 1.5 * in_lps({0, 1, 0}), 2.5 * in_lps({0, 0, 1}),
                                        {10, -20, 30}, {5, 4, 3});
      SCOPED_TRACE(::testing::Message() << degrees << " degrees about " << axis.x << ' ' << axis.y << ' ' << axis.z);
      expect_places(rows_of_quaternion(nifti_bytes(image, ".nii")), image);
    }
  }
}

/// Two slices lean by so much, the tangent of an angle, over i or over j; either way.
TEST(WriteLabelMap, NiftiHasAQuaternionWhereNothingIsShearedButByRounding) {
  for (const double leaning : {0.0, 5e-5, -5e-5, 2e-4, -2e-4, 0.5, -0.5}) {
    for (const bool over_i : {false, true}) {
      const Vec3 k = 3.0 * (over_i ? Vec3(leaning, 0, 1) : Vec3(0, leaning, 1));
      const std::string bytes = nifti_bytes(image_on({1, 0, 0}, {0, 1, 0}, k, {0, 0, 0}, {2, 2, 2}), ".nii");
      EXPECT_EQ(number_at<std::int16_t>(bytes, 252), std::abs(leaning) < 1e-4 ? 1 : 0) << leaning;
    }
  }
}

/// Behind the header a flag, and an extension: its length, of which 16 is a part; NIFTI_ECODE_CARET, whose table names
/// labels; and text.
TEST(WriteLabelMap, NiftiNamesTheLabelInAnExtension) {
  for (std::size_t letters = 1; letters < 40; ++letters) {
    LabelImage image = images().front();
    image.label.name = std::string(letters, 'k');
    const std::string bytes = nifti_bytes(image, ".nii");
    EXPECT_EQ(bytes.substr(348, 4), std::string("\1\0\0\0", 4));
    const auto length = static_cast<std::size_t>(number_at<std::int32_t>(bytes, 352));
    EXPECT_EQ(length % 16, 0U);
    EXPECT_EQ(number_at<std::int32_t>(bytes, 356), 30);
    EXPECT_EQ(static_cast<std::size_t>(number_at<float>(bytes, 108)), 352 + length);
    const std::string text = bytes.substr(360, length - 8);
    EXPECT_THAT(text, StartsWith("<?xml version=\"1.0\" encoding=\"UTF-8\"?><CaretExtension><VolumeInformation "
                                 "Index=\"0\"><LabelTable>"));
    EXPECT_THAT(text, HasSubstr("<Label Key=\"1\" Red=\"0.200000\" Green=\"0.400000\" Blue=\"1.000000\" Alpha=\"1\">"
                                "<![CDATA[" +
                                image.label.name + "]]></Label>"));
    EXPECT_THAT(std::string(text.c_str()), EndsWith("</LabelTable></VolumeInformation></CaretExtension>"));
    EXPECT_LT(length - 8 - std::string(text.c_str()).size(), 16U) << "no more is filled up than needed";
  }
}

}  // namespace
}  // namespace palpate::io::internal

// Accepted and refused lattices, on both sides of each limit.
#include "io/interchange/voxel_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "io/errors.h"
#include "io/testing/file_bytes.h"
#include "io/testing/test_image.h"

namespace palpate::io {
namespace {

/// Why it is refused; empty where it is held.
std::string refusal(const VoxelMap& map, const glm::ivec3& size) {
  VoxelFile file;
  try {
    place(map, size, file);
  } catch (const DicomError& error) {
    return error.what();
  }
  EXPECT_EQ(file.geometry.slice_positions.size(), static_cast<std::size_t>(file.geometry.dimensions.z));
  return {};
}

TEST(LabelFormats, EachHasANameAndEndingsOfItsOwn) {
  std::set<std::string_view> names, endings;
  for (const LabelFormat* const format : label_formats()) {
    EXPECT_TRUE(names.insert(format->name).second) << format->name;
    EXPECT_FALSE(format->endings.front().empty()) << format->name;
    for (const std::string_view ending : format->endings) {
      if (ending.empty()) continue;
      EXPECT_TRUE(endings.insert(ending).second) << ending;
      EXPECT_EQ(ending.front(), '.');
    }
    EXPECT_EQ(format->bytes == nullptr, format->written.front().empty()) << format->name;
    for (const std::string_view ending : format->written) {
      if (ending.empty()) continue;
      const auto writer = writer_of("Liver" + std::string(ending));
      ASSERT_TRUE(writer) << ending;
      EXPECT_EQ(writer->format, format) << ending;
      EXPECT_EQ(writer->ending, ending);
      EXPECT_TRUE(
          std::ranges::any_of(format->endings, [&](auto read) { return !read.empty() && ending.ends_with(read); }))
          << ending << " is written and not read";
    }
  }
  EXPECT_FALSE(writer_of("Liver.png"));
  EXPECT_EQ(label_format_endings().size(), endings.size());
}

TEST(VoxelLattice, HoldsAsManyVoxelsAsItSaysAndNotOneMore) {
  const VoxelMap map;
  EXPECT_EQ(refusal(map, {8192, 8192, 1}), "");
  EXPECT_EQ(refusal(map, {8192, 8193, 1}), "it has 8192 x 8193 x 1 voxels, which are too many: resample it");
  EXPECT_EQ(refusal(map, {1024, 1024, 2048}), "");
  EXPECT_EQ(refusal(map, {1024, 1024, 2049}), "it has 1024 x 1024 x 2049 voxels, which are too many: resample it");
  for (int axis = 0; axis < 3; ++axis) {
    glm::ivec3 none(2);
    none[axis] = 0;
    EXPECT_THAT(refusal(map, none), ::testing::HasSubstr("on no lattice that can be felt"));
  }
}

/// The axes that become the geometry's, for axes that lean by so much of a right angle (as a cosine).
std::optional<std::array<int, 3>> axes_where(double ij, double ik, double jk) {
  VoxelMap map;
  map.along[0] = {2, 0, 0};
  map.along[1] = 3.0 * Vec3(ij, std::sqrt(1 - ij * ij), 0);
  const double y = (jk - ij * ik) / std::sqrt(1 - ij * ij);
  map.along[2] = 0.5 * Vec3(ik, y, std::sqrt(1 - ik * ik - y * y));
  VoxelFile file;
  try {
    place(map, {4, 3, 5}, file);
  } catch (const DicomError&) {
    return std::nullopt;
  }
  return file.axes;
}

TEST(VoxelLattice, TakesTheFirstTwoAxesThatAreAtRightAnglesForItsSlices) {
  constexpr double square = 0.9e-3, leaning = 1.1e-3;  // a thousandth is what rounding may leave
  using Axes = std::array<int, 3>;
  for (const double sign : {-1.0, 1.0}) {
    EXPECT_EQ(axes_where(sign * square, sign * 0.3, 0.2), (Axes{0, 1, 2}));
    EXPECT_EQ(axes_where(sign * leaning, sign * square, 0.2), (Axes{0, 2, 1}));
    EXPECT_EQ(axes_where(sign * leaning, leaning, sign * square), (Axes{1, 2, 0}));
    EXPECT_EQ(axes_where(sign * leaning, leaning, sign * leaning), std::nullopt);
  }
}

TEST(VoxelLattice, IsNoneWhereItsAxesLieInAPlane) {
  VoxelMap map;
  map.first = {5, -6, 7};
  // Of a unit box, what is left of its volume: a millionth is the least.
  for (const auto& [rises, held] : {std::pair{2e-6, true}, {0.5e-6, false}, {-0.5e-6, false}, {-2e-6, true}}) {
    map.along[2] = {std::sqrt(1 - rises * rises), 0, rises};
    EXPECT_EQ(refusal(map, {2, 2, 2}).empty(), held) << rises;
  }
}

TEST(VoxelLattice, AFileIsLongEnoughWithItsLastByteAlone) {
  const internal::TestFolder folder;
  VoxelFile file;
  file.voxels_at = folder / "a.raw";
  file.size = {4, 3, 5};
  file.number = VoxelFile::Number::u32;
  file.first = 10;
  file.volumes = 2;
  constexpr std::size_t numbers = 4 * 3 * 5 * 2;
  using Packing = VoxelFile::Packing;
  // Two digits are a byte in hex. In ascii a number has at least a digit, and a space lies between two.
  for (const auto& [packing, least] :
       {std::pair{Packing::none, 4 * numbers}, {Packing::hex, 8 * numbers}, {Packing::ascii, 2 * numbers - 1}}) {
    file.packing = packing;
    internal::write_bytes(file.voxels_at, std::string(10 + least, 'x'));
    EXPECT_NO_THROW(check_size(file)) << least;
    internal::write_bytes(file.voxels_at, std::string(10 + least - 1, 'x'));
    EXPECT_THROW(check_size(file), DicomError) << least;
  }
}

}  // namespace
}  // namespace palpate::io

// Which values of a NIfTI are labels, and which are those of an image.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <glm/geometric.hpp>
#include <string>
#include <type_traits>
#include <utility>

#include "io/structures/structure.h"
#include "io/testing/test_image.h"
#include "io/testing/voxel_files.h"

namespace palpate::io {
namespace {

namespace fs = std::filesystem;

/// How the header scales what is stored. A slope of 0 scales nothing.
struct Scaling {
  double slope = 0, offset = 0;
};

struct LabelValues : ::testing::Test {
  /// Voxels of 1 mm, of 32-bit floating-point numbers or integers. The folder holds this file alone.
  template <typename Number>
  fs::path written_volume(const glm::ivec3& size, const std::function<double(const glm::ivec3&)>& value,
                          const Scaling& scaling = {}) {
    internal::Nifti header;
    header.sform({{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}});
    for (int axis = 0; axis < 3; ++axis) {
      header.put(42 + 2 * static_cast<std::size_t>(axis), static_cast<std::int16_t>(size[axis]));
    }
    const std::int16_t type = std::is_integral_v<Number> ? 8 : 16;
    header.put(70, type).put(72, std::int16_t{32});
    header.put(112, static_cast<float>(scaling.slope)).put(116, static_cast<float>(scaling.offset));
    std::string bytes = header.bytes();
    for (int n = 0; n < size.x * size.y * size.z; ++n) {
      const glm::ivec3 at(n % size.x, n / size.x % size.y, n / size.x / size.y);
      bytes += internal::as_bytes(static_cast<Number>(value(at)));
    }
    const fs::path file = folder / "volume.nii";
    std::ofstream(file, std::ios::binary) << bytes;
    return file;
  }
  internal::TestFolder folder;
};

/// Label 1 in a box, 2 in another one, `background` elsewhere.
double two_boxes(const glm::ivec3& at, double background) {
  if (at.y < 2 || at.y > 5 || at.z < 1 || at.z > 6) return background;
  return at.x < 4 ? 1 : (at.x < 9 ? 2 : background);
}

void expect_two_boxes(const fs::path& file, const std::string& what) {
  for (const bool is_named : {true, false}) {
    const StructureCatalogue found = find_structures(std::array{is_named ? file : file.parent_path()});
    ASSERT_EQ(found.structures.size(), 2U) << what << (found.skipped.empty() ? Text() : found.skipped[0].reason);
    EXPECT_EQ(measure(found.structures[0]).voxels, 4U * 4U * 6U) << what;
    EXPECT_EQ(measure(found.structures[1]).voxels, 5U * 4U * 6U) << what;
  }
}

// Programs scale labels, fill what they do not know with NaN, and call the background -1.
TEST_F(LabelValues, AreRoundedAndTheBackgroundIsWhatIsNoLabel) {
  const glm::ivec3 size(14, 9, 8);
  for (const double scale : {1.0, 1.00000006, 0.99999994, 1.00003}) {
    for (const double background : {0.0, 3e-5, -1.0, static_cast<double>(NAN)}) {
      const auto value = [&](const glm::ivec3& at) {
        const double label = two_boxes(at, background);
        return label > 0.5 ? label * scale : label;
      };
      expect_two_boxes(written_volume<float>(size, value), std::to_string(scale) + ' ' + std::to_string(background));
    }
  }
  const auto half = [](const glm::ivec3& at) { return 0.5 * two_boxes(at, 0); };
  const fs::path file = written_volume<float>(size, half);
  EXPECT_TRUE(find_structures(std::array{file.parent_path()}).structures.empty()) << "half of one is no label";
}

// nifti1.h: a value is scl_slope * stored + scl_inter, and what is stored where scl_slope is 0.
TEST_F(LabelValues, AreScaledAsTheHeaderSays) {
  for (const Scaling& scaling : {Scaling{1, 0}, {2, 0}, {0.5, 0}, {1, 5}, {0.25, -3}, {-1, 2}, {0, 0}, {0, 7}}) {
    const auto stored = [&](const glm::ivec3& at) {
      const double label = two_boxes(at, 0);
      return scaling.slope == 0 ? label : (label - scaling.offset) / scaling.slope;
    };
    const std::string what = std::to_string(scaling.slope) + ' ' + std::to_string(scaling.offset);
    expect_two_boxes(written_volume<float>({14, 9, 8}, stored, scaling), what);
    if (std::abs(scaling.slope) == 2) continue;  // a half is no integer
    expect_two_boxes(written_volume<std::int32_t>({14, 9, 8}, stored, scaling), what);
  }
}

// A structure may be thin along any axis.
TEST_F(LabelValues, OfThinStructuresAreLabels) {
  for (int thin = 0; thin < 3; ++thin) {
    const auto value = [&](const glm::ivec3& at) {
      const int across = at[thin];  // three plates of two voxels
      return across % 4 < 2 ? across / 4 + 1.0 : 0.0;
    };
    const fs::path file = written_volume<std::int32_t>(glm::ivec3(11), value);
    const StructureCatalogue found = find_structures(std::array{file.parent_path()});
    ASSERT_EQ(found.structures.size(), 3U) << thin;
    for (const Structure& one : found.structures) EXPECT_EQ(measure(one).voxels, 2U * 11U * 11U);
  }
}

TEST_F(LabelValues, ThatAreTooLargeAreRefusedInWords) {
  const auto value = [](const glm::ivec3& at) { return two_boxes(at, 0) * 40'000; };
  const fs::path file = written_volume<std::int32_t>({14, 9, 8}, value);
  for (const fs::path& place : {file, file.parent_path()}) {
    const StructureCatalogue found = find_structures(std::array{place});
    EXPECT_TRUE(found.structures.empty());
    ASSERT_EQ(found.skipped.size(), 1U);
    EXPECT_EQ(found.skipped[0].reason, "a label of it is above 65535: renumber its labels");
  }
}

// In a folder an image is a scan. A file that the user names as a label map is refused with a reason if it is an image.
TEST_F(LabelValues, OfAnImageAreNoneAndSaysSoIfTheUserNamesIt) {
  const auto each_its_own = [](const glm::ivec3& at) { return 1 + at.x + 3 * at.y + 6 * at.z; };
  const fs::path few = written_volume<std::int32_t>({3, 2, 2}, each_its_own);
  EXPECT_TRUE(find_structures(std::array{few.parent_path()}).structures.empty());
  EXPECT_TRUE(find_structures(std::array{few}).structures.empty());
  EXPECT_EQ(find_structures(std::array{few}).skipped.size(), 1U);
  // Labels of a voxel each, apart: marks of electrodes.
  const auto marks = [](const glm::ivec3& at) { return at.x % 3 == 1 && at.y == 5 && at.z == 5 ? at.x / 3 + 1 : 0; };
  EXPECT_EQ(find_structures(std::array{written_volume<std::int32_t>(glm::ivec3(12), marks)}).structures.size(), 4U);
  const auto values = [](const glm::ivec3& at) { return (at.x * 131 + at.y * 71 + at.z * 37) % 1999 + 1; };
  const auto scan = [](const glm::ivec3& at) { return at.x + 0.3 * at.y - 5.0; };
  for (const bool is_whole : {true, false}) {
    const fs::path image =
        is_whole ? written_volume<std::int32_t>(glm::ivec3(12), values) : written_volume<float>(glm::ivec3(12), scan);
    const StructureCatalogue in_folder = find_structures(std::array{image.parent_path()});
    EXPECT_TRUE(in_folder.structures.empty() && in_folder.skipped.empty());
  }
  const StructureCatalogue named = find_structures(std::array{written_volume<float>(glm::ivec3(12), scan)});
  EXPECT_TRUE(named.structures.empty());
  ASSERT_EQ(named.skipped.size(), 1U);
  EXPECT_EQ(named.skipped[0].reason,
            "its values are no labels, which are whole numbers from 1 to 65535: name a label map");
}

/// Small whole numbers that look random and are always the same.
int scattered(const glm::ivec3& at, int below) {
  const unsigned n = static_cast<unsigned>(at.x) * 73856093U ^ static_cast<unsigned>(at.y) * 19349663U ^
                     static_cast<unsigned>(at.z) * 83492791U;
  return static_cast<int>((n * 2654435761U >> 8U) % static_cast<unsigned>(below));
}

// A parcellation has hundreds of labels: those are the same whether their folder or their file is named.
TEST_F(LabelValues, OfManyBlocksAreLabelsWhereverTheyAreNamed) {
  for (const auto& [blocks, edge] :
       {std::pair{glm::ivec3(5, 5, 4), 4}, {{8, 5, 9}, 4}, {{10, 10, 10}, 4}, {{12, 12, 12}, 3}, {{7, 6, 8}, 5}}) {
    const auto value = [&, n = blocks, wide = edge](const glm::ivec3& at) {
      const glm::ivec3 block = at / wide;
      return block.x + n.x * (block.y + n.y * block.z) + 1.0;
    };
    const fs::path file = written_volume<std::int32_t>(edge * blocks, value);
    const auto count = static_cast<std::size_t>(blocks.x * blocks.y * blocks.z);
    for (const fs::path& place : {file.parent_path(), file}) {
      const StructureCatalogue found = find_structures(std::array{place});
      ASSERT_EQ(found.structures.size(), count) << (found.skipped.empty() ? Text() : found.skipped[0].reason);
      EXPECT_EQ(measure(found.structures[count / 2]).voxels, static_cast<std::uint64_t>(edge * edge * edge));
    }
  }
}

// Images of 8 bits that change slowly: to a fifth and more of all neighbors have the same value, and the background
// lies around them. So do those that were made larger. But most of their voxels have others beside them.
TEST_F(LabelValues, OfASmoothImageOfEightBitsAreNoneWhereverItIsNamed) {
  const glm::ivec3 size(26);
  for (const double slope : {0.45, 0.6, 0.9, 1.4, 2.4}) {
    for (const int larger : {1, 2}) {
      for (const bool in_air : {true, false}) {
        const auto value = [&](const glm::ivec3& at) {
          const glm::ivec3 from = at / larger;
          const Vec3 place(larger * from);
          if (in_air && glm::length(place - 13.0) > 11) return 0.0;
          const double smooth = 60 + slope * (place.x + place.y + place.z) + scattered(from, 2);
          return std::clamp(std::floor(smooth), 1.0, 255.0);
        };
        const fs::path file = written_volume<std::int32_t>(size, value);
        for (const fs::path& place : {file, file.parent_path()}) {
          const StructureCatalogue found = find_structures(std::array{place});
          EXPECT_TRUE(found.structures.empty())
              << slope << ' ' << larger << ' ' << in_air << ": " << found.structures.size();
        }
      }
    }
  }
}

// Sheets, lines and marks of a voxel's width, each cut into several labels.
TEST_F(LabelValues, AsThinAsAVoxelAreLabelsWhereTheirFileIsNamed) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const int long_mm : {2, 3, 7}) {
      for (const int across : {1, 2}) {  // directions in which it is a voxel wide
        const auto value = [&](const glm::ivec3& at) {
          const int wide = at[(axis + 1) % 3], other = at[(axis + 2) % 3];
          const bool in = wide % 5 == 2 && (across == 1 || other % 4 == 1);
          return in ? 1.0 + at[axis] / long_mm + 12 * (wide / 5) : 0.0;
        };
        const fs::path file = written_volume<std::int32_t>(glm::ivec3(21), value);
        const auto count = static_cast<std::size_t>(4 * ((21 + long_mm - 1) / long_mm));
        EXPECT_EQ(find_structures(std::array{file}).structures.size(), count) << axis << ' ' << long_mm << across;
      }
    }
  }
}

}  // namespace
}  // namespace palpate::io

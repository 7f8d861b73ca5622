// Segmentations against the positions of their own frames, in any orientation and any uncompressed form.

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "io/structures/structure.h"
#include "io/testing/test_image.h"
#include "io/testing/test_segmentation.h"

namespace palpate::io {
namespace {

using internal::group;
using internal::succeed;
using internal::TestFolder;
using internal::TestSegmentation;

constexpr int law_columns = TestSegmentation::columns, law_rows = TestSegmentation::rows;

std::size_t index_of(int i, int j) {
  return static_cast<std::size_t>(j) * law_columns + static_cast<std::size_t>(i);
}

/// As an attribute holds them (DS): at most 16 characters a number.
std::string numbers(const std::vector<double>& values) {
  std::string all;
  for (const double value : values) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.9g", value);
    all += (all.empty() ? "" : "\\") + std::string(text.data());
  }
  return all;
}

/// How frames lie: the directions of their rows and columns, and the place of the first voxel of each.
struct Places {
  Vec3 i, j;
  std::vector<Vec3> first;

  Vec3 of(std::size_t frame, int column, int row) const { return first[frame] + column * 0.75 * i + row * 0.5 * j; }
};

void place_frames(DcmDataset& dataset, const Places& places) {
  DcmItem& shared = group(dataset, DCM_SharedFunctionalGroupsSequence);
  const std::string directions = numbers({places.i.x, places.i.y, places.i.z, places.j.x, places.j.y, places.j.z});
  succeed(
      group(shared, DCM_PlaneOrientationSequence).putAndInsertString(DCM_ImageOrientationPatient, directions.c_str()));
  for (std::size_t n = 0; n < places.first.size(); ++n) {
    DcmItem* frame = nullptr;
    succeed(dataset.findOrCreateSequenceItem(DCM_PerFrameFunctionalGroupsSequence, frame, static_cast<long>(n)));
    const std::string first = numbers({places.first[n].x, places.first[n].y, places.first[n].z});
    succeed(group(*frame, DCM_PlanePositionSequence).putAndInsertString(DCM_ImagePositionPatient, first.c_str()));
  }
}

/// What is measured of voxels at these places.
struct Sum {
  Vec3 low{1e9}, high{-1e9}, sum{0};
  std::uint64_t voxels = 0;

  void add(const Vec3& at) {
    low = glm::min(low, at);
    high = glm::max(high, at);
    sum += at;
    ++voxels;
  }
};

void expect_measures(const Structure& structure, const Sum& sum, double step_mm) {
  const StructureMeasures measures = measure(structure);
  EXPECT_EQ(measures.voxels, sum.voxels);
  EXPECT_NEAR(measures.volume_mm3, static_cast<double>(sum.voxels) * 0.75 * 0.5 * step_mm, 1e-4);
  EXPECT_LT(glm::distance(measures.centroid_mm, sum.sum / static_cast<double>(sum.voxels)), 1e-5);
  EXPECT_LT(glm::distance(measures.box_low_mm, sum.low), 1e-5);
  EXPECT_LT(glm::distance(measures.box_high_mm, sum.high), 1e-5);
}

class RandomNumbers {
 public:
  explicit RandomNumbers(unsigned seed) : engine_(seed) {}
  int any(int count) { return std::uniform_int_distribution<int>(0, count - 1)(engine_); }
  Vec3 unit() {
    std::normal_distribution<double> normal;
    const double x = normal(engine_), y = normal(engine_), z = normal(engine_);
    return glm::normalize(Vec3(x, y, z));
  }
  template <typename Items>
  void shuffle(Items& items) {
    std::shuffle(items.begin(), items.end(), engine_);
  }

 private:
  std::mt19937 engine_;
};

// Two segments on the slices 0, 1, 3 and 6 of one lattice, their frames in any order.
TEST(SegmentationLaws, VoxelsLieWhereTheirFramesSayInAnyOrientation) {
  constexpr double step_mm = 2.5;
  std::vector<std::pair<Vec3, Vec3>> orientations{{{1, 0, 0}, {0, 1, 0}},   // axial
                                                  {{1, 0, 0}, {0, 0, -1}},  // coronal
                                                  {{0, 1, 0}, {0, 0, -1}},  // sagittal
                                                  {{-1, 0, 0}, {0, 1, 0}},  // axial, slices toward the feet
                                                  {{1, 0, 0}, {0, 0, 1}}};  // coronal, slices toward the front
  RandomNumbers random(7);
  for (int n = 0; n < 5; ++n) {
    const Vec3 i = random.unit();
    orientations.emplace_back(i, glm::normalize(glm::cross(random.unit(), i)));
  }
  for (std::size_t n = 0; n < orientations.size(); ++n) {
    SCOPED_TRACE(n);
    Places places{orientations[n].first, orientations[n].second, {}};
    const Vec3 origin = 120.0 * random.unit();
    const Vec3 step = step_mm * glm::cross(places.i, places.j);
    std::vector<std::pair<int, int>> order;  // segment and slice
    for (const int segment : {1, 2}) {
      for (const int slice : {0, 1, 3, 6}) order.emplace_back(segment, slice);
    }
    random.shuffle(order);
    TestSegmentation segmentation{.names = {"Liver", "Tumor"}};
    std::array<Sum, 2> sums;
    for (const auto& [segment, slice] : order) {
      places.first.push_back(origin + static_cast<double>(slice) * step);
      std::vector<int> bits;
      for (int at = 0; at < law_columns * law_rows; ++at) {
        bits.push_back(random.any(3) == 0 ? 1 : 0);
        if (bits.back() == 0) continue;
        sums[static_cast<std::size_t>(segment - 1)].add(
            places.of(places.first.size() - 1, at % law_columns, at / law_columns));
      }
      segmentation.frames.push_back({segment, 0, [bits](int i, int j) { return bits[index_of(i, j)]; }});
    }
    segmentation.edit = [&](DcmDataset& dataset) { place_frames(dataset, places); };
    const TestFolder folder;
    write(segmentation, folder / "seg.dcm");
    const StructureCatalogue found = find_structures(std::array{folder.path()});
    ASSERT_EQ(found.structures.size(), 2U) << (found.skipped.empty() ? Text() : found.skipped[0].reason);
    for (const std::size_t segment : {0U, 1U}) expect_measures(found.structures[segment], sums[segment], step_mm);
  }
}

// Bits, labels and fractions of several frames, deflated or not. A deflated file (PS3.5 A.5) is compressed from behind
// its meta header on.
TEST(SegmentationLaws, VoxelsAreTheSameInEveryUncompressedTransferSyntax) {
  struct Form {
    std::string type;
    int bits, inside;
  };
  for (const Form& form :
       {Form{"BINARY", 1, 1}, Form{"LABELMAP", 8, 1}, Form{"LABELMAP", 16, 1}, Form{"FRACTIONAL", 8, 200}}) {
    for (const auto& [syntax, in_words] : {std::pair{EXS_LittleEndianExplicit, false},
                                           {EXS_LittleEndianExplicit, true},
                                           {EXS_LittleEndianImplicit, false},
                                           {EXS_DeflatedLittleEndianExplicit, false},
                                           {EXS_BigEndianExplicit, false},
                                           {EXS_BigEndianExplicit, true}}) {
      if (form.bits == 16 && syntax == EXS_BigEndianExplicit && !in_words) continue;  // words have no bytes
      SCOPED_TRACE(form.type + " " + std::to_string(form.bits) + ", " + DcmXfer(syntax).getXferName() +
                   (in_words ? ", OW" : ""));
      RandomNumbers random(11);
      Places places{{1, 0, 0}, {0, 1, 0}, {}};
      Sum sum;
      TestSegmentation segmentation{.type = form.type, .bits = form.bits, .syntax = syntax};
      for (int slice = 0; slice < 4; ++slice) {
        places.first.emplace_back(0, 0, 2 * slice);
        std::vector<int> values;
        for (int at = 0; at < law_columns * law_rows; ++at) {
          values.push_back(random.any(3) == 0 ? form.inside : 0);
          if (values.back() != 0) sum.add(places.of(places.first.size() - 1, at % law_columns, at / law_columns));
        }
        segmentation.frames.push_back({1, 2.0 * slice, [values](int i, int j) { return values[index_of(i, j)]; }});
      }
      // PS3.5 7.3 and 8.2: in 16-bit words the first byte is the lower one; the writer puts words in the file's order.
      if (in_words) {
        segmentation.edit = [](DcmDataset& dataset) {
          const Uint8* bytes = nullptr;
          unsigned long count = 0;
          succeed(dataset.findAndGetUint8Array(DCM_PixelData, bytes, &count));
          std::vector<Uint16> words;
          for (unsigned long n = 0; n < count; n += 2)
            words.push_back(static_cast<Uint16>(bytes[n] | bytes[n + 1] << 8));
          succeed(
              dataset.putAndInsertUint16Array(DCM_PixelData, words.data(), static_cast<unsigned long>(words.size())));
        };
      }
      const TestFolder folder;
      write(segmentation, folder / "seg.dcm");
      const StructureCatalogue found = find_structures(std::array{folder.path()});
      ASSERT_EQ(found.structures.size(), 1U) << (found.skipped.empty() ? Text() : found.skipped[0].reason);
      expect_measures(found.structures[0], sum, 2);
    }
  }
}

// PS3.3 8.8: who defined the code, the code, and what it means.
TEST(SegmentationLaws, ASegmentsCodeIsItsSchemeItsValueAndItsMeaning) {
  TestSegmentation segmentation{.names = {"a", "b", "c"}};
  for (const int segment : {1, 2, 3}) segmentation.frames.push_back({segment, 0, [](int, int) { return 1; }});
  const std::vector<std::array<const char*, 3>> codes{{"SCT", "10200004", "Liver"}, {"99LAB", "L-1", "Left lobe"}};
  segmentation.edit = [&](DcmDataset& dataset) {
    for (std::size_t n = 0; n < codes.size(); ++n) {
      DcmItem* segment = nullptr;
      succeed(dataset.findAndGetSequenceItem(DCM_SegmentSequence, segment, static_cast<long>(n)));
      DcmItem& code = group(*segment, DCM_SegmentedPropertyTypeCodeSequence);
      succeed(code.putAndInsertString(DCM_CodingSchemeDesignator, codes[n][0]));
      succeed(code.putAndInsertString(DCM_CodeValue, codes[n][1]));
      succeed(code.putAndInsertString(DCM_CodeMeaning, codes[n][2]));
    }
  };
  const TestFolder folder;
  write(segmentation, folder / "seg.dcm");
  std::vector<std::string> told;
  for (const Structure& structure : find_structures(std::array{folder.path()}).structures) {
    told.push_back(structure.code);
  }
  EXPECT_EQ(told, (std::vector<std::string>{"SCT 10200004 Liver", "99LAB L-1 Left lobe", ""}));
}

}  // namespace
}  // namespace palpate::io

// Several acquisitions in one series with interleaved slices are never read as one volume. The truth is what was
// written: which slice of which stack holds which value.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <random>

#include "io/load.h"
#include "io/testing/test_image.h"

namespace palpate::io::internal {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;
using ::testing::UnorderedElementsAreArray;

/// Height and value of each slice, ascending.
using Stack = std::vector<std::pair<double, int>>;

struct Written {
  double first = 0;  // mm
  double step = 5;
  int count = 20;
};

struct Edit {
  std::string name;
  std::function<void(DcmDataset&, int stack, int slice)> make;
};

std::string text(int value) {
  return std::to_string(value);
}

/// Writes the stacks one after the other, in files whose names tell nothing, and returns what was written.
std::vector<Stack> write_stacks(const TestFolder& folder, const std::vector<Written>& stacks, const Edit& edit,
                                double thickness) {
  std::mt19937 random(19);
  std::uniform_int_distribution<int> noise(0, 60000);
  std::vector<Stack> truth;
  int number = 0;
  for (int s = 0; s < static_cast<int>(stacks.size()); ++s) {
    const Written& stack = stacks[static_cast<std::size_t>(s)];
    Stack& written = truth.emplace_back();
    for (int k = 0; k < stack.count; ++k) {
      const int value = noise(random);
      TestImage image;
      image.z = stack.first + stack.step * k;
      image.value = [value](int, int) { return value; };
      image.edit = [&](DcmDataset& d) {
        if (thickness > 0) {
          put(d, DCM_SliceThickness, std::to_string(thickness));
        } else {
          d.findAndDeleteElement(DCM_SliceThickness);
        }
        edit.make(d, s, k);
      };
      write(image, folder / (text(noise(random)) + "_" + text(++number)));
      written.emplace_back(image.z, value);
    }
  }
  return truth;
}

/// Every volume that is offered, of all frames of all series.
std::vector<Stack> volumes_in(const Catalogue& found) {
  std::vector<Stack> all;
  for (const Series& series : found.series) {
    for (int frame = 0; frame < series.frames_per_position; ++frame) {
      const Volume volume = load_frame(series, frame);
      Stack& stack = all.emplace_back();
      for (int k = 0; k < volume.geometry.dimensions.z; ++k) {
        stack.emplace_back(volume.geometry.slice_positions[static_cast<std::size_t>(k)].z, volume.value_at(1, 1, k));
      }
    }
  }
  return all;
}

// --- What tells the acquisitions apart -------------------------------------------------------------------------------

const std::vector<Edit> labels{
    {"acquisition", [](DcmDataset& d, int s, int) { put(d, DCM_AcquisitionNumber, text(s + 1)); }},
    {"acquisition_time", [](DcmDataset& d, int s, int) { put(d, DCM_AcquisitionTime, text(101010 + s)); }},
    {"growing_time", [](DcmDataset& d, int s, int k) { put(d, DCM_AcquisitionTime, text(101000 + 100 * s + k)); }},
    {"content_time", [](DcmDataset& d, int s, int k) { put(d, DCM_ContentTime, text(101000 + 100 * s + k)); }},
    {"instance", [](DcmDataset& d, int s, int k) { put(d, DCM_InstanceNumber, text(100 * s + k)); }},
    {"backwards", [](DcmDataset& d, int s, int k) { put(d, DCM_InstanceNumber, text(100 * s + 50 - k)); }},
    {"time_point", [](DcmDataset& d, int s, int) { put(d, DCM_TemporalPositionIdentifier, text(s + 1)); }},
    {"echo", [](DcmDataset& d, int s, int) { put(d, DCM_EchoTime, text(10 * (s + 1))); }},
    {"b_value", [](DcmDataset& d, int s, int) { succeed(d.putAndInsertFloat64(DCM_DiffusionBValue, 400.0 * s)); }},
    {"trigger_time", [](DcmDataset& d, int s, int) { put(d, DCM_TriggerTime, text(100 * s)); }},
    {"image_type", [](DcmDataset& d, int s, int) { put(d, DCM_ImageType, "DERIVED\\PRIMARY\\AXIAL\\CT_" + text(s)); }},
    {"kernel", [](DcmDataset& d, int s, int) { put(d, DCM_ConvolutionKernel, s == 0 ? "B30f" : "B70f" + text(s)); }}};

struct Case {
  Edit label;
  std::string name;
  std::vector<Written> stacks;
};

void PrintTo(const Case& c, std::ostream* out) {  // NOLINT(readability-identifier-naming): GoogleTest's name
  *out << c.name;
}

std::vector<Case> cases() {
  const std::vector<std::pair<std::string, std::vector<Written>>> layouts{
      {"halves", {{0, 5, 20}, {2.5, 5, 20}}},        {"thirds", {{0, 4.5, 12}, {1.5, 4.5, 12}, {3, 4.5, 12}}},
      {"one_third", {{0, 4.5, 20}, {1.5, 4.5, 20}}}, {"a_whole_step", {{0, 5, 20}, {5, 5, 20}}},
      {"partly", {{0, 5, 20}, {52.5, 5, 20}}},       {"unequal", {{0, 5, 20}, {32.5, 5, 7}}}};
  std::vector<Case> all;
  for (const Edit& label : labels) {
    for (const auto& [name, stacks] : layouts) all.push_back({label, label.name + "_" + name, stacks});
  }
  return all;
}

class Interleaved : public ::testing::TestWithParam<Case> {};

TEST_P(Interleaved, AcquisitionsAreVolumesOfTheirOwn) {
  const TestFolder folder;
  const auto truth = write_stacks(folder, GetParam().stacks, GetParam().label, 5);
  const Catalogue found = find_in(folder);
  EXPECT_THAT(found.skipped, IsEmpty());
  EXPECT_THAT(volumes_in(found), UnorderedElementsAreArray(truth));
}

INSTANTIATE_TEST_SUITE_P(OfCt, Interleaved, ::testing::ValuesIn(cases()), [](const auto& it) { return it.param.name; });

TEST(InterleavedStacks, AreNamed) {
  const TestFolder folder;
  write_stacks(folder, {{0, 5, 20}, {2.5, 5, 20}}, labels[0], 5);
  const Catalogue found = find_in(folder);
  ASSERT_THAT(found.series, SizeIs(2));
  EXPECT_EQ(found.series[0].part, "acquisition 1");
  EXPECT_EQ(found.series[1].part, "acquisition 2");
  EXPECT_EQ(found.series[0].uid, found.series[1].uid);
}

// --- What looks like it and is one scan ------------------------------------------------------------------------------

TEST(InterleavedStacks, ScanThatIsContinuedIsOne) {
  for (const Edit& label : labels) {
    if (label.name == "backwards") continue;
    const TestFolder folder;
    auto truth = write_stacks(folder, {{0, 5, 20}, {100, 5, 20}}, label, 5);
    truth[0].insert(truth[0].end(), truth[1].begin(), truth[1].end());
    EXPECT_THAT(volumes_in(find_in(folder)), ElementsAre(truth[0])) << label.name;
  }
}

// Two passes of a multi-slice MR sequence: odd slices first, then even ones, 4 mm thick and 5 mm apart.
TEST(InterleavedStacks, PassesOfOneAcquisitionAreOne) {
  for (const Edit& label : labels) {
    const bool by_time = label.name == "acquisition" || label.name == "acquisition_time" ||
                         label.name == "growing_time" || label.name == "content_time" || label.name == "trigger_time";
    if (!by_time) continue;
    const TestFolder folder;
    auto truth = write_stacks(folder, {{0, 10, 10}, {5, 10, 10}},
                              {"",
                               [&](DcmDataset& d, int s, int k) {
                                 put(d, DCM_Modality, "MR");
                                 put(d, DCM_InstanceNumber, text(2 * k + s));
                                 label.make(d, s, k);
                               }},
                              4);
    truth[0].insert(truth[0].end(), truth[1].begin(), truth[1].end());
    std::sort(truth[0].begin(), truth[0].end());
    const Catalogue found = find_in(folder);
    EXPECT_THAT(volumes_in(found), ElementsAre(truth[0])) << label.name;
    EXPECT_THAT(found.series.at(0).warnings, IsEmpty());
  }
}

TEST(InterleavedStacks, WithoutAThicknessPassesOfMrAreOneWithAWord) {
  const TestFolder folder;
  write_stacks(folder, {{0, 10, 10}, {5, 10, 10}},
               {"",
                [](DcmDataset& d, int s, int) {
                  put(d, DCM_Modality, "MR");
                  put(d, DCM_AcquisitionNumber, text(s + 1));
                }},
               0);
  const Catalogue found = find_in(folder);
  ASSERT_THAT(found.series, SizeIs(1));
  EXPECT_EQ(found.series[0].geometry.dimensions.z, 20);
  EXPECT_THAT(
      found.series[0].warnings,
      Contains("slices of acquisition 1 and acquisition 2 alternate, and no slice thickness says whether they are one "
               "scan or two: compare neighboring slices before you trust what is felt"));
}

TEST(InterleavedStacks, NeighborsThatOverlapByHalfAreToldOfWhereNothingPartsThem) {
  const TestFolder folder;
  write_stacks(folder, {{0, 2.5, 20}}, {"", [](DcmDataset&, int, int) {}}, 5);
  const Catalogue found = find_in(folder);
  ASSERT_THAT(found.series, SizeIs(1));
  EXPECT_THAT(found.series[0].warnings,
              Contains("slices are 5.00 mm thick and 2.50 mm apart, so that neighbors overlap: this is one scan with "
                       "overlap, or two scans in one series; compare neighboring slices"));

  const TestFolder contiguous;
  write_stacks(contiguous, {{0, 4, 20}}, {"", [](DcmDataset&, int, int) {}}, 5);
  EXPECT_THAT(find_in(contiguous).series.at(0).warnings, Not(Contains(HasSubstr("overlap"))));
}

// --- Other ways to lie in one another --------------------------------------------------------------------------------

TEST(InterleavedStacks, LeftAndRightBreastAreTwo) {
  const TestFolder folder;
  const auto truth =
      write_stacks(folder, {{-60, 5, 10}, {20, 5, 10}},
                   {"", [](DcmDataset& d, int s, int) { put(d, DCM_ImageLaterality, s == 0 ? "R" : "L"); }}, 5);
  EXPECT_THAT(volumes_in(find_in(folder)), UnorderedElementsAreArray(truth));
}

TEST(InterleavedStacks, StacksBesideEachOtherAreTwo) {
  for (const double second : {0.0, 2.5}) {
    const TestFolder folder;
    const auto truth = write_stacks(folder, {{0, 5, 10}, {second, 5, 10}},
                                    {"",
                                     [&](DcmDataset& d, int s, int k) {
                                       put(d, DCM_ImagePositionPatient,
                                           text(150 * s) + "\\0\\" + std::to_string((s == 0 ? 0 : second) + 5 * k));
                                     }},
                                    5);
    const Catalogue found = find_in(folder);
    ASSERT_THAT(found.series, SizeIs(2));
    EXPECT_THAT(volumes_in(found), UnorderedElementsAreArray(truth));
    EXPECT_EQ(std::abs(found.series[0].geometry.slice_positions[0].x - found.series[1].geometry.slice_positions[0].x),
              150);
  }
}

TEST(InterleavedStacks, FilesOfSeveralFramesAreNeverMixed) {
  for (const double offset : {1.5, 1.0, 0.4, 7.5}) {
    const TestFolder folder;
    std::vector<Stack> truth;
    for (int s = 0; s < 2; ++s) {
      std::vector<double> heights;
      for (int k = 0; k < 8; ++k) heights.push_back(offset * s + 3 * k);
      TestImage image;
      image.value = [s](int, int) { return 100 + s; };
      image.edit = [&](DcmDataset& d) {
        repeat_pixels(d, heights.size());
        make_multi_frame(d, heights);
      };
      write(image, folder / text(s));
      Stack& stack = truth.emplace_back();
      for (const double z : heights) stack.emplace_back(z, 100 + s);
    }
    const Catalogue found = find_in(folder);
    EXPECT_THAT(volumes_in(found), UnorderedElementsAreArray(truth)) << offset;
    for (const Series& series : found.series) EXPECT_TRUE(series.geometry.uniform);
  }
}

/// Siemens' private header, as far as a mosaic needs it.
std::vector<Uint8> csa_header(const std::vector<std::pair<std::string, std::vector<std::string>>>& tags) {
  std::vector<Uint8> bytes;
  const auto add_text = [&](const std::string& s, std::size_t size) {
    for (std::size_t n = 0; n < size; ++n) bytes.push_back(n < s.size() ? static_cast<Uint8>(s[n]) : 0);
  };
  const auto add_number = [&](std::size_t value) {
    for (int n = 0; n < 4; ++n) bytes.push_back(static_cast<Uint8>(value >> 8 * n));
  };
  add_text("SV10", 8);
  add_number(tags.size());
  add_number(77);
  for (const auto& [name, values] : tags) {
    add_text(name, 64);
    add_text("", 12);
    add_number(values.size());
    add_number(77);
    for (const std::string& value : values) {
      add_number(0);
      add_number(value.size());
      add_text("", 8);
      add_text(value, (value.size() + 3) / 4 * 4);
    }
  }
  return bytes;
}

TEST(InterleavedStacks, MosaicsAreNeverMixed) {
  const TestFolder folder;
  std::vector<Stack> truth;
  for (int s = 0; s < 2; ++s) {
    TestImage image;
    image.columns = 12;
    image.rows = 8;
    image.z = 1.5 * s;
    // Four tiles, of 6 x 4; tile n holds 10 n + s.
    image.value = [s](int i, int j) { return 10 * (i / 6 + 2 * (j / 4)) + s; };
    image.edit = [](DcmDataset& d) {
      put(d, DCM_Modality, "MR");
      put(d, DCM_ImageType, "ORIGINAL\\PRIMARY\\M\\ND\\MOSAIC");
      put(d, DCM_SpacingBetweenSlices, "3");
      succeed(d.putAndInsertString(DcmTag(0x0029, 0x0010, EVR_LO), "SIEMENS CSA HEADER"));
      const auto csa = csa_header({{"NumberOfImagesInMosaic", {"4"}}, {"SliceNormalVector", {"0", "0", "1"}}});
      succeed(
          d.putAndInsertUint8Array(DcmTag(0x0029, 0x1010, EVR_OB), csa.data(), static_cast<unsigned long>(csa.size())));
    };
    write(image, folder / text(s));
    Stack& stack = truth.emplace_back();
    for (int n = 0; n < 4; ++n) stack.emplace_back(1.5 * s + 3 * n, 10 * n + s);
  }
  EXPECT_THAT(volumes_in(find_in(folder)), UnorderedElementsAreArray(truth));
}

// A head that moved by a little between two times: frames of one volume, each where it is.
TEST(InterleavedStacks, TimesThatFollowAHeadAreFrames) {
  const TestFolder folder;
  const auto truth = write_stacks(folder, {{0, 5, 10}, {0.3, 5, 10}, {0.5, 5, 10}}, labels[6], 5);
  const Catalogue found = find_in(folder);
  ASSERT_THAT(found.series, SizeIs(1));
  EXPECT_EQ(found.series[0].frames_per_position, 3);
  EXPECT_EQ(found.series[0].frame_names.at(1), "time point 2");
  EXPECT_THAT(found.series[0].warnings, Contains("its frames lie up to 0.50 mm apart: each is felt where it is"));
  EXPECT_THAT(volumes_in(found), UnorderedElementsAreArray(truth));
}

}  // namespace
}  // namespace palpate::io::internal

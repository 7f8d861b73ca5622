#include <dcmtk/config/osconfig.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "io/errors.h"
#include "io/load.h"
#include "io/series.h"
#include "io/testing/test_coders.h"
#include "io/testing/test_image.h"

namespace palpate::io::internal {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

TEST(FindSeries, OrderOfFilesAndNumbersDoesNotMatter) {
  const TestFolder folder;
  write_stack(folder.path(), 5, [](int k, TestImage& image) {
    image.z = 2.0 * ((k * 3) % 5);  // names and instance numbers say another order than the positions
    image.edit = [k](DcmDataset& d) { put(d, DCM_InstanceNumber, std::to_string(k + 1)); };
    image.value = [z = image.z](int, int) { return static_cast<int>(z); };
  });
  const Catalogue found = find_in(folder);
  ASSERT_THAT(found.series, SizeIs(1));
  const Volume volume = load(found.series[0]);
  for (int k = 0; k < 5; ++k) EXPECT_EQ(volume.value_at(3, 2, k), 2 * k);
  EXPECT_EQ(volume.geometry.step, Vec3(0, 0, 2));
  EXPECT_EQ(volume.geometry.spacing_i, 0.75);  // PixelSpacing: rows first
  EXPECT_EQ(volume.geometry.spacing_j, 0.5);
}

TEST(FindSeries, TellsTheWindowThatTheMiddleSliceAsksFor) {
  const TestFolder folder;
  write_stack(folder.path(), 3, [](int k, TestImage& image) {
    image.edit = [k](DcmDataset& d) {
      put(d, DCM_WindowCenter, std::to_string(40 + k) + "\\300");
      put(d, DCM_WindowWidth, "400.5\\2000");
    };
  });
  const Catalogue found = find_in(folder);
  ASSERT_TRUE(found.series.at(0).window);
  EXPECT_EQ(found.series[0].window->level, 41);
  EXPECT_EQ(found.series[0].window->width, 400.5);
}

// Of an enhanced file each frame has its own, or all share one (PS3.3 C.7.6.16.2.10).
TEST(FindSeries, TellsTheWindowOfTheMiddleFrameOfAnEnhancedFile) {
  const TestFolder folder;
  TestImage image;
  image.edit = [](DcmDataset& d) {
    repeat_pixels(d, 3);
    make_multi_frame(d, {0, 2, 4}, [](std::size_t n, DcmItem& frame) {
      DcmItem& window = group(frame, DCM_FrameVOILUTSequence);
      succeed(window.putAndInsertString(DCM_WindowCenter, std::to_string(40 + n).c_str()));
      succeed(window.putAndInsertString(DCM_WindowWidth, std::to_string(400 + n).c_str()));
    });
  };
  write(image, folder / "enhanced");
  const Series series = only_series_in(folder);
  ASSERT_TRUE(series.window);
  EXPECT_EQ(series.window->level, 41);
  EXPECT_EQ(series.window->width, 401);
}

TEST(FindSeries, AWindowWithoutAWidthIsNone) {
  for (const char* width : {"0", "-5", ""}) {
    const TestFolder folder;
    write_stack(folder.path(), 2, [&](int, TestImage& image) {
      image.edit = [&](DcmDataset& d) {
        put(d, DCM_WindowCenter, "40");
        put(d, DCM_WindowWidth, width);
      };
    });
    EXPECT_FALSE(find_in(folder).series.at(0).window) << width;
  }
}

TEST(Load, SomeSlicesAreThoseOfTheWhole) {
  const TestFolder folder;
  write_stack(folder.path(), 9, [](int k, TestImage& image) {
    image.z = k < 6 ? 2.0 * k : 2.0 * k + 4;                                            // a gap behind slice 5
    image.edit = [k](DcmDataset& d) { put(d, DCM_RescaleSlope, k == 0 ? "2" : "1"); };  // so the whole is of floats
  });
  const Series series = find_in(folder).series.at(0);
  const Volume whole = load(series);
  ASSERT_THAT(whole.geometry.gaps, ElementsAre(5));
  LoadOptions some;
  some.slices = {4, 3};
  const Volume part = load(series, some);
  EXPECT_EQ(part.geometry.dimensions, glm::ivec3(whole.geometry.dimensions.x, whole.geometry.dimensions.y, 3));
  EXPECT_EQ(part.geometry.step, whole.geometry.step);
  EXPECT_THAT(part.geometry.gaps, ElementsAre(1));
  EXPECT_EQ(part.voxels.index(), whole.voxels.index());
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(part.geometry.slice_positions[static_cast<std::size_t>(k)],
              whole.geometry.slice_positions[static_cast<std::size_t>(k + 4)]);
    EXPECT_EQ(part.value_at(3, 2, k), whole.value_at(3, 2, k + 4));
  }
  some.slices = {7, 3};
  EXPECT_THROW(load(series, some), DicomError);
  // Missing slices are known where both of their neighbors are there.
  for (int first = 0; first < 9; ++first) {
    for (int count = 1; count <= 9 - first; ++count) {
      some.slices = LoadOptions::Range{first, count};
      const std::vector<int> gaps = load(series, some).geometry.gaps;
      const bool both = first <= 5 && first + count > 6;
      EXPECT_EQ(gaps, both ? std::vector<int>{5 - first} : std::vector<int>()) << first << " + " << count;
    }
  }
}

// A slice that turns out to be unreadable is left out of whatever part it lies in.
TEST(Load, ASliceThatCannotBeReadIsLeftOutOfEveryPartThatHoldsIt) {
  register_encoders();
  constexpr int bad = 3;
  const TestFolder folder;
  write_stack(folder.path(), 7, [](int k, TestImage& image) {
    image.syntax = EXS_RLELossless;
    if (k == bad)
      image.edit = [](DcmDataset& d) { encapsulate(d, EXS_RLELossless, {std::vector<Uint8>(100, 7)}, 1000); };
  });
  const Series series = find_in(folder).series.at(0);
  for (int first = 0; first < 7; ++first) {
    for (int count = 2; count <= 7 - first; ++count) {
      SCOPED_TRACE(::testing::Message() << first << " + " << count);
      LoadOptions some;
      some.slices = LoadOptions::Range{first, count};
      const Volume part = load(series, some);
      const bool holds_it = first <= bad && bad < first + count;
      std::vector<double> heights;
      for (const Vec3& position : part.geometry.slice_positions) heights.push_back(position.z);
      std::vector<double> expected;
      for (int k = first; k < first + count; ++k) {
        if (k != bad) expected.push_back(2.0 * k);
      }
      EXPECT_EQ(heights, expected);
      ASSERT_EQ(part.geometry.dimensions.z, static_cast<int>(expected.size()));
      for (int k = 0; k < part.geometry.dimensions.z; ++k) {
        EXPECT_EQ(part.value_at(3, 2, k), 50 * expected[static_cast<std::size_t>(k)] + 32);
      }
      const bool both = holds_it && first < bad && first + count > bad + 1;
      EXPECT_EQ(part.geometry.gaps, both ? std::vector<int>{bad - 1 - first} : std::vector<int>());
      EXPECT_EQ(part.warnings.empty(), !holds_it);
    }
  }
}

TEST(FindSeries, EchoesBecomeFramesInTheirOrder) {
  const TestFolder folder;
  for (const int echo : {2, 0, 1}) {
    std::filesystem::create_directory(folder / std::to_string(echo));
    write_stack(folder / std::to_string(echo), 4, [echo](int k, TestImage& image) {
      image.value = [k, echo](int, int) { return 10 * echo + k; };
      image.edit = [echo](DcmDataset& d) {
        put(d, DCM_EchoTime, std::array{"4.6", "9.2", "13.8"}[static_cast<std::size_t>(echo)]);
      };
    });
  }
  const Catalogue found = find_in(folder);
  ASSERT_THAT(found.series, SizeIs(1));
  EXPECT_THAT(found.series[0].frame_names, ElementsAre("echo time 4.6 ms", "echo time 9.2 ms", "echo time 13.8 ms"));
  for (int echo = 0; echo < 3; ++echo) {
    for (int k = 0; k < 4; ++k) EXPECT_EQ(load_frame(found.series[0], echo).value_at(0, 0, k), 10 * echo + k);
  }
}

// A dynamic series where only the order of acquisition tells the time points apart, and times differ from slice to
// slice.
TEST(FindSeries, RepeatsWithoutALabelBecomeFramesByTime) {
  const TestFolder folder;
  for (int n = 0; n < 12; ++n) {
    TestImage image;
    image.z = 2.0 * (n % 4);
    image.value = [n](int, int) { return n / 4; };
    image.edit = [n](DcmDataset& d) { put(d, DCM_AcquisitionTime, std::to_string(100000 + 7 * n)); };
    write(image, folder / numbered("f", 97 - n));
  }
  const Series series = find_in(folder).series.at(0);
  ASSERT_EQ(series.frames_per_position, 3);
  for (int frame = 0; frame < 3; ++frame) {
    const Statistics values = statistics(load_frame(series, frame));
    EXPECT_EQ(values.minimum, frame);
    EXPECT_EQ(values.maximum, frame);
  }
}

TEST(FindSeries, FrameThatLacksASliceHasAGap) {
  const TestFolder folder;
  for (int n = 0; n < 10; ++n) {
    if (n == 7) continue;
    TestImage image;
    image.z = 2.0 * (n % 5);
    image.edit = [n](DcmDataset& d) {
      put(d, DCM_Modality, "MR");
      put(d, DCM_TemporalPositionIdentifier, std::to_string(n / 5 + 1));
    };
    write(image, folder / std::to_string(n));
  }
  const Series series = find_in(folder).series.at(0);
  ASSERT_EQ(series.frames_per_position, 2);
  EXPECT_THAT(series.warnings, ElementsAre(HasSubstr("frame 1 has 4 slices, not 5")));
  EXPECT_THAT(load_frame(series, 0).geometry.gaps, IsEmpty());
  EXPECT_THAT(load_frame(series, 1).geometry.gaps, ElementsAre(1));
}

TEST(FindSeries, LoneRepeatIsLeftOutWithAWord) {
  const TestFolder folder;
  write_stack(folder.path(), 6);
  TestImage again;
  again.z = 4;
  write(again, folder / "z_again.dcm");
  const Catalogue found = find_in(folder);
  EXPECT_EQ(found.series.at(0).frames_per_position, 1);
  EXPECT_EQ(load(found.series[0]).value_at(1, 1, 2), 211);
  ASSERT_THAT(found.skipped, SizeIs(1));
  EXPECT_EQ(found.skipped[0].path.filename(), "z_again.dcm");
}

TEST(FindSeries, TwoOrientationsOfOneUidAreTwoVolumes) {
  const TestFolder folder;
  write_stack(folder.path(), 4);
  std::filesystem::create_directory(folder / "sagittal");
  write_stack(folder / "sagittal", 3, [](int k, TestImage& image) {
    image.edit = [k](DcmDataset& d) {
      put(d, DCM_ImageOrientationPatient, "0\\1\\0\\0\\0\\-1");
      put(d, DCM_ImagePositionPatient, std::to_string(3 * k) + "\\0\\50");
    };
  });
  const Catalogue found = find_in(folder);
  ASSERT_THAT(found.series, SizeIs(2));
  EXPECT_EQ(found.series[0].geometry.dimensions.z, 4);
  EXPECT_EQ(found.series[1].geometry.dimensions.z, 3);
  EXPECT_EQ(found.series[1].geometry.slice_positions[0], Vec3(6, 0, 50));  // ascending along i x j, here -x
  EXPECT_EQ(load(found.series[1]).value_at(0, 0, 0), 200);
}

TEST(FindSeries, SeveralMultiFrameFilesOfASeriesAreOneVolume) {
  const TestFolder folder;
  const std::array<std::vector<double>, 2> heights{{{8, 2, 4}, {6, 10, 0}}};  // mm: frames and files in no order
  for (std::size_t file = 0; file < heights.size(); ++file) {
    TestImage image;
    image.edit = [&](DcmDataset& d) {
      make_multi_frame(d, heights[file]);
      repeat_pixels(d, heights[file].size());
    };
    write(image, folder / std::to_string(file));
  }
  const Catalogue found = find_in(folder);
  ASSERT_THAT(found.series, SizeIs(1));
  EXPECT_THAT(found.series[0].files, SizeIs(2));
  EXPECT_EQ(found.series[0].frames_per_position, 1);
  const Geometry& geometry = load(found.series[0]).geometry;
  ASSERT_EQ(geometry.dimensions.z, 6);
  for (std::size_t k = 0; k < 6; ++k) EXPECT_EQ(geometry.slice_positions[k].z, 2.0 * static_cast<double>(k));
}

TEST(FindSeries, LocalizerInASeriesIsSetApart) {
  const TestFolder folder;
  write_stack(folder.path(), 4);
  TestImage localizer;
  localizer.edit = [](DcmDataset& d) {
    put(d, DCM_ImageType, "ORIGINAL\\PRIMARY\\LOCALIZER");
    put(d, DCM_ImageOrientationPatient, "1\\0\\0\\0\\0\\-1");
  };
  write(localizer, folder / "scout");
  const Catalogue found = find_in(folder);
  ASSERT_THAT(found.series, SizeIs(1));
  EXPECT_EQ(found.series[0].geometry.dimensions.z, 4);
  ASSERT_THAT(found.skipped, SizeIs(1));
  EXPECT_THAT(found.skipped[0].reason, HasSubstr("localizer"));
}

TEST(FindSeries, ReadableCopyWinsOverTruncatedTwin) {
  const TestFolder folder;
  write_stack(folder.path(), 3, [](int k, TestImage& image) { image.instance = numbered("1.2.7.", k); });
  std::filesystem::copy_file(folder / "s1.dcm", folder / "a_cut.dcm");  // before s1.dcm in any order of names
  std::filesystem::resize_file(folder / "a_cut.dcm", std::filesystem::file_size(folder / "a_cut.dcm") - 10);
  const Catalogue found = find_in(folder);
  EXPECT_EQ(found.series.at(0).geometry.dimensions.z, 3);
  EXPECT_THAT(found.series[0].geometry.gaps, IsEmpty());
  ASSERT_THAT(found.skipped, SizeIs(1));
  EXPECT_EQ(found.skipped[0].path.filename(), "a_cut.dcm");
}

// A slice that was acquired once more, because its first image is no good.
TEST(FindSeries, AGoodRepeatWinsOverATruncatedImageThatCameFirst) {
  struct Order {
    DcmTagKey tag;
    const char *first, *later;
  };
  for (const Order& by : {Order{DCM_AcquisitionTime, "100000", "110000"},
                          {DCM_ContentTime, "100000", "110000"},
                          {DCM_InstanceNumber, "1", "2"}}) {
    const TestFolder folder;
    write_stack(folder.path(), 4, [&](int, TestImage& image) {
      image.edit = [&](DcmDataset& d) { put(d, by.tag, std::string(by.later)); };
    });
    TestImage first;  // of the place of s0.dcm, and another SOP instance
    first.value = [](int, int) { return 7; };
    first.edit = [&](DcmDataset& d) { put(d, by.tag, std::string(by.first)); };
    write(first, folder / "cut.dcm");
    std::filesystem::resize_file(folder / "cut.dcm", std::filesystem::file_size(folder / "cut.dcm") - 10);
    const Catalogue found = find_in(folder);
    ASSERT_THAT(found.skipped, SizeIs(1)) << by.tag.toString().c_str();
    EXPECT_EQ(found.skipped[0].path.filename(), "cut.dcm");
    ASSERT_THAT(found.series, SizeIs(1));
    const Volume volume = load(found.series[0]);
    ASSERT_EQ(volume.geometry.dimensions.z, 4);
    for (int k = 0; k < 4; ++k) EXPECT_EQ(volume.value_at(3, 2, k), 100 * k + 32) << k;
  }
}

struct Unfit {
  const char* name;
  std::function<void(DcmDataset&)> edit;
  const char* reason;
};

TEST(FindSeries, WhatCannotBeFeltIsRefusedWithAReason) {
  const std::array cases{
      Unfit{"color",
            [](DcmDataset& d) { put(d, DCM_SamplesPerPixel, 3), put(d, DCM_PhotometricInterpretation, "RGB"); },
            "color"},
      Unfit{"unplaced", [](DcmDataset& d) { succeed(d.findAndDeleteElement(DCM_ImagePositionPatient)); },
            "no position"},
      Unfit{"no spacing", [](DcmDataset& d) { put(d, DCM_PixelSpacing, "0\\0"); }, "no position"},
      Unfit{"not a number", [](DcmDataset& d) { put(d, DCM_ImagePositionPatient, "0\\0\\here"); }, "no position"},
      Unfit{"bad axes", [](DcmDataset& d) { put(d, DCM_ImageOrientationPatient, "1\\0\\0\\1\\0\\0"); }, "no position"},
      Unfit{"32 bits", [](DcmDataset& d) { put(d, DCM_BitsAllocated, 32), put(d, DCM_BitsStored, 32); }, "32 bits"},
      Unfit{"look-up table",
            [](DcmDataset& d) {
              DcmItem* item = nullptr;
              succeed(d.findOrCreateSequenceItem(DCM_ModalityLUTSequence, item, 0));
              succeed(item->putAndInsertString(DCM_ModalityLUTType, "HU"));
            },
            "look-up table"},
      Unfit{"loop of frames", [](DcmDataset& d) { put(d, DCM_NumberOfFrames, "2"); }, "several frames"},
  };
  for (const Unfit& unfit : cases) {
    const TestFolder folder;
    TestImage image;
    image.edit = unfit.edit;
    write(image, folder / "image");
    const Catalogue found = find_in(folder);
    EXPECT_THAT(found.series, IsEmpty()) << unfit.name;
    ASSERT_THAT(found.skipped, SizeIs(1)) << unfit.name;
    EXPECT_THAT(found.skipped[0].reason, HasSubstr(unfit.reason)) << unfit.name;
  }
}

}  // namespace
}  // namespace palpate::io::internal

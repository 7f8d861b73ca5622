// Legal or common habits of scanners, archives and anonymizers that a reader can get wrong silently: which images
// belong together, and their frames.
#include <dcmtk/config/osconfig.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "io/load.h"
#include "io/testing/test_image.h"

namespace palpate::io::internal {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

void put_private(DcmDataset& d, Uint16 group, const char* creator, Uint16 element, DcmEVR vr, const char* value) {
  succeed(d.putAndInsertString(DcmTag(group, 0x0010, EVR_LO), creator));
  succeed(d.putAndInsertString(DcmTag(group, element, vr), value));
}

// --- Which images belong together ------------------------------------------------------------------------------------

TEST(OddSeries, OneUidForTwoPatientsIsTwoSeries) {
  const TestFolder folder;
  for (const char* patient : {"A", "B"}) {
    fs::create_directory(folder / patient);
    write_stack(folder / patient, 3,
                [&](int, TestImage& image) { image.edit = [&](DcmDataset& d) { put(d, DCM_PatientID, patient); }; });
  }
  const Catalogue found = find_in(folder);
  ASSERT_THAT(found.series, SizeIs(2));
  for (const Series& series : found.series) {
    EXPECT_EQ(series.geometry.dimensions.z, 3);
    EXPECT_EQ(series.frames_per_position, 1);
  }
}

TEST(OddSeries, PlacesInTwoFramesOfReferenceAreNotComparedSoThatTheyAreTwoSeries) {
  const TestFolder folder;
  for (const char* frame : {"1.2.1", "1.2.2"}) {
    fs::create_directory(folder / frame);
    write_stack(folder / frame, 3, [&](int, TestImage& image) {
      image.edit = [&](DcmDataset& d) { put(d, DCM_FrameOfReferenceUID, frame); };
    });
  }
  const Catalogue found = find_in(folder);
  ASSERT_THAT(found.series, SizeIs(2));
  EXPECT_EQ(found.series[0].frames_per_position, 1);
}

TEST(OddSeries, WithoutASeriesUidAFolderIsASeries) {
  const TestFolder folder;
  for (const char* part : {"A", "B"}) {
    fs::create_directory(folder / part);
    write_stack(folder / part, 3, [](int, TestImage& image) { image.series = ""; });
  }
  const Catalogue found = find_in(folder);
  ASSERT_THAT(found.series, SizeIs(2));
  for (const Series& series : found.series) EXPECT_EQ(series.frames_per_position, 1);
}

TEST(OddSeries, WithoutASeriesUidEachDescriptionInAFolderIsASeries) {
  const TestFolder folder;
  for (const char* described : {"soft", "sharp", ""}) {
    for (int k = 0; k < 3; ++k) {
      TestImage image;
      image.series = "";
      image.z = 2.0 * k;
      image.edit = [=](DcmDataset& d) { put(d, DCM_SeriesDescription, described); };
      write(image, folder / (std::string(described) + std::to_string(k)));
    }
  }
  const Catalogue found = find_in(folder);
  ASSERT_THAT(found.series, SizeIs(3));
  for (const Series& series : found.series) {
    EXPECT_EQ(series.frames_per_position, 1) << series.description;
    EXPECT_THAT(series.files, SizeIs(3));
    for (const fs::path& file : series.files) {
      const std::string name = file.filename().string();
      EXPECT_EQ(name.substr(0, name.size() - 1), series.description);
    }
  }
}

TEST(OddSeries, OneInstanceUidForAllSlicesLosesNone) {
  const TestFolder folder;
  write_stack(folder.path(), 5, [](int, TestImage& image) { image.instance = "1.2.3.4.5"; });
  const Catalogue found = find_in(folder);
  EXPECT_THAT(found.skipped, IsEmpty());
  EXPECT_EQ(found.series.at(0).geometry.dimensions.z, 5);
  EXPECT_THAT(found.series[0].warnings, Contains(HasSubstr("one SOP instance UID")));
}

TEST(OddSeries, CopyThatWasNumberedAnewIsACopy) {
  const TestFolder folder;
  for (const int first : {0, 100}) {
    fs::create_directory(folder / std::to_string(first));
    write_stack(folder / std::to_string(first), 3, [=](int k, TestImage& image) {
      image.instance = numbered("1.2.7.", k);
      image.edit = [=](DcmDataset& d) { put(d, DCM_InstanceNumber, std::to_string(first + k)); };
    });
  }
  const Catalogue found = find_in(folder);
  EXPECT_THAT(found.skipped, SizeIs(3));
  EXPECT_EQ(found.series.at(0).frames_per_position, 1);
}

// An anonymiser that gives all images one UID and removes their times: two time points remain two.
TEST(OddSeries, OneInstanceUidForAllTimesLosesNone) {
  const TestFolder folder;
  for (int n = 0; n < 8; ++n) {
    TestImage image;
    image.z = 2.0 * (n % 4);
    image.instance = "1.2.3.4.5";
    image.value = [n](int, int) { return n / 4; };
    image.edit = [n](DcmDataset& d) { put(d, DCM_InstanceNumber, std::to_string(n + 1)); };
    write(image, folder / std::to_string(n));
  }
  const Series series = find_in(folder).series.at(0);
  ASSERT_EQ(series.frames_per_position, 2);
  for (const int frame : {0, 1}) EXPECT_EQ(load_frame(series, frame).value_at(1, 1, 3), frame);
}

TEST(OddSeries, CopyWithOtherPixelsIsSaidToBeOne) {
  for (const E_TransferSyntax syntax : {EXS_LittleEndianExplicit, EXS_BigEndianExplicit}) {
    const TestFolder folder;
    const auto with_instance = [&](int k, TestImage& image) {
      image.instance = numbered("1.2.7.", k);
      image.syntax = syntax;
    };
    write_stack(folder.path(), 3, with_instance);
    fs::create_directory(folder / "t");
    write_stack(folder / "t", 3, [&](int k, TestImage& image) {
      with_instance(k, image);
      if (k == 1) image.value = [](int, int) { return 7; };
    });
    const Catalogue found = find_in(folder);
    const Series& series = found.series.at(0);
    EXPECT_THAT(found.skipped, SizeIs(3));
    EXPECT_THAT(series.warnings, Contains(HasSubstr("with other pixels")).Times(1));
    EXPECT_EQ(load(series).value_at(3, 2, 1), 132);  // of the first in the order of names
  }
}

// Of two files of one image that differ, the first in the order of names is read, and the series says so.
TEST(OddSeries, OfTwoCopiesTheOneThatIsUsedIsNamedAsUsed) {
  struct Copy {
    std::string name, used, left;
    int value;
  };
  for (const Copy& copy : {Copy{"a.dcm", "a.dcm", "s1.dcm", 7}, {"z.dcm", "s1.dcm", "z.dcm", 132}}) {
    const TestFolder folder;
    write_stack(folder.path(), 3, [](int k, TestImage& image) { image.instance = numbered("1.2.7.", k); });
    TestImage other;
    other.z = 2;
    other.instance = "1.2.7.1";
    other.value = [](int, int) { return 7; };
    write(other, folder / copy.name);
    const Catalogue found = find_in(folder);
    ASSERT_THAT(found.skipped, SizeIs(1));
    EXPECT_EQ(found.skipped[0].path.filename(), copy.left);
    const Series& series = found.series.at(0);
    EXPECT_THAT(series.warnings, Contains(HasSubstr(copy.used + " is used and not " + copy.left + ",")));
    EXPECT_EQ(load(series).value_at(3, 2, 1), copy.value);
  }
}

// --- Frames ----------------------------------------------------------------------------------------------------------

TEST(OddSeries, DiffusionWeightingOfAPrivateAttributeNamesFrames) {
  struct Vendor {
    const char* name;
    std::function<void(DcmDataset&, int)> put;
  };
  const std::array vendors{
      Vendor{"Siemens",
             [](DcmDataset& d, int b) {
               put_private(d, 0x0019, "SIEMENS MR HEADER", 0x100C, EVR_IS, std::to_string(b).c_str());
             }},
      Vendor{"GE",
             [](DcmDataset& d, int b) {
               put_private(d, 0x0043, "GEMS_PARM_01", 0x1039, EVR_IS,
                           (std::to_string(b > 0 ? 1000000000 + b : 0) + "\\8\\0\\0").c_str());
             }},
      Vendor{"Philips", [](DcmDataset& d, int b) {
               put_private(d, 0x2001, "Philips Imaging DD 001", 0x1003, EVR_FL, std::to_string(b).c_str());
             }}};
  for (const Vendor& vendor : vendors) {
    for (const E_TransferSyntax syntax : {EXS_LittleEndianExplicit, EXS_LittleEndianImplicit}) {
      const TestFolder folder;
      for (int n = 0; n < 8; ++n) {  // the largest weighting first, and every slice has its turn
        TestImage image;
        const int b = n % 2 == 0 ? 800 : 0;
        image.z = 2.0 * (n / 2);
        image.syntax = syntax;
        image.value = [b](int, int) { return b; };
        image.edit = [&](DcmDataset& d) { vendor.put(d, b); };
        write(image, folder / std::to_string(n));
      }
      const Series series = find_in(folder).series.at(0);
      ASSERT_THAT(series.frame_names, ElementsAre("b = 0 s/mm2", "b = 800 s/mm2")) << vendor.name << " " << syntax;
      EXPECT_EQ(load_frame(series, 1).value_at(0, 0, 3), 800);
    }
  }
}

// Interleaved acquisitions number their passes; together with the echo that would halve every volume.
TEST(OddSeries, NumbersThatAlternateDoNotDivideFrames) {
  const TestFolder folder;
  for (int n = 0; n < 12; ++n) {
    TestImage image;
    const int k = n / 2;
    const int echo = n % 2;
    image.z = 2.0 * k;
    image.edit = [&](DcmDataset& d) {
      put(d, DCM_EchoTime, echo == 0 ? "5" : "10");
      put(d, DCM_AcquisitionNumber, std::to_string(1 + (k + echo) % 2));
    };
    write(image, folder / std::to_string(n));
  }
  const Series series = find_in(folder).series.at(0);
  EXPECT_THAT(series.frame_names, ElementsAre("echo time 5 ms", "echo time 10 ms"));
  EXPECT_EQ(series.geometry.dimensions.z, 6);
  EXPECT_THAT(series.geometry.gaps, IsEmpty());
}

TEST(OddSeries, TwoLabelsDivideTogether) {
  const TestFolder folder;
  for (int n = 0; n < 12; ++n) {
    TestImage image;
    image.z = 2.0 * (n / 4);
    image.value = [n](int, int) { return n; };
    image.edit = [&](DcmDataset& d) {
      put(d, DCM_EchoTime, n % 2 == 0 ? "5" : "10");
      put(d, DCM_TemporalPositionIdentifier, n / 2 % 2 == 0 ? "1" : "2");
    };
    write(image, folder / std::to_string(n));
  }
  const Series series = only_series_in(folder);
  ASSERT_EQ(series.frames_per_position, 4);
  EXPECT_THAT(series.frame_names, ElementsAre("echo time 5 ms, time point 1", "echo time 5 ms, time point 2",
                                              "echo time 10 ms, time point 1", "echo time 10 ms, time point 2"));
  for (int frame = 0; frame < 4; ++frame) {
    EXPECT_EQ(load_frame(series, frame).value_at(0, 0, 0), frame / 2 + 2 * (frame % 2)) << frame;
  }
}

// Magnitude and phase, trigger times that grow from slice to slice, no temporal position, numbers that repeat.
TEST(OddSeries, MagnitudeAndPhaseOfACineAreFrames) {
  const TestFolder folder;
  for (int n = 0; n < 24; ++n) {
    const int k = n / 6;
    const int time = n / 2 % 3;
    const bool phase = n % 2 == 1;
    TestImage image;
    image.z = 8.0 * k;
    image.value = [=](int, int) { return 100 * static_cast<int>(phase) + 10 * time + k; };
    image.edit = [=](DcmDataset& d) {
      put(d, DCM_Modality, "MR");
      put(d, DCM_ImageType, phase ? "DERIVED\\PRIMARY\\P\\ND" : "ORIGINAL\\PRIMARY\\M\\ND");
      put(d, DCM_TriggerTime, std::to_string(30 * time + 0.5 * k));
      put(d, DCM_AcquisitionTime, std::to_string(100000 + 100 * k + 10 * time));
      put(d, DCM_InstanceNumber, std::to_string(k + 1));
    };
    write(image, folder / numbered("i", 90 - n));
  }
  const Series series = find_in(folder).series.at(0);
  ASSERT_EQ(series.frames_per_position, 6);
  for (int k = 0; k < 4; ++k) {
    for (int time = 0; time < 3; ++time) {
      EXPECT_EQ(load_frame(series, time).value_at(1, 1, k) + load_frame(series, 3 + time).value_at(1, 1, k),
                100 + 2 * (10 * time + k));
    }
  }
}

TEST(OddSeries, EnhancedFilesOfOneFrameEachAreAVolume) {
  const TestFolder folder;
  for (int k = 0; k < 4; ++k) {
    TestImage image;
    image.value = [k](int, int) { return k; };
    image.edit = [k](DcmDataset& d) { make_multi_frame(d, {3.0 * k}); };
    write(image, folder / std::to_string(9 - k));
  }
  const Volume volume = load(find_in(folder).series.at(0));
  ASSERT_EQ(volume.geometry.dimensions.z, 4);
  for (int k = 0; k < 4; ++k) EXPECT_EQ(volume.value_at(0, 0, k), k);
}

TEST(OddSeries, FramesThatAreNotDescribedAreLeftOutWithAWord) {
  const TestFolder folder;
  TestImage image;
  image.edit = [](DcmDataset& d) {
    repeat_pixels(d, 5);
    make_multi_frame(d, {0, 2, 4});
    put(d, DCM_NumberOfFrames, "5");
  };
  write(image, folder / "enhanced");
  const Series series = find_in(folder).series.at(0);
  EXPECT_EQ(series.geometry.dimensions.z, 3);
  EXPECT_THAT(series.warnings, ElementsAre(HasSubstr("3 of its 5 frames")));
}

// One time of a series came damaged: that time is left out, whichever it is.
TEST(OddSeries, DamagedTimePointCostsThatTimePoint) {
  for (const int damaged : {0, 2, 4}) {
    for (const int readable : {0, 1}) {
      const TestFolder folder;
      for (int n = 0; n < 20; ++n) {
        const int time = n / 4;
        TestImage image;
        image.z = 2.0 * (n % 4);
        image.value = [n](int i, int) { return 100 * n + i; };
        image.edit = [time](DcmDataset& d) { put(d, DCM_TemporalPositionIdentifier, std::to_string(1 + time)); };
        const fs::path path = folder / std::to_string(n);
        write(image, path);
        if (time == damaged && n % 4 >= readable) fs::resize_file(path, fs::file_size(path) - 20);
      }
      const Series series = find_in(folder).series.at(0);
      EXPECT_TRUE(series.usable);
      ASSERT_EQ(series.frames_per_position, 4) << damaged;
      EXPECT_THAT(series.warnings,
                  Contains("time point " + std::to_string(damaged + 1) + " is left out: " + std::to_string(readable) +
                           " of its 4 images can be read; the other frames are numbered anew"));
      for (int frame = 0; frame < 4; ++frame) {
        const int time = frame < damaged ? frame : frame + 1;
        EXPECT_EQ(series.frame_names.at(static_cast<std::size_t>(frame)), "time point " + std::to_string(time + 1));
        const Volume volume = load_frame(series, frame);
        ASSERT_EQ(volume.geometry.dimensions.z, 4);
        for (int k = 0; k < 4; ++k) EXPECT_EQ(volume.value_at(5, 1, k), 100 * (4 * time + k) + 5);
      }
    }
  }
}

// Anonymizers that give every file a study or a frame of reference of its own leave the places: they are one stack.
TEST(OddSeries, FilesThatWereTornApartByTheirUidsAreOneStack) {
  const std::array<std::pair<DcmTagKey, const char*>, 2> uids{
      {{DCM_StudyInstanceUID, "each of its files names another study: they are read as one"},
       {DCM_FrameOfReferenceUID, "each of its files names another frame of reference: they are read as one"}}};
  for (const auto& [tag, told] : uids) {
    for (const bool same_place : {false, true}) {
      const TestFolder folder;
      write_stack(folder.path(), 5, [&, key = tag](int k, TestImage& image) {
        if (same_place) image.z = 0;
        image.edit = [=](DcmDataset& d) { put(d, key, numbered("1.2.77.", k)); };
      });
      const Catalogue found = find_in(folder);
      const auto usable = std::ranges::count_if(found.series, [](const Series& s) { return s.usable; });
      EXPECT_EQ(usable, same_place ? 0 : 1);
      if (same_place) continue;
      EXPECT_EQ(found.series.at(0).geometry.dimensions.z, 5);
      EXPECT_THAT(found.series[0].warnings, Contains(told));
      EXPECT_EQ(load(found.series[0]).value_at(1, 1, 4), 411);
    }
  }
}

}  // namespace
}  // namespace palpate::io::internal

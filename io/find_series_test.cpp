#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcdict.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <clocale>
#include <cstdlib>
#include <fstream>

#include "palpate/io/errors.h"
#include "palpate/io/internal/dcmtk_start.h"
#include "palpate/io/internal/test_image.h"
#include "palpate/io/load.h"
#include "palpate/io/series.h"

namespace palpate::io {
namespace {

using internal::put;
using internal::TestFolder;
using internal::TestImage;
using internal::write;
using internal::write_stack;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

Catalogue find_in(const TestFolder& folder) {
  return find_series(std::array{folder.path()});
}

Volume load_frame(const Series& series, int frame) {
  LoadOptions options;
  options.frame = frame;
  return load(series, options);
}

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
    write(image, folder / internal::numbered("f", 97 - n));
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
      internal::make_multi_frame(d, heights[file]);
      internal::repeat_pixels(d, heights[file].size());
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
  write_stack(folder.path(), 3, [](int k, TestImage& image) { image.instance = internal::numbered("1.2.7.", k); });
  std::filesystem::copy_file(folder / "s1.dcm", folder / "a_cut.dcm");  // before s1.dcm in any order of names
  std::filesystem::resize_file(folder / "a_cut.dcm", std::filesystem::file_size(folder / "a_cut.dcm") - 10);
  const Catalogue found = find_in(folder);
  EXPECT_EQ(found.series.at(0).geometry.dimensions.z, 3);
  EXPECT_THAT(found.series[0].geometry.gaps, IsEmpty());
  ASSERT_THAT(found.skipped, SizeIs(1));
  EXPECT_EQ(found.skipped[0].path.filename(), "a_cut.dcm");
}

struct Unfit {
  const char* name;
  std::function<void(DcmDataset&)> edit;
  const char* reason;
};

TEST(FindSeries, WhatCannotBeFeltIsRefusedWithAReason) {
  const std::array cases{
      Unfit{"colour",
            [](DcmDataset& d) { put(d, DCM_SamplesPerPixel, 3), put(d, DCM_PhotometricInterpretation, "RGB"); },
            "colour"},
      Unfit{"unplaced", [](DcmDataset& d) { internal::succeed(d.findAndDeleteElement(DCM_ImagePositionPatient)); },
            "no position"},
      Unfit{"no spacing", [](DcmDataset& d) { put(d, DCM_PixelSpacing, "0\\0"); }, "no position"},
      Unfit{"not a number", [](DcmDataset& d) { put(d, DCM_ImagePositionPatient, "0\\0\\here"); }, "no position"},
      Unfit{"bad axes", [](DcmDataset& d) { put(d, DCM_ImageOrientationPatient, "1\\0\\0\\1\\0\\0"); }, "no position"},
      Unfit{"32 bits", [](DcmDataset& d) { put(d, DCM_BitsAllocated, 32), put(d, DCM_BitsStored, 32); }, "32 bits"},
      Unfit{"look-up table",
            [](DcmDataset& d) {
              DcmItem* item = nullptr;
              internal::succeed(d.findOrCreateSequenceItem(DCM_ModalityLUTSequence, item, 0));
              internal::succeed(item->putAndInsertString(DCM_ModalityLUTType, "HU"));
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

TEST(FindSeries, DescriptionBecomesUtf8) {
  const std::array<std::array<std::string, 3>, 7> cases{
      {{"ISO_IR 100", "T\xEAte", "T\xC3\xAAte"},
       {"ISO_IR 192", "\xE9\xA0\xAD", "\xE9\xA0\xAD"},
       {"ISO_IR 144", "\xB3\xDE\xDB\xDE\xD2\xD0", "Голова"},
       {"\\ISO 2022 IR 87", "\x1B$B;3ED\x1B(B^\x1B$BB@O:\x1B(B", "山田^太郎"},
       {"ISO 2022 IR 13\\ISO 2022 IR 87", "\xD4\xCF\xC0\xDE=\x1B$B;3ED\x1B(J", "ﾔﾏﾀﾞ=山田"},
       {"GB18030", "\xCD\xF5\xD0\xA1\xB6\xAB", "王小东"},
       {"", "T\xEAte", "T\xC3\xAAte"}}};
  for (const auto& texts : cases) {  // character set, as stored, expected
    const TestFolder folder;
    write_stack(folder.path(), 2, [&](int, TestImage& image) {
      image.edit = [&](DcmDataset& d) {
        if (!texts[0].empty()) put(d, DCM_SpecificCharacterSet, texts[0]);
        put(d, DCM_SeriesDescription, texts[1]);
        put(d, DCM_PatientName, texts[1]);
      };
    });
    const Series series = find_in(folder).series.at(0);
    EXPECT_EQ(series.description, texts[2]) << texts[0];
    EXPECT_EQ(series.identity.patient_name, texts[2]) << texts[0];
  }
}

// A host program may run in a country that writes 0,75: neither attributes nor words may change.
TEST(FindSeries, DecimalCommaOfTheLocaleChangesNothing) {
  const TestFolder folder;
  write_stack(folder.path(), 6, [](int k, TestImage& image) {
    image.z = k == 5 ? 13.75 : 2.25 * k;
    image.edit = [](DcmDataset& d) { put(d, DCM_RescaleIntercept, "-0.5"); };
  });
  const Series before = find_in(folder).series.at(0);
  const TestFolder locales;
  const std::string make = "localedef -i de_DE -f UTF-8 " + (locales / "de_DE.UTF-8").string() + " >/dev/null 2>&1";
  if (std::system(make.c_str()) != 0)
    GTEST_SKIP()
        << "needs a locale that writes 0,75, and localedef (Debian's locales) cannot make de_DE here";  // NOLINT(cert-env33-c)
  ::setenv("LOCPATH", locales.path().c_str(), 1);
  if (std::setlocale(LC_ALL, "de_DE.UTF-8") == nullptr)
    GTEST_SKIP() << "needs a locale that writes 0,75, and setlocale() does not take de_DE here";
  ASSERT_STREQ(std::localeconv()->decimal_point, ",");
  const Series after = find_in(folder).series.at(0);
  std::setlocale(LC_ALL, "C");
  ::unsetenv("LOCPATH");
  EXPECT_EQ(after.geometry.spacing_i, 0.75);
  EXPECT_EQ(after.geometry.slice_positions, before.geometry.slice_positions);
  ASSERT_THAT(before.warnings, SizeIs(1));
  EXPECT_EQ(after.warnings, before.warnings);
}

TEST(FindSeries, DicomdirStandsForItsFolder) {
  const TestFolder folder;
  write_stack(folder.path(), 3);
  std::ofstream(folder / "DICOMDIR") << "whatever it says";
  EXPECT_EQ(find_series(std::array{folder / "DICOMDIR"}).series.at(0).geometry.dimensions.z, 3);
}

TEST(FindSeries, CancelledHalfWayLeavesNothingRunning) {
  const TestFolder folder;
  write_stack(folder.path(), 40);
  const Series series = find_in(folder).series.at(0);
  for (const double stop_at : {0.0, 0.2, 0.9}) {
    LoadOptions options;
    int later = 0;
    bool stopped = false;
    options.progress = [&](double done) {
      later += stopped;
      stopped = stopped || done >= stop_at;
      return !stopped;
    };
    EXPECT_THROW(load(series, options), Cancelled);
    EXPECT_EQ(later, 0) << "called again after it said no";
  }
}

TEST(FindSeries, MissingDataDictionaryIsRefusedByName) {
  EXPECT_NO_THROW(internal::start_dcmtk());
  DcmDataDictionary empty(OFFalse, OFFalse);
  empty.clear();
  for (const bool loaded : {false, true}) {
    try {
      internal::check_dictionary(empty, loaded);
      FAIL();
    } catch (const DicomError& error) {
      EXPECT_THAT(error.what(), HasSubstr("DCMDICTPATH"));
    }
  }
}

TEST(FindSeries, NamesWhatDoesNotExist) {
  const TestFolder folder;
  try {
    find_series(std::array{folder / "absent"});
    FAIL();
  } catch (const DicomError& error) {
    EXPECT_THAT(error.what(), HasSubstr("absent"));
  }
}

TEST(FindSeries, CanBeCancelledAndReportsProgress) {
  const TestFolder folder;
  write_stack(folder.path(), 8);
  EXPECT_THROW(find_series(std::array{folder.path()}, [](double) { return false; }), Cancelled);
  std::vector<double> reported;
  const Catalogue found = find_series(std::array{folder.path()}, [&](double done) {
    reported.push_back(done);
    return true;
  });
  EXPECT_TRUE(std::is_sorted(reported.begin(), reported.end()));
  LoadOptions options;
  options.progress = [](double) { return false; };
  EXPECT_THROW(load(found.series.at(0), options), Cancelled);
}

TEST(FindSeries, EveryFileOfAForeignFolderIsNamed) {
  const TestFolder folder;
  std::ofstream(folder / "empty");
  std::ofstream(folder / "text.dcm") << "ISO_IR looks like nothing";
  std::ofstream(folder / "short") << "DICM";
  const Catalogue found = find_in(folder);
  EXPECT_THAT(found.series, IsEmpty());
  EXPECT_THAT(found.skipped, SizeIs(3));
}

}  // namespace
}  // namespace palpate::io

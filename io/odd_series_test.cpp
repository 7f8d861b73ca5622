// What scanners, archives and anonymisers do that is legal or common, and that a reader may get wrong without a word.
#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcfilefo.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <fstream>

#include "palpate/io/errors.h"
#include "palpate/io/internal/test_image.h"
#include "palpate/io/load.h"

namespace palpate::io {
namespace {

namespace fs = std::filesystem;
using internal::put;
using internal::TestFolder;
using internal::TestImage;
using internal::write;
using internal::write_stack;
using testing::Contains;
using testing::Each;
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

std::string only_reason(const Catalogue& found) {
  EXPECT_THAT(found.series, IsEmpty());
  EXPECT_THAT(found.skipped, SizeIs(1));
  return found.skipped.empty() ? "" : found.skipped[0].reason;
}

void put_private(DcmDataset& d, Uint16 group, const char* creator, Uint16 element, DcmEVR vr, const char* value) {
  internal::succeed(d.putAndInsertString(DcmTag(group, 0x0010, EVR_LO), creator));
  internal::succeed(d.putAndInsertString(DcmTag(group, element, vr), value));
}

// --- Rescale ---------------------------------------------------------------------------------------------------------

TEST(OddSeries, RescaleThatIsNoNumberIsRefusedAndNotTakenForNone) {
  for (const char* slope : {"0,5", "two", "0"}) {
    const TestFolder folder;
    TestImage image;
    image.edit = [&](DcmDataset& d) { put(d, DCM_RescaleSlope, slope); };
    write(image, folder / "image");
    EXPECT_THAT(only_reason(find_in(folder)), HasSubstr("rescale slope")) << slope;
  }
}

// As PET has it; the volume then holds what a voxel means, whatever slice it is in.
TEST(OddSeries, RescaleOfItsOwnForEverySlice) {
  const TestFolder folder;
  write_stack(folder.path(), 4, [](int k, TestImage& image) {
    image.edit = [k](DcmDataset& d) {
      put(d, DCM_Modality, "PT");
      put(d, DCM_RescaleSlope, std::to_string(0.5 * (k + 1)));
      put(d, DCM_RescaleIntercept, "0");
    };
  });
  const Series series = find_in(folder).series.at(0);
  EXPECT_EQ(series.unit, "");
  const Volume volume = load(series);
  for (int k = 0; k < 4; ++k) EXPECT_EQ(volume.value_at(3, 2, k), 0.5 * (k + 1) * (100 * k + 32));
}

TEST(OddSeries, CtIsInHounsfieldUnitsOnlyWhereItSaysSo) {
  struct Case {
    const char* intercept;
    const char* type;
    const char* unit;
  };
  for (const Case& is :
       {Case{"-1024", "HU", "HU"}, Case{"-1024", "", "HU"}, Case{"-1024", "MGML", ""}, Case{"", "", ""}}) {
    const TestFolder folder;
    write_stack(folder.path(), 2, [&](int, TestImage& image) {
      image.edit = [&](DcmDataset& d) {
        if (*is.intercept != '\0') put(d, DCM_RescaleIntercept, is.intercept);
        if (*is.type != '\0') put(d, DCM_RescaleType, is.type);
      };
    });
    const Series series = find_in(folder).series.at(0);
    EXPECT_EQ(series.unit, is.unit) << is.intercept << is.type;
    EXPECT_EQ(series.warnings.size(), *is.unit == '\0' ? 1U : 0U);
    EXPECT_THAT(series.warnings, Each(HasSubstr("Hounsfield")));
  }
}

TEST(OddSeries, EnhancedFramesEachHaveTheirRescale) {
  const TestFolder folder;
  TestImage image;
  image.edit = [](DcmDataset& d) {
    internal::repeat_pixels(d, 3);
    internal::make_multi_frame(d, {0, 2, 4}, [](std::size_t n, DcmItem& frame) {
      DcmItem& rescale = internal::group(frame, DCM_PixelValueTransformationSequence);
      internal::succeed(rescale.putAndInsertString(DCM_RescaleSlope, std::to_string(n + 1).c_str()));
      internal::succeed(rescale.putAndInsertString(DCM_RescaleIntercept, "-7"));
    });
  };
  write(image, folder / "enhanced");
  const Volume volume = load(find_in(folder).series.at(0));
  for (int k = 0; k < 3; ++k) EXPECT_EQ(volume.value_at(3, 2, k), (k + 1) * 32 - 7);
}

// --- Pixels ----------------------------------------------------------------------------------------------------------

TEST(OddSeries, PaddingOutsideTheStoredBitsIsNoTissue) {
  for (const bool is_signed : {true, false}) {
    const TestFolder folder;
    write_stack(folder.path(), 2, [&](int, TestImage& image) {
      image.value = [](int i, int) { return i == 0 ? 0x8000 : 0xA000 | i; };  // above bit 11 there is an overlay
      image.edit = [&](DcmDataset& d) {
        put(d, DCM_BitsStored, 12);
        put(d, DCM_HighBit, 11);
        put(d, DCM_PixelRepresentation, is_signed ? 1 : 0);
        is_signed ? internal::succeed(d.putAndInsertSint16(DcmTag(DCM_PixelPaddingValue, EVR_SS), -32768))
                  : put(d, DCM_PixelPaddingValue, 0x8000);
      };
    });
    const Volume volume = load(find_in(folder).series.at(0));
    for (int i = 0; i < 6; ++i) {
      EXPECT_EQ(volume.is_padding(i, 1, 1), i == 0);
      EXPECT_EQ(volume.value_at(i, 1, 1), i > 0 ? i : is_signed ? -32768 : 32768);
    }
  }
}

TEST(OddSeries, PaddingRangeHoldsBothItsEnds) {
  const TestFolder folder;
  write_stack(folder.path(), 2, [](int, TestImage& image) {
    image.value = [](int i, int) { return 1000 + i; };
    image.edit = [](DcmDataset& d) {
      put(d, DCM_PixelPaddingValue, 1003);  // the limit may be below the value or above it
      put(d, DCM_PixelPaddingRangeLimit, 1001);
    };
  });
  const Volume volume = load(find_in(folder).series.at(0));
  for (int i = 0; i < 6; ++i) EXPECT_EQ(volume.is_padding(i, 0, 0), i >= 1 && i <= 3);
}

TEST(OddSeries, EightSignedBits) {
  const TestFolder folder;
  write_stack(folder.path(), 2, [](int, TestImage& image) {
    image.edit = [](DcmDataset& d) {
      put(d, DCM_BitsAllocated, 8);
      put(d, DCM_BitsStored, 8);
      put(d, DCM_HighBit, 7);
      put(d, DCM_PixelRepresentation, 1);
      std::array<Uint8, 24> pixels{};
      for (std::size_t n = 0; n < pixels.size(); ++n) pixels[n] = static_cast<Uint8>(10 * static_cast<int>(n) - 120);
      internal::succeed(d.putAndInsertUint8Array(DCM_PixelData, pixels.data(), pixels.size()));
    };
  });
  const Volume volume = load(find_in(folder).series.at(0));
  for (int n = 0; n < 24; ++n) EXPECT_EQ(volume.value_at(n % 6, n / 6, 1), 10 * n - 120);
}

TEST(OddSeries, Monochrome1ChangesNoValueAtAnyDepth) {
  for (const int bits : {8, 12, 16}) {
    const TestFolder folder;
    write_stack(folder.path(), 2, [&](int, TestImage& image) {
      image.edit = [&](DcmDataset& d) {
        put(d, DCM_PhotometricInterpretation, "MONOCHROME1");
        put(d, DCM_BitsStored, bits);
        put(d, DCM_HighBit, bits - 1);
        put(d, DCM_RescaleIntercept, "-20");
      };
    });
    EXPECT_EQ(load(find_in(folder).series.at(0)).value_at(3, 2, 0), 32 - 20) << bits;
  }
}

TEST(OddSeries, PixelsThatCannotBeReadAreNamed) {
  struct Case {
    const char* reason;
    std::function<void(DcmDataset&)> edit;
  };
  const auto colours = [](const char* name) {
    return [name](DcmDataset& d) { put(d, DCM_PhotometricInterpretation, name); };
  };
  const std::array cases{
      Case{"colour image (PALETTE COLOR)", colours("PALETTE COLOR")},
      Case{"colour image (YBR_FULL_422)", colours("YBR_FULL_422")},
      Case{"12 bits in 12", [](DcmDataset& d) { put(d, DCM_BitsAllocated, 12), put(d, DCM_BitsStored, 12); }},
      Case{"highest of them bit 3", [](DcmDataset& d) { put(d, DCM_HighBit, 3); }},
      Case{"floating-point", [](DcmDataset& d) {
             internal::succeed(d.findAndDeleteElement(DCM_PixelData));
             const std::array<Float32, 24> pixels{};
             internal::succeed(
                 d.putAndInsertFloat32Array(DcmTag(0x7FE0, 0x0008, EVR_OF), pixels.data(), pixels.size()));
           }}};
  for (const Case& pixels : cases) {
    const TestFolder folder;
    TestImage image;
    image.edit = pixels.edit;
    write(image, folder / "image");
    const Catalogue found = find_in(folder);
    EXPECT_THAT(only_reason(found), HasSubstr(pixels.reason));
    EXPECT_EQ(found.skipped.at(0).path, folder / "image");
  }
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
      image.instance = internal::numbered("1.2.7.", k);
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
      image.instance = internal::numbered("1.2.7.", k);
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
    write(image, folder / internal::numbered("i", 90 - n));
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
    image.edit = [k](DcmDataset& d) { internal::make_multi_frame(d, {3.0 * k}); };
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
    internal::repeat_pixels(d, 5);
    internal::make_multi_frame(d, {0, 2, 4});
    put(d, DCM_NumberOfFrames, "5");
  };
  write(image, folder / "enhanced");
  const Series series = find_in(folder).series.at(0);
  EXPECT_EQ(series.geometry.dimensions.z, 3);
  EXPECT_THAT(series.warnings, ElementsAre(HasSubstr("3 of its 5 frames")));
}

// --- Places ----------------------------------------------------------------------------------------------------------

TEST(OddSeries, PositionsThatJitterAreOneStackOfFrames) {
  const TestFolder folder;
  for (int n = 0; n < 12; ++n) {
    TestImage image;
    image.z = 2.0 * (n % 6) + 1e-3 * ((n * 7) % 5 - 2);
    image.edit = [n](DcmDataset& d) {
      put(d, DCM_TemporalPositionIdentifier, std::to_string(1 + n / 6));
      put(d, DCM_SpacingBetweenSlices, "5");  // which is not so
      put(d, DCM_SliceThickness, "9");
    };
    write(image, folder / std::to_string(n));
  }
  const Series series = find_in(folder).series.at(0);
  EXPECT_EQ(series.frames_per_position, 2);
  EXPECT_TRUE(series.geometry.uniform);
  EXPECT_THAT(series.geometry.gaps, IsEmpty());
  EXPECT_NEAR(series.geometry.slice_spacing(), 2, 1e-3);
}

TEST(OddSeries, SlicesDisplacedSidewaysAreUsedWhereTheyAre) {
  const TestFolder folder;
  write_stack(folder.path(), 6, [](int k, TestImage& image) {
    image.edit = [k](DcmDataset& d) {
      put(d, DCM_Modality, "MR");
      put(d, DCM_ImagePositionPatient, std::to_string(k % 2) + "\\0\\" + std::to_string(2 * k));
    };
  });
  const Series series = find_in(folder).series.at(0);
  EXPECT_THAT(series.warnings, ElementsAre(HasSubstr("displaced sideways")));
  const Vec3 at = load(series).geometry.to_index({1 + 3 * 0.75, 2 * 0.5, 6});
  EXPECT_NEAR(at.x, 3, 1e-9);
  EXPECT_NEAR(at.z, 3, 1e-9);
}

TEST(OddSeries, LocalizerOfThreeOrientationsIsNoVolume) {
  const TestFolder folder;
  const std::array orientations{"1\\0\\0\\0\\1\\0", "1\\0\\0\\0\\0\\-1", "0\\1\\0\\0\\0\\-1"};
  for (std::size_t o = 0; o < orientations.size(); ++o) {
    TestImage image;
    image.edit = [&](DcmDataset& d) {
      put(d, DCM_Modality, "MR");
      put(d, DCM_ImageOrientationPatient, orientations[o]);
    };
    write(image, folder / std::to_string(o));
  }
  const Catalogue found = find_in(folder);
  ASSERT_THAT(found.series, SizeIs(1));
  EXPECT_FALSE(found.series[0].usable);
  EXPECT_THAT(found.series[0].files, SizeIs(3));
}

TEST(OddSeries, ReformatsOfAnotherPixelSpacingAreAVolumeOfTheirOwn) {
  const TestFolder folder;
  write_stack(folder.path(), 4);
  fs::create_directory(folder / "fine");
  write_stack(folder / "fine", 3, [](int, TestImage& image) {
    image.edit = [](DcmDataset& d) { put(d, DCM_PixelSpacing, "0.25\\0.25"); };
  });
  const Catalogue found = find_in(folder);
  ASSERT_THAT(found.series, SizeIs(2));
  EXPECT_EQ(found.series[0].geometry.dimensions.z, 3);  // in the order of their files
  EXPECT_EQ(found.series[1].geometry.dimensions.z, 4);
}

// --- How files are written -------------------------------------------------------------------------------------------

void write_bare(const TestImage& image, const fs::path& path, E_TransferSyntax syntax, E_FileWriteMode mode,
                E_EncodingType lengths, E_GrpLenEncoding groups) {
  DcmFileFormat file;
  internal::fill(*file.getDataset(), image);
  DcmItem* item = nullptr;
  internal::succeed(file.getDataset()->findOrCreateSequenceItem(DCM_ReferencedImageSequence, item, -2));
  internal::succeed(item->putAndInsertString(DCM_ReferencedSOPInstanceUID, "1.2.3"));
  internal::succeed(file.saveFile(OFFilename(path.c_str()), syntax, lengths, groups, EPD_noChange, 0, 0, mode));
}

TEST(OddSeries, WithoutPreambleOrWithGroupLengthsAndOpenSequences) {
  for (const E_TransferSyntax syntax : {EXS_LittleEndianImplicit, EXS_LittleEndianExplicit, EXS_BigEndianExplicit}) {
    for (const E_FileWriteMode mode : {EWM_fileformat, EWM_dataset}) {
      for (const E_EncodingType lengths : {EET_ExplicitLength, EET_UndefinedLength}) {
        for (const E_GrpLenEncoding groups : {EGL_withoutGL, EGL_withGL}) {
          const TestFolder folder;
          for (int k = 0; k < 2; ++k) {
            TestImage image;
            image.z = 2.0 * k;
            write_bare(image, folder / std::to_string(k), syntax, mode, lengths, groups);
          }
          const Catalogue found = find_in(folder);
          ASSERT_THAT(found.series, SizeIs(1)) << syntax << " " << mode << " " << lengths << " " << groups;
          EXPECT_EQ(load(found.series[0]).value_at(3, 2, 1), 32);
        }
      }
    }
  }
}

std::string read_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// An archive that rewrites datasets and leaves what the meta information says of them.
TEST(OddSeries, DatasetWrittenOtherwiseThanItSaysIsRead) {
  const std::string explicit_uid = "1.2.840.10008.1.2.1";
  for (int k = 0; k < 2; ++k) {
    const TestFolder folder;
    for (const int slice : {0, 1}) {
      TestImage image;
      image.z = 2.0 * slice;
      image.syntax = EXS_LittleEndianExplicit;
      write(image, folder / "says");
      image.syntax = EXS_LittleEndianImplicit;
      write(image, folder / "is");
      std::array parts{read_file(folder / "says"), read_file(folder / "is")};
      fs::remove(folder / "says");
      fs::remove(folder / "is");
      if (k == 1) std::swap(parts[0], parts[1]);
      const auto meta_end = [](const std::string& bytes) { return bytes.find(std::string("\x08\0\x08\0", 4)); };
      std::ofstream(folder / ("s" + std::to_string(slice)), std::ios::binary)
          << parts[0].substr(0, meta_end(parts[0])) << parts[1].substr(meta_end(parts[1]));
    }
    EXPECT_EQ(load(find_in(folder).series.at(0)).value_at(3, 2, 1), 32);
  }
}

TEST(OddSeries, ValuesOfOddLengthAreRead) {
  const TestFolder folder;
  write_stack(folder.path(), 2);
  for (const int k : {0, 1}) {
    const fs::path path = folder / ("s" + std::to_string(k) + ".dcm");
    std::string bytes = read_file(path);
    const std::string padded("\x08\0\x60\0CS\x02\0CT", 10);
    const std::size_t at = bytes.find(padded);
    ASSERT_NE(at, std::string::npos);
    bytes.replace(at, padded.size(), std::string("\x08\0\x60\0CS\x03\0CT ", 11));
    std::ofstream(path, std::ios::binary) << bytes;
  }
  const Series series = find_in(folder).series.at(0);
  EXPECT_EQ(series.modality, "CT");
  EXPECT_EQ(load(series).value_at(3, 2, 1), 132);
}

}  // namespace
}  // namespace palpate::io

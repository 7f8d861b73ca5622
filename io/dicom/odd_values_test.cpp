// Legal or common habits of scanners, archives and anonymizers that a reader can get wrong silently: the values.
#include <dcmtk/config/osconfig.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <glm/geometric.hpp>
#include <tuple>
#include <utility>

#include "io/load.h"
#include "io/testing/test_image.h"

namespace palpate::io::internal {
namespace {

using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

std::string only_reason(const Catalogue& found) {
  EXPECT_THAT(found.series, IsEmpty());
  EXPECT_THAT(found.skipped, SizeIs(1));
  return found.skipped.empty() ? Text() : found.skipped[0].reason;
}

// --- Rescale ---------------------------------------------------------------------------------------------------------

TEST(OddValues, RescaleThatIsNoNumberIsRefusedAndNotTakenForNone) {
  for (const char* slope : {"0,5", "two", "0"}) {
    const TestFolder folder;
    TestImage image;
    image.edit = [&](DcmDataset& d) { put(d, DCM_RescaleSlope, slope); };
    write(image, folder / "image");
    EXPECT_THAT(only_reason(find_in(folder)), HasSubstr("rescale slope")) << slope;
  }
}

// PS3.5 6.2: a decimal string may begin with a sign, and may have an exponent.
TEST(OddValues, NumbersWithAPlusAreTheSameNumbers) {
  struct Written {
    const char *one, *half, *three_quarters, *two, *seven;
  };
  for (const Written& as : {Written{"1", "0.5", "0.75", "2", "7"},
                            {"+1", "+0.5", "+0.75", "+2", "+7"},
                            {" +1 ", "+.5", "+75E-2", "+0.2e+1", "+7.0E0"}}) {
    const TestFolder folder;
    write_stack(folder.path(), 3, [&](int k, TestImage& image) {
      image.edit = [&, k](DcmDataset& d) {
        const std::string one = as.one, two = as.two;
        put(d, DCM_ImagePositionPatient, one + "\\" + as.seven + "\\+" + std::to_string(2 * k));
        put(d, DCM_ImageOrientationPatient, one + "\\0\\+0\\-0\\" + one + "\\0");
        put(d, DCM_PixelSpacing, std::string(as.half) + "\\" + as.three_quarters);
        put(d, DCM_SliceThickness, two);
        put(d, DCM_RescaleSlope, two);
        put(d, DCM_RescaleIntercept, as.seven);
      };
    });
    const Volume volume = load(only_series_in(folder));
    EXPECT_EQ(volume.geometry.spacing_i, 0.75) << as.one;
    EXPECT_EQ(volume.geometry.spacing_j, 0.5);
    for (int k = 0; k < 3; ++k) {
      EXPECT_LT(glm::distance(volume.geometry.slice_positions.at(static_cast<std::size_t>(k)), Vec3(1, 7, 2 * k)),
                1e-9);
      EXPECT_EQ(volume.value_at(3, 2, k), 2 * (100 * k + 32) + 7);
    }
  }
}

// As PET has it; the volume then holds what a voxel means, whatever slice it is in.
TEST(OddValues, RescaleOfItsOwnForEverySlice) {
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

TEST(OddValues, CtIsInHounsfieldUnitsOnlyWhereItSaysSo) {
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

TEST(OddValues, EnhancedFramesEachHaveTheirRescale) {
  const TestFolder folder;
  TestImage image;
  image.edit = [](DcmDataset& d) {
    repeat_pixels(d, 3);
    make_multi_frame(d, {0, 2, 4}, [](std::size_t n, DcmItem& frame) {
      DcmItem& rescale = group(frame, DCM_PixelValueTransformationSequence);
      succeed(rescale.putAndInsertString(DCM_RescaleSlope, std::to_string(n + 1).c_str()));
      succeed(rescale.putAndInsertString(DCM_RescaleIntercept, "-7"));
    });
  };
  write(image, folder / "enhanced");
  const Volume volume = load(find_in(folder).series.at(0));
  for (int k = 0; k < 3; ++k) EXPECT_EQ(volume.value_at(3, 2, k), (k + 1) * 32 - 7);
}

// --- Pixels ----------------------------------------------------------------------------------------------------------

// The least and the most that are far from what 12 bits hold, and the next to it.
TEST(OddValues, PaddingOutsideTheStoredBitsIsNoTissue) {
  for (const auto& [is_signed, padding] : {std::pair{true, -32768}, {true, -2049}, {false, 0x8000}, {false, 0x1000}}) {
    const TestFolder folder;
    write_stack(folder.path(), 2, [&, is_signed = is_signed, padding = padding](int, TestImage& image) {
      image.value = [=](int i, int) { return i == 0 ? padding & 0xFFFF : 0xA000 | i; };  // above bit 11: an overlay
      image.edit = [=](DcmDataset& d) {
        put(d, DCM_BitsStored, 12);
        put(d, DCM_HighBit, 11);
        put(d, DCM_PixelRepresentation, is_signed ? 1 : 0);
        is_signed ? succeed(d.putAndInsertSint16(DcmTag(DCM_PixelPaddingValue, EVR_SS), static_cast<Sint16>(padding)))
                  : put(d, DCM_PixelPaddingValue, padding);
      };
    });
    const Volume volume = load(find_in(folder).series.at(0));
    for (int i = 0; i < 6; ++i) {
      EXPECT_EQ(volume.is_padding(i, 1, 1), i == 0) << padding;
      EXPECT_EQ(volume.value_at(i, 1, 1), i > 0 ? i : padding);
    }
  }
}

TEST(OddValues, WindowThatIsNoIntervalIsNone) {
  for (const auto& [level, width, is_one] : {std::tuple{"40", "400", true},
                                             {"40", "0", false},
                                             {"40", "-1", false},
                                             {"40", "1e999", false},
                                             {"1e999", "400", false},
                                             {"40", "", false}}) {
    const TestFolder folder;
    write_stack(folder.path(), 2, [&, level = level, width = width](int, TestImage& image) {
      image.edit = [=](DcmDataset& d) {
        put(d, DCM_WindowCenter, std::string(level));
        put(d, DCM_WindowWidth, std::string(width));
      };
    });
    EXPECT_EQ(only_series_in(folder).window.has_value(), is_one) << level << " " << width;
  }
}

TEST(OddValues, PaddingRangeHoldsBothItsEnds) {
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

/// What is padding in a stack whose stored values are -2..3 or 0..5, by how the padding is written.
std::vector<int> padding_in(const char* modality, bool is_signed, int value, int limit) {
  const TestFolder folder;
  const int least = is_signed ? -2 : 0;
  write_stack(folder.path(), 2, [=](int, TestImage& image) {
    image.value = [=](int i, int) { return least + i; };
    image.edit = [=](DcmDataset& d) {
      put(d, DCM_Modality, modality);
      put(d, DCM_PixelRepresentation, is_signed ? 1 : 0);
      // As US, whatever the pixels are: that is what is met.
      put(d, DCM_PixelPaddingValue, value & 0xFFFF);
      put(d, DCM_PixelPaddingRangeLimit, limit & 0xFFFF);
    };
  });
  const Volume volume = load(find_in(folder).series.at(0));
  std::vector<int> padding;
  for (int i = 0; i < 6; ++i) {
    if (volume.is_padding(i, 1, 1)) padding.push_back(least + i);
  }
  return padding;
}

// MR writes 0 where it means nothing by it; and what is above 32767 is below 0 if pixels are signed.
TEST(OddValues, PaddingIsWhatTheModalityMeansByIt) {
  using ::testing::ElementsAre;
  EXPECT_THAT(padding_in("CT", false, 0, 0), ElementsAre(0));
  EXPECT_THAT(padding_in("CT", true, 0, 0), ElementsAre(0));
  EXPECT_THAT(padding_in("MR", false, 0, 0), IsEmpty());
  EXPECT_THAT(padding_in("MR", true, 0, 2), IsEmpty());
  EXPECT_THAT(padding_in("MR", false, 1, 1), ElementsAre(1));
  EXPECT_THAT(padding_in("CT", true, -2, -2), ElementsAre(-2));
  EXPECT_THAT(padding_in("CT", true, -1, 2), ElementsAre(-1, 0, 1, 2));
  EXPECT_THAT(padding_in("CT", true, 1, -2), ElementsAre(-2, -1, 0, 1));
  EXPECT_THAT(padding_in("CT", false, 3, 5), ElementsAre(3, 4, 5));
}

// The largest and the least value that the stored bits hold are values; only beyond them is a word none. An overlay
// lies above the stored bits, or below them: there a word that reads like the padding is another value.
TEST(OddValues, PaddingAtTheEndOfTheStoredBitsIsOfThoseBits) {
  for (const int below : {0, 4}) {
    for (const bool is_signed : {false, true}) {
      for (const bool top : {false, true}) {
        const int end = is_signed ? (top ? 2047 : -2048) : top ? 4095 : 0;
        const auto value_at = [=](int i) { return i == 0 ? end : i == 5 ? end >> below : 100 + i; };
        const TestFolder folder;
        write_stack(folder.path(), 2, [&](int, TestImage& image) {
          image.value = [=](int i, int) {
            const int overlay = below > 0 ? 3 : 0x3000;
            return below > 0 && i == 5 ? end & 0xFFFF : (value_at(i) & 0xFFF) << below | overlay;
          };
          image.edit = [&](DcmDataset& d) {
            put(d, DCM_BitsStored, 12);
            put(d, DCM_HighBit, 11 + below);
            put(d, DCM_PixelRepresentation, is_signed ? 1 : 0);
            put(d, DCM_PixelPaddingValue, end & 0xFFFF);
          };
        });
        const Volume volume = load(find_in(folder).series.at(0));
        for (int i = 0; i < 6; ++i) {
          EXPECT_EQ(volume.is_padding(i, 1, 1), value_at(i) == end) << is_signed << top << below << i;
          EXPECT_EQ(volume.value_at(i, 1, 1), value_at(i)) << is_signed << top << below << i;
        }
      }
    }
  }
}

// Rescaled slice by slice, it is still known by what was stored, each slice by its own padding.
TEST(OddValues, PaddingOfSlicesThatAreRescaledDifferentlyIsThatOfEach) {
  for (const bool same_rescale : {false, true}) {
    const TestFolder folder;
    write_stack(folder.path(), 3, [&](int k, TestImage& image) {
      image.value = [](int i, int) { return 1000 + i; };
      image.edit = [=](DcmDataset& d) {
        if (!same_rescale) put(d, DCM_RescaleSlope, std::to_string(k + 1));
        put(d, DCM_PixelPaddingValue, 1001 + (same_rescale ? k : 0));
        put(d, DCM_PixelPaddingRangeLimit, 1003);
      };
    });
    const Volume volume = load(find_in(folder).series.at(0));
    for (int k = 0; k < 3; ++k) {
      for (int i = 0; i < 6; ++i) {
        const bool padding = i >= 1 + (same_rescale ? k : 0) && i <= 3;
        EXPECT_EQ(volume.is_padding(i, 0, k), padding) << i << ' ' << k;
        if (!padding) {
          EXPECT_EQ(volume.value_at(i, 0, k), (same_rescale ? 1 : k + 1) * (1000 + i));
        }
      }
    }
  }
}

TEST(OddValues, EightSignedBits) {
  const TestFolder folder;
  write_stack(folder.path(), 2, [](int, TestImage& image) {
    image.edit = [](DcmDataset& d) {
      put(d, DCM_BitsAllocated, 8);
      put(d, DCM_BitsStored, 8);
      put(d, DCM_HighBit, 7);
      put(d, DCM_PixelRepresentation, 1);
      std::array<Uint8, 24> pixels{};
      for (std::size_t n = 0; n < pixels.size(); ++n) pixels[n] = static_cast<Uint8>(10 * static_cast<int>(n) - 120);
      succeed(d.putAndInsertUint8Array(DCM_PixelData, pixels.data(), pixels.size()));
    };
  });
  const Volume volume = load(find_in(folder).series.at(0));
  for (int n = 0; n < 24; ++n) EXPECT_EQ(volume.value_at(n % 6, n / 6, 1), 10 * n - 120);
}

TEST(OddValues, Monochrome1ChangesNoValueAtAnyDepth) {
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

TEST(OddValues, PixelsThatCannotBeReadAreNamed) {
  struct Case {
    const char* reason;
    std::function<void(DcmDataset&)> edit;
  };
  const auto colors = [](const char* name) {
    return [name](DcmDataset& d) { put(d, DCM_PhotometricInterpretation, name); };
  };
  const std::array cases{
      Case{"color image (PALETTE COLOR)", colors("PALETTE COLOR")},
      Case{"color image (YBR_FULL_422)", colors("YBR_FULL_422")},
      Case{"12 bits in 12", [](DcmDataset& d) { put(d, DCM_BitsAllocated, 12), put(d, DCM_BitsStored, 12); }},
      Case{"highest of them bit 3", [](DcmDataset& d) { put(d, DCM_HighBit, 3); }},
      Case{"pixels of 16 bits in 16", [](DcmDataset& d) {  // floating-point numbers of 32
             succeed(d.findAndDeleteElement(DCM_PixelData));
             const std::array<Float32, 24> pixels{};
             succeed(d.putAndInsertFloat32Array(DcmTag(0x7FE0, 0x0008, EVR_OF), pixels.data(), pixels.size()));
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

}  // namespace
}  // namespace palpate::io::internal

// Pixels that are not 16-bit integers, and values that do not follow from slope and intercept.
#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcuid.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "io/load.h"
#include "io/testing/test_coders.h"
#include "io/testing/test_image.h"

namespace palpate::io::internal {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr int wide_columns = 6, wide_rows = 4;

/// What lies at (i, j, k): beyond 16 bits, and negative where `is_signed`.
double truth(int i, int j, int k, bool is_signed) {
  return 100000.0 * k + 5000.0 * i + 7.0 * j - (is_signed ? 150000 : 0);
}

void expect_truth(const TestFolder& folder, bool is_signed, double slope = 1, double intercept = 0) {
  const Volume volume = load(only_series_in(folder));
  EXPECT_THAT(volume.warnings, IsEmpty());
  for (int k = 0; k < 3; ++k) {
    for (int j = 0; j < wide_rows; ++j) {
      for (int i = 0; i < wide_columns; ++i) {
        const double value = slope * truth(i, j, k, is_signed) + intercept;
        EXPECT_NEAR(volume.value_at(i, j, k), value, 1e-6 * std::abs(value)) << i << " " << j << " " << k;
      }
    }
  }
}

void put_words(DcmDataset& d, int k, bool is_signed) {
  std::vector<Uint16> words;
  for (int j = 0; j < wide_rows; ++j) {
    for (int i = 0; i < wide_columns; ++i) {
      const auto word = static_cast<std::uint32_t>(static_cast<std::int64_t>(truth(i, j, k, is_signed)));
      words.push_back(static_cast<Uint16>(word));
      words.push_back(static_cast<Uint16>(word >> 16));
    }
  }
  put(d, DCM_BitsAllocated, 32);
  put(d, DCM_BitsStored, 32);
  put(d, DCM_HighBit, 31);
  put(d, DCM_PixelRepresentation, is_signed ? 1 : 0);
  succeed(d.putAndInsertUint16Array(DCM_PixelData, words.data(), static_cast<unsigned long>(words.size())));
}

TEST(WideValues, IntegersOf32BitsInEverySyntaxThatHoldsThem) {
  register_encoders();
  for (const E_TransferSyntax syntax : {EXS_LittleEndianExplicit, EXS_LittleEndianImplicit, EXS_BigEndianExplicit,
                                        EXS_DeflatedLittleEndianExplicit, EXS_RLELossless}) {
    for (const bool is_signed : {false, true}) {
      const TestFolder folder;
      write_stack(folder.path(), 3, [&](int k, TestImage& image) {
        image.syntax = syntax;
        image.edit = [=](DcmDataset& d) {
          put_words(d, k, is_signed);
          put(d, DCM_RescaleSlope, std::string("0.5"));
          put(d, DCM_RescaleIntercept, std::string("3"));
        };
      });
      expect_truth(folder, is_signed, 0.5, 3);
    }
  }
}

/// PS3.5 8.1.1: BitsStored bits up to HighBit; what lies above and below them is none of theirs.
TEST(WideValues, IntegersAreCutOutOfTheirWords) {
  for (const auto& [stored, high] : {std::pair{20, 25}, {17, 31}, {24, 23}, {31, 30}}) {
    for (const bool is_signed : {false, true}) {
      const auto value_at = [stored = stored, is_signed](int n) {
        const double range = std::ldexp(1.0, stored);
        const double value = std::floor(range * (n + 1) / 26);
        return is_signed && value >= range / 2 ? value - range : value;
      };
      const TestFolder folder;
      write_stack(folder.path(), 2, [&, stored = stored, high = high](int, TestImage& image) {
        image.edit = [=](DcmDataset& d) {
          put_words(d, 0, is_signed);
          put(d, DCM_BitsStored, stored);
          put(d, DCM_HighBit, high);
          std::vector<Uint16> words;
          for (int n = 0; n < wide_columns * wide_rows; ++n) {
            const auto bits = static_cast<std::uint64_t>(static_cast<std::int64_t>(value_at(n)));
            const std::uint64_t mask = (std::uint64_t{1} << stored) - 1;
            const int below = high + 1 - stored;
            const std::uint64_t word = (bits & mask) << below | ~(mask << below);  // ones all around it
            words.push_back(static_cast<Uint16>(word));
            words.push_back(static_cast<Uint16>(word >> 16));
          }
          succeed(d.putAndInsertUint16Array(DCM_PixelData, words.data(), static_cast<unsigned long>(words.size())));
        };
      });
      const Volume volume = load(only_series_in(folder));
      for (int n = 0; n < wide_columns * wide_rows; ++n) {
        ASSERT_EQ(volume.value_at(n % wide_columns, n / wide_columns, 1),
                  static_cast<double>(static_cast<float>(value_at(n))))
            << stored << " bits up to " << high << ", " << n;
      }
    }
  }
}

TEST(WideValues, IntegersOf32BitsCompressedByMoreThanRunLengthsAreRefused) {
  const TestFolder folder;
  write_stack(folder.path(), 3, [&](int, TestImage& image) {
    image.syntax = EXS_JPEGLSLossless;
    image.edit = [](DcmDataset& d) {
      encapsulate(d, EXS_JPEGLSLossless, {std::vector<Uint8>(100, 7)}, 1000);
      put(d, DCM_BitsAllocated, 32);
    };
  });
  const Catalogue found = find_in(folder);
  ASSERT_THAT(found.skipped, SizeIs(3));
  EXPECT_EQ(
      found.skipped[0].reason,
      "pixels of 32 bits are read only if they are not compressed, or if they are compressed by RLE or deflation");
}

template <typename Number>
void put_numbers(DcmDataset& d, int k, double hole) {
  std::vector<Number> numbers;
  for (int j = 0; j < wide_rows; ++j) {
    for (int i = 0; i < wide_columns; ++i) numbers.push_back(static_cast<Number>(truth(i, j, k, true) + 0.25));
  }
  if (k == 1) numbers[0] = static_cast<Number>(hole);
  d.findAndDeleteElement(DCM_PixelData);
  for (const DcmTagKey& tag : {DCM_BitsStored, DCM_HighBit, DCM_PixelRepresentation}) d.findAndDeleteElement(tag);
  put(d, DCM_BitsAllocated, static_cast<int>(8 * sizeof(Number)));
  if constexpr (sizeof(Number) == 4) {
    succeed(d.putAndInsertFloat32Array(DcmTag(0x7FE0, 0x0008, EVR_OF), numbers.data(), numbers.size()));
  } else {
    succeed(d.putAndInsertFloat64Array(DcmTag(0x7FE0, 0x0009, EVR_OD), numbers.data(), numbers.size()));
  }
}

// What is no number, or the padding that the file names, is no value.
TEST(WideValues, FloatingPointPixelsOfBothSizes) {
  for (const E_TransferSyntax syntax : {EXS_LittleEndianExplicit, EXS_BigEndianExplicit}) {
    for (const bool is_double : {false, true}) {
      for (const double hole : {std::numeric_limits<double>::quiet_NaN(), -1e9}) {
        const TestFolder folder;
        write_stack(folder.path(), 3, [&](int k, TestImage& image) {
          image.syntax = syntax;
          image.edit = [=](DcmDataset& d) {
            is_double ? put_numbers<Float64>(d, k, hole) : put_numbers<Float32>(d, k, hole);
            if (std::isnan(hole)) return;
            succeed(is_double ? d.putAndInsertFloat64(DCM_DoubleFloatPixelPaddingValue, hole)
                              : d.putAndInsertFloat32(DCM_FloatPixelPaddingValue, static_cast<Float32>(hole)));
          };
        });
        const Volume volume = load(find_in(folder).series.at(0));
        EXPECT_TRUE(volume.is_padding(0, 0, 1));
        EXPECT_FALSE(volume.is_padding(1, 0, 1));
        EXPECT_EQ(volume.value_at(5, 3, 2), 200000 + 25000 + 21 - 150000 + 0.25);
        EXPECT_EQ(statistics_without_padding(volume).minimum, -150000 + 0.25);
        EXPECT_EQ(statistics_without_padding(volume).count, 3U * 24U - 1U);
      }
    }
  }
}

// The limit may be below the value or above it, and both ends are padding.
TEST(WideValues, FloatingPointPaddingMayBeARange) {
  for (const bool is_double : {false, true}) {
    for (const bool swapped : {false, true}) {
      const double low = truth(1, 0, 1, true) + 0.25, high = truth(3, 0, 1, true) + 0.25;
      const double value = swapped ? high : low, limit = swapped ? low : high;
      const TestFolder folder;
      write_stack(folder.path(), 3, [&](int k, TestImage& image) {
        image.edit = [=](DcmDataset& d) {
          const double first = truth(0, 0, 1, true) + 0.25;  // no hole
          is_double ? put_numbers<Float64>(d, k, first) : put_numbers<Float32>(d, k, first);
          if (is_double) {
            succeed(d.putAndInsertFloat64(DCM_DoubleFloatPixelPaddingValue, value));
            succeed(d.putAndInsertFloat64(DCM_DoubleFloatPixelPaddingRangeLimit, limit));
          } else {
            succeed(d.putAndInsertFloat32(DCM_FloatPixelPaddingValue, static_cast<Float32>(value)));
            succeed(d.putAndInsertFloat32(DCM_FloatPixelPaddingRangeLimit, static_cast<Float32>(limit)));
          }
        };
      });
      const Volume volume = load(only_series_in(folder));
      for (int k = 0; k < 3; ++k) {
        for (int j = 0; j < wide_rows; ++j) {
          for (int i = 0; i < wide_columns; ++i) {
            const double here = truth(i, j, k, true) + 0.25;
            EXPECT_EQ(volume.is_padding(i, j, k), here >= low && here <= high) << i << ' ' << j << ' ' << k;
          }
        }
      }
    }
  }
}

Catalogue map_with(const char* unit, double slope, bool by_a_table = false) {
  const TestFolder folder;
  TestImage image;
  image.edit = [=](DcmDataset& d) {
    make_multi_frame(d, {0, 2, 4}, [=](std::size_t, DcmItem& frame) {
      DcmItem& mapping = group(frame, DCM_RealWorldValueMappingSequence);
      if (!by_a_table) succeed(mapping.putAndInsertFloat64(DCM_RealWorldValueSlope, slope));
      succeed(mapping.putAndInsertFloat64(DCM_RealWorldValueIntercept, 2));
      succeed(group(mapping, DCM_MeasurementUnitsCodeSequence).putAndInsertString(DCM_CodeValue, unit));
    });
    repeat_pixels(d, 3);
    put(d, DCM_SOPClassUID, UID_ParametricMapStorage);
  };
  write(image, folder / "map.dcm");
  return find_in(folder);
}

// "1" and what stands in braces say that there is none; "[hnsf'U]" is UCUM's Hounsfield unit.
TEST(WideValues, AParametricMapsUnitsAreWrittenAsTheyAreRead) {
  for (const auto& [code, unit] : {std::pair{"[hnsf'U]", "HU"}, {"1", ""}, {"{ratio}", ""}, {"um2/s", "um2/s"}}) {
    const Catalogue found = map_with(code, -0.5);
    ASSERT_THAT(found.series, SizeIs(1)) << code;
    EXPECT_EQ(found.series[0].unit, unit);
  }
}

TEST(WideValues, AParametricMapWithoutALineIsRefused) {
  const Catalogue flat = map_with("1", 0), bent = map_with("1", 1, true);
  ASSERT_THAT(flat.skipped, SizeIs(1));
  EXPECT_EQ(flat.skipped[0].reason, "its rescale slope is 0: it says that all values are the same");
  ASSERT_THAT(bent.skipped, SizeIs(1));
  EXPECT_EQ(bent.skipped[0].reason, "its real world values are given by a table, which is not applied here");
}

// PS3.3 C.7.6.16.2.11: the real world value mapping says what a parametric map's values are.
TEST(WideValues, AParametricMapHasItsUnit) {
  const TestFolder folder;
  TestImage image;
  image.edit = [](DcmDataset& d) {
    make_multi_frame(d, {0, 2, 4}, [](std::size_t, DcmItem& frame) {
      DcmItem& mapping = group(frame, DCM_RealWorldValueMappingSequence);
      succeed(mapping.putAndInsertFloat64(DCM_RealWorldValueSlope, 0.001));
      succeed(mapping.putAndInsertFloat64(DCM_RealWorldValueIntercept, 2));
      succeed(mapping.putAndInsertString(DCM_LUTLabel, "ADC"));
      DcmItem& unit = group(mapping, DCM_MeasurementUnitsCodeSequence);
      succeed(unit.putAndInsertString(DCM_CodeValue, "mm2/s"));
    });
    put(d, DCM_SOPClassUID, UID_ParametricMapStorage);
    std::vector<Float32> numbers;
    for (int n = 0; n < 3 * wide_rows * wide_columns; ++n) numbers.push_back(static_cast<Float32>(n));
    d.findAndDeleteElement(DCM_PixelData);
    put(d, DCM_BitsAllocated, 32);
    succeed(d.putAndInsertFloat32Array(DcmTag(0x7FE0, 0x0008, EVR_OF), numbers.data(), numbers.size()));
  };
  write(image, folder / "map.dcm");
  const Catalogue found = find_in(folder);
  ASSERT_THAT(found.series, SizeIs(1)) << (found.skipped.empty() ? Text() : found.skipped.front().reason);
  EXPECT_EQ(found.series[0].unit, "mm2/s");
  const Volume volume = load(found.series[0]);
  EXPECT_EQ(volume.unit, "mm2/s");
  EXPECT_NEAR(volume.value_at(1, 2, 2), 0.001 * (2 * 24 + 2 * 6 + 1) + 2, 1e-6);
}

void add_table(DcmDataset& d, const std::vector<Uint16>& descriptor, const std::vector<Uint16>& data,
               const char* type) {
  DcmItem& table = group(d, DCM_ModalityLUTSequence);
  succeed(table.putAndInsertUint16Array(DcmTag(DCM_LUTDescriptor, EVR_US), descriptor.data(),
                                        static_cast<unsigned long>(descriptor.size())));
  succeed(
      table.putAndInsertUint16Array(DcmTag(DCM_LUTData, EVR_OW), data.data(), static_cast<unsigned long>(data.size())));
  succeed(table.putAndInsertString(DCM_ModalityLUTType, type));
}

// PS3.3 C.11.1: what lies before the first or behind the last entry takes that one's value.
TEST(WideValues, AModalityLookUpTableIsApplied) {
  const std::vector<Uint16> squares{0, 1, 4, 9, 16, 25, 36, 49};
  const TestFolder folder;
  write_stack(folder.path(), 2, [&](int, TestImage& image) {
    image.value = [](int i, int j) { return 10 + i + 3 * j; };  // 10 to 24
    image.edit = [&](DcmDataset& d) { add_table(d, {8, 12, 16}, squares, "HU"); };
  });
  const Series series = find_in(folder).series.at(0);
  EXPECT_EQ(series.unit, "HU");
  const Volume volume = load(series);
  const auto expected = [](int stored) { return stored < 12 ? 0 : stored > 19 ? 49 : (stored - 12) * (stored - 12); };
  for (int j = 0; j < wide_rows; ++j) {
    for (int i = 0; i < wide_columns; ++i) EXPECT_EQ(volume.value_at(i, j, 1), expected(10 + i + 3 * j));
  }
}

// Of signed pixels the first stored value is signed, too, whatever the descriptor's VR; and a count of 0 is 65536.
TEST(WideValues, AModalityLookUpTableMayBeginBelowZeroAndHoldEveryValue) {
  for (const bool is_signed : {false, true}) {
    for (const bool whole : {false, true}) {
      const TestFolder folder;
      std::vector<Uint16> data(whole ? 65536 : 8);
      for (std::size_t n = 0; n < data.size(); ++n) data[n] = static_cast<Uint16>(3 * n + 1);
      const int first = whole ? (is_signed ? -32768 : 0) : is_signed ? -3 : 2;
      write_stack(folder.path(), 2, [&](int, TestImage& image) {
        image.value = [&](int i, int j) { return (is_signed ? -3 : 2) + i + j % 2; };  // no more than 7 entries
        image.edit = [&](DcmDataset& d) {
          put(d, DCM_PixelRepresentation, is_signed ? 1 : 0);
          add_table(d, {static_cast<Uint16>(whole ? 0 : 8), static_cast<Uint16>(first), 16}, data, "US");
        };
      });
      const Volume volume = load(only_series_in(folder));
      for (int j = 0; j < wide_rows; ++j) {
        for (int i = 0; i < wide_columns; ++i) {
          const int stored = (is_signed ? -3 : 2) + i + j % 2;
          EXPECT_EQ(volume.value_at(i, j, 1), static_cast<Uint16>(3 * (stored - first) + 1)) << is_signed << whole;
        }
      }
    }
  }
}

TEST(WideValues, ATableOfBytesMayBePacked) {
  const TestFolder folder;
  write_stack(folder.path(), 2, [&](int, TestImage& image) {
    image.value = [](int i, int) { return i; };
    image.edit = [&](DcmDataset& d) { add_table(d, {6, 0, 8}, {0x0B0A, 0x0D0C, 0x0F0E}, "US"); };
  });
  const Volume volume = load(find_in(folder).series.at(0));
  EXPECT_EQ(volume.unit, "");
  for (int i = 0; i < wide_columns; ++i) EXPECT_EQ(volume.value_at(i, 0, 0), 10 + i);
}

}  // namespace
}  // namespace palpate::io::internal

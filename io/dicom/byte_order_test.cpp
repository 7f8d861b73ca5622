// Byte orders and signs that a reader can get wrong silently: big-endian 32-bit words, bytes in 16-bit words, and
// unsigned slices among signed ones.
#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcuid.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "io/load.h"
#include "io/testing/test_image.h"

namespace palpate::io::internal {
namespace {

constexpr int dose_columns = 6, dose_rows = 4, dose_frames = 3;

/// What lies at a pixel of a frame.
using DosePixels = std::function<std::int64_t(int i, int j, int k)>;

enum class Swapped { by_words, as_wholes };

/// A dose of 32-bit integers; DCMTK swaps each word of 16 bits by itself.
void put_wide_dose(DcmDataset& d, const DosePixels& pixels, int bits_stored, bool is_signed, Swapped swapped) {
  std::vector<Uint16> words;
  for (int n = 0; n < dose_columns * dose_rows * dose_frames; ++n) {
    const std::int64_t value = pixels(n % dose_columns, n / dose_columns % dose_rows, n / (dose_columns * dose_rows));
    const auto bits = static_cast<std::uint32_t>(value);
    const auto low = static_cast<Uint16>(bits), high = static_cast<Uint16>(bits >> 16);
    const bool high_first = swapped == Swapped::as_wholes;
    words.push_back(high_first ? high : low);
    words.push_back(high_first ? low : high);
  }
  put(d, DCM_SOPClassUID, UID_RTDoseStorage);
  put(d, DCM_Modality, "RTDOSE");
  put(d, DCM_NumberOfFrames, std::to_string(dose_frames));
  put(d, DCM_DoseUnits, "GY");
  put(d, DCM_DoseGridScaling, std::string("0.0001"));
  put(d, DCM_GridFrameOffsetVector, std::string("0\\3\\6"));
  succeed(d.putAndInsertTagKey(DCM_FrameIncrementPointer, DCM_GridFrameOffsetVector));
  put(d, DCM_BitsAllocated, 32);
  put(d, DCM_BitsStored, bits_stored);
  put(d, DCM_HighBit, bits_stored - 1);
  put(d, DCM_PixelRepresentation, is_signed ? 1 : 0);
  succeed(d.putAndInsertUint16Array(DCM_PixelData, words.data(), static_cast<unsigned long>(words.size())));
}

struct DoseKind {
  std::string name;
  DosePixels pixels;
  int most_bits;  ///< that they need
  bool is_signed;
};

std::vector<DoseKind> dose_kinds() {
  const auto bump = [](int i, int j, int k) {
    return std::exp(-0.1 * ((i - 2) * (i - 2) + (j - 1) * (j - 1) + (k - 1) * (k - 1)));
  };
  return {
      {"over all bits", [=](int i, int j, int k) { return std::llround(4.2e9 * bump(i, j, k)); }, 32, false},
      {"over 20 bits", [=](int i, int j, int k) { return std::llround(1e6 * bump(i, j, k)); }, 20, false},
      {"counts", [](int i, int j, int k) -> std::int64_t { return (i * 7 + j * 3 + k) % 5; }, 3, false},
      {"one spot in air", [](int i, int j, int k) -> std::int64_t { return i + j + k == 4 ? 70000 : 0; }, 17, false},
      {"all alike", [](int, int, int) -> std::int64_t { return 1249; }, 11, false},
      {"both signs", [=](int i, int j, int k) { return std::llround(2e5 * bump(i, j, k)) - 100000; }, 19, true},
      {"below zero", [](int i, int, int) -> std::int64_t { return -1000 - i; }, 12, true}};
}

TEST(ByteOrder, BigEndian32BitIntegersHaveTheirValuesWhicheverWayTheirWriterSwappedThem) {
  for (const DoseKind& kind : dose_kinds()) {
    for (const Swapped swapped : {Swapped::by_words, Swapped::as_wholes}) {
      for (const int bits : {20, 24, 31, 32}) {
        if (bits < kind.most_bits) continue;
        SCOPED_TRACE(kind.name + ", " + std::to_string(bits) + " bits, " +
                     (swapped == Swapped::by_words ? "by words" : "as wholes"));
        const TestFolder folder;
        TestImage image;
        image.syntax = EXS_BigEndianExplicit;
        image.edit = [&](DcmDataset& d) { put_wide_dose(d, kind.pixels, bits, kind.is_signed, swapped); };
        write(image, folder / "dose.dcm");
        const Volume volume = load(only_series_in(folder));
        for (int n = 0; n < dose_columns * dose_rows * dose_frames; ++n) {
          const int i = n % dose_columns, j = n / dose_columns % dose_rows, k = n / (dose_columns * dose_rows);
          const double truth = 1e-4 * static_cast<double>(kind.pixels(i, j, k));
          ASSERT_NEAR(volume.value_at(i, j, k), truth, 1e-6 * std::abs(truth)) << i << ' ' << j << ' ' << k;
        }
      }
    }
  }
}

// PS3.5 8.1.1 and A.3: 8-bit pixels in OW are packed by two, and swapped in big-endian files; in OB they are not. A
// frame of an odd number of pixels begins in the middle of a word.
TEST(ByteOrder, FramesOfBytesMayBeginWithinAWord) {
  for (const E_TransferSyntax syntax : {EXS_LittleEndianExplicit, EXS_BigEndianExplicit}) {
    for (const bool in_words : {false, true}) {
      for (const bool is_signed : {false, true}) {
        for (const int width : {1, 5, 6}) {
          for (const int height : {1, 3}) {
            for (const int count : {2, 3, 5}) {
              const auto truth = [&](int i, int j, int k) {
                const int value = 37 * k + 11 * i + 5 * j;
                return is_signed ? value % 256 - 128 : value % 256;
              };
              const TestFolder folder;
              TestImage image{.columns = width, .rows = height};
              image.syntax = syntax;
              image.edit = [&](DcmDataset& d) {
                std::vector<double> heights;
                std::vector<Uint8> bytes;
                for (int k = 0; k < count; ++k) {
                  heights.push_back(2.0 * k);
                  for (int n = 0; n < width * height; ++n) {
                    bytes.push_back(static_cast<Uint8>(truth(n % width, n / width, k)));
                  }
                }
                make_multi_frame(d, heights);
                put(d, DCM_BitsAllocated, 8);
                put(d, DCM_BitsStored, 8);
                put(d, DCM_HighBit, 7);
                put(d, DCM_PixelRepresentation, is_signed ? 1 : 0);
                if (bytes.size() % 2 == 1) bytes.push_back(0);
                if (in_words) {
                  std::vector<Uint16> words;  // the first pixel in the lower half
                  for (std::size_t n = 0; n < bytes.size(); n += 2) {
                    words.push_back(static_cast<Uint16>(bytes[n] | bytes[n + 1] << 8));
                  }
                  succeed(d.putAndInsertUint16Array(DCM_PixelData, words.data(), words.size()));
                } else {
                  succeed(d.putAndInsertUint8Array(DCM_PixelData, bytes.data(), bytes.size()));
                }
              };
              write(image, folder / "a.dcm");
              const Volume volume = load(only_series_in(folder));
              for (int n = 0; n < width * height * count; ++n) {
                const int i = n % width, j = n / width % height, k = n / (width * height);
                ASSERT_EQ(volume.value_at(i, j, k), truth(i, j, k))
                    << width << " x " << height << " x " << count << (in_words ? " in words" : "") << ": " << n;
              }
            }
          }
        }
      }
    }
  }
}

TEST(ByteOrder, UnsignedSlicesAmongSignedOnesKeepTheirValues) {
  for (const E_TransferSyntax syntax : {EXS_LittleEndianExplicit, EXS_BigEndianExplicit}) {
    for (const int unsigned_slice : {0, 1, 3}) {
      const auto truth = [&](int i, int j, int k) {
        return k == unsigned_slice ? 40000 + 100 * i + j : -20000 + 10 * k + 100 * i + j;
      };
      const TestFolder folder;
      write_stack(folder.path(), 4, [&](int k, TestImage& image) {
        image.syntax = syntax;
        image.value = [=](int i, int j) { return truth(i, j, k); };
        image.edit = [=](DcmDataset& d) { put(d, DCM_PixelRepresentation, k == unsigned_slice ? 0 : 1); };
      });
      const Volume volume = load(only_series_in(folder));
      for (int n = 0; n < dose_columns * dose_rows * 4; ++n) {
        const int i = n % dose_columns, j = n / dose_columns % dose_rows, k = n / (dose_columns * dose_rows);
        ASSERT_EQ(volume.value_at(i, j, k), truth(i, j, k)) << unsigned_slice << ": " << n;
      }
    }
  }
}

}  // namespace
}  // namespace palpate::io::internal

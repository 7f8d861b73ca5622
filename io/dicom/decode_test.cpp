// Every transfer syntax and pixel format, written by DCMTK's and OpenJPEG's encoders, against the values that went in.
#include "io/dicom/decode.h"

#include <dcmtk/config/osconfig.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <random>

#include "io/errors.h"
#include "io/load.h"
#include "io/testing/test_coders.h"
#include "io/testing/test_image.h"

namespace palpate::io::internal {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

// Codes the image's values where DCMTK cannot.
void code(DcmDataset& dataset, E_TransferSyntax syntax, const TestImage& image, int bits, bool is_signed,
          const std::function<int(int, int)>& value, std::size_t longest_fragment = 100) {
  if (syntax == EXS_JPEG2000LosslessOnly) {
    encapsulate(dataset, syntax, {jpeg2000(image.columns, image.rows, bits, is_signed, value)}, longest_fragment);
  } else if (syntax == EXS_JPEGLSLossless || syntax == EXS_JPEGLSLossy) {
    const int near = syntax == EXS_JPEGLSLossy ? 1 << (bits - 8) : 0;
    encapsulate(dataset, syntax, {jpeg_ls(image.columns, image.rows, bits, near, value)}, 1U << 20);
  }
}

struct Format {
  const char* name;
  int bits_stored;
  bool is_signed;
};

struct Coding {
  const char* name;
  E_TransferSyntax syntax;
  int error;  // the most a lossy coder may be off
};

// Smooth, from the least to the largest value that the format can hold: lossy coders follow, and signs show.
int expected_value(const Format& format, int k, int i, int j) {
  const int range = (1 << format.bits_stored) - 1;
  const int least = format.is_signed ? -(1 << (format.bits_stored - 1)) : 0;
  return least + range * (i + 2 * j + k) / (31 + 2 * 23 + 2);
}

class Decode : public ::testing::TestWithParam<std::tuple<Coding, Format>> {};

TEST_P(Decode, GivesTheValuesThatWentIn) {
  const auto& [coding, format] = GetParam();
  register_encoders();
  const TestFolder folder;
  write_stack(folder.path(), 3, [&, &f = format, syntax = coding.syntax](int k, TestImage& image) {
    image.columns = 32;
    image.rows = 24;
    image.syntax = syntax;
    const auto value = [&f, k](int i, int j) { return expected_value(f, k, i, j); };
    image.value = [=, &f](int i, int j) { return value(i, j) & ((1 << f.bits_stored) - 1); };
    image.edit = [=, &f, &image](DcmDataset& d) {
      put(d, DCM_BitsStored, f.bits_stored);
      put(d, DCM_HighBit, f.bits_stored - 1);
      put(d, DCM_PixelRepresentation, f.is_signed ? 1 : 0);
      code(d, syntax, image, f.bits_stored, f.is_signed, value);
    };
  });
  const Catalogue found = find_series(std::array{folder.path()});
  ASSERT_EQ(found.series.size(), 1U);
  const Volume volume = load(found.series[0]);
  EXPECT_THAT(volume.warnings, IsEmpty());
  int worst = 0;
  for (int k = 0; k < 3; ++k) {
    for (int j = 0; j < 24; ++j) {
      for (int i = 0; i < 32; ++i) {
        worst = std::max(worst, std::abs(static_cast<int>(volume.value_at(i, j, k)) - expected_value(format, k, i, j)));
      }
    }
  }
  EXPECT_LE(worst, coding.error << (format.bits_stored - 8));
}

INSTANTIATE_TEST_SUITE_P(
    Lossless, Decode,
    ::testing::Combine(::testing::Values(Coding{"implicit", EXS_LittleEndianImplicit, 0},
                                         Coding{"explicit", EXS_LittleEndianExplicit, 0},
                                         Coding{"big_endian", EXS_BigEndianExplicit, 0},
                                         Coding{"deflated", EXS_DeflatedLittleEndianExplicit, 0},
                                         Coding{"jpeg_lossless", EXS_JPEGProcess14SV1, 0},
                                         Coding{"jpeg_lossless_any_predictor", EXS_JPEGProcess14, 0},
                                         Coding{"jpeg_ls", EXS_JPEGLSLossless, 0},
                                         Coding{"jpeg_2000", EXS_JPEG2000LosslessOnly, 0},
                                         Coding{"rle", EXS_RLELossless, 0}),
                       ::testing::Values(Format{"unsigned_12", 12, false}, Format{"unsigned_16", 16, false},
                                         Format{"signed_12", 12, true}, Format{"signed_16", 16, true})),
    [](const auto& which) { return std::string(std::get<0>(which.param).name) + "_" + std::get<1>(which.param).name; });

INSTANTIATE_TEST_SUITE_P(Lossy, Decode,
                         ::testing::Combine(::testing::Values(Coding{"jpeg_extended", EXS_JPEGProcess2_4, 4},
                                                              Coding{"jpeg_spectral", EXS_JPEGProcess6_8, 4},
                                                              Coding{"jpeg_progressive", EXS_JPEGProcess10_12, 4},
                                                              Coding{"jpeg_ls_near", EXS_JPEGLSLossy, 1}),
                                            ::testing::Values(Format{"unsigned_12", 12, false})),
                         [](const auto& which) { return std::string(std::get<0>(which.param).name); });

// 8-bit pixels, odd in number, in every byte order: big-endian words hold the second pixel first.
TEST(DecodeEightBits, InEveryByteOrder) {
  register_encoders();
  for (const E_TransferSyntax syntax :
       {EXS_LittleEndianImplicit, EXS_LittleEndianExplicit, EXS_BigEndianExplicit, EXS_RLELossless, EXS_JPEGProcess1,
        EXS_JPEGLSLossless, EXS_JPEG2000LosslessOnly}) {
    const TestFolder folder;
    write_stack(folder.path(), 2, [&](int k, TestImage& image) {
      image.columns = 9;
      image.rows = 7;
      image.edit = [k, syntax, &image](DcmDataset& d) {
        put(d, DCM_BitsAllocated, 8);
        put(d, DCM_BitsStored, 8);
        put(d, DCM_HighBit, 7);
        std::array<Uint8, 64> pixels{};
        for (std::size_t n = 0; n < 63; ++n) pixels[n] = static_cast<Uint8>(3 * n + static_cast<std::size_t>(k));
        succeed(d.putAndInsertUint8Array(DCM_PixelData, pixels.data(), pixels.size()));
        code(d, syntax, image, 8, false, [&](int i, int j) { return pixels[static_cast<std::size_t>(9 * j + i)]; });
      };
      image.syntax = syntax;
    });
    const Volume volume = load(find_series(std::array{folder.path()}).series.at(0));
    for (int n = 0; n < 63; ++n) {
      EXPECT_NEAR(volume.value_at(n % 9, n / 9, 1), 3 * n + 1, syntax == EXS_JPEGProcess1 ? 3 : 0)
          << DcmXfer(syntax).getXferName();
    }
  }
}

TEST(DecodeBits, OverlaysAboveAndBelowTheStoredBitsAreRemoved) {
  const TestFolder folder;
  write_stack(folder.path(), 2, [](int, TestImage& image) {
    image.value = [](int i, int j) { return 0xA003 | ((i - 3 * j) & 0x1FF) << 4; };  // 9 bits, from bit 4 to bit 12
    image.edit = [](DcmDataset& d) {
      put(d, DCM_BitsStored, 9);
      put(d, DCM_HighBit, 12);
      put(d, DCM_PixelRepresentation, 1);
    };
  });
  const Volume volume = load(find_series(std::array{folder.path()}).series.at(0));
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 6; ++i) EXPECT_EQ(volume.value_at(i, j, 0), i - 3 * j);
  }
}

// A multi-frame file with more fragments than frames and an empty offset table, frames stored from top to bottom.
TEST(DecodeJpeg2000, FramesOfSeveralFragmentsAreToldApart) {
  const TestFolder folder;
  TestImage image;
  image.columns = 32;
  image.rows = 24;
  image.syntax = EXS_JPEG2000;
  image.edit = [](DcmDataset& d) {
    std::vector<std::vector<Uint8>> frames;
    for (int f = 0; f < 3; ++f) {
      frames.push_back(jpeg2000(32, 24, 16, false, [f](int i, int j) { return 1000 * f + 7 * i * j; }));
    }
    encapsulate(d, EXS_JPEG2000, frames, 200);
    make_multi_frame(d, {30, 20, 10});
  };
  write(image, folder / "enhanced");
  const Series series = find_series(std::array{folder.path()}).series.at(0);
  ASSERT_EQ(series.geometry.dimensions.z, 3);
  const Volume volume = load(series);
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(volume.geometry.slice_positions[static_cast<std::size_t>(k)].z, 10 * (k + 1));
    EXPECT_EQ(volume.value_at(31, 23, k), 1000 * (2 - k) + 7 * 31 * 23);
  }
}

int noise(int k, int i, int j) {
  return (i * 2654435 + j * 40503 + k * 77 + i * j * 31) & 0xFFF;
}

void write_noise_stack(const TestFolder& folder, E_TransferSyntax syntax, std::size_t lost_bytes_of_slice_2) {
  write_stack(folder.path(), 5, [=](int k, TestImage& image) {
    image.columns = 64;
    image.rows = 64;
    image.value = [k](int i, int j) { return noise(k, i, j); };
    image.syntax = syntax;
    image.edit = [=, &image](DcmDataset& d) {
      const std::size_t lost = k == 2 ? lost_bytes_of_slice_2 : 0;
      std::vector<Uint8> bytes = syntax == EXS_JPEG2000LosslessOnly ? jpeg2000(64, 64, 16, false, image.value)
                                                                    : jpeg_ls(64, 64, 16, 0, image.value);
      bytes.resize(bytes.size() - lost);
      encapsulate(d, syntax, {bytes}, 1U << 20);
    };
    if (syntax == EXS_JPEGProcess14SV1) image.edit = [](DcmDataset&) {};
  });
}

void expect_slice_2_lost(const TestFolder& folder) {
  const Volume volume = load(find_series(std::array{folder.path()}).series.at(0));
  EXPECT_EQ(volume.geometry.dimensions.z, 4);
  EXPECT_THAT(volume.geometry.gaps, ::testing::ElementsAre(1));
  ASSERT_EQ(volume.warnings.size(), 1U);
  EXPECT_THAT(volume.warnings[0], HasSubstr("s2.dcm"));
  EXPECT_EQ(volume.value_at(7, 9, 2), noise(3, 7, 9));
}

// (Noise inside a code block of JPEG 2000 decodes to other noise: nothing can tell.)
TEST(DecodeDamaged, SliceOfNoiseIsLeftOutNamedAndAGap) {
  register_encoders();
  for (const E_TransferSyntax syntax : {EXS_JPEGProcess14SV1, EXS_JPEGLSLossless}) {
    const TestFolder folder;
    write_noise_stack(folder, syntax, 0);
    const auto path = folder / "s2.dcm";
    const auto size = std::filesystem::file_size(path);
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(static_cast<std::streamoff>(size / 2));  // as after a bad disk: the file keeps its length
    std::mt19937 random(1);
    for (std::size_t n = 0; n < size / 2 - 100; ++n) file.put(static_cast<char>(random()));
    file.close();
    expect_slice_2_lost(folder);
  }
}

// Found by the fuzzer: DCMTK read beyond its tables and made pixels of what was there.
TEST(DecodeDamaged, HuffmanTableOfImpossibleDifferencesIsRefused) {
  register_encoders();
  for (const bool behind_pixels : {false, true}) {  // for a second scan
    const TestFolder folder;
    write_noise_stack(folder, EXS_JPEGProcess14SV1, 0);
    std::fstream file(folder / "s2.dcm", std::ios::in | std::ios::out | std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(file), {}};
    const auto table = bytes.find("\xFF\xC4");
    ASSERT_NE(table, std::string::npos);
    if (behind_pixels) {
      const std::string second("\xFF\xC4\x00\x14\x00\x01\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x21", 22);
      bytes.replace(bytes.rfind("\xFF\xD9") - second.size(), second.size(), second);
    } else {
      bytes[table + 21] = '\x21';
    }
    file.clear();
    file.seekp(0);
    file << bytes;
    file.close();
    expect_slice_2_lost(folder);
    EXPECT_THAT(load(find_series(std::array{folder.path()}).series.at(0)).warnings.at(0), HasSubstr("Huffman"));
  }
}

TEST(DecodeDamaged, SliceWithATruncatedStreamIsNotFilledUp) {
  for (const E_TransferSyntax syntax : {EXS_JPEGLSLossless, EXS_JPEG2000LosslessOnly}) {
    const TestFolder folder;
    write_noise_stack(folder, syntax, 2000);
    expect_slice_2_lost(folder);
  }
}

// NEMA's own WG04 images are coded like this: decoders say a word and go on.
TEST(DecodeOdd, LossyJpegThatNamesNoFrequenciesIsReadWhole) {
  register_encoders();
  for (const E_TransferSyntax syntax : {EXS_JPEGProcess1, EXS_JPEGProcess2_4}) {
    const bool is_8_bit = syntax == EXS_JPEGProcess1;
    const TestFolder folder;
    write_stack(folder.path(), 3, [=](int k, TestImage& image) {
      image.columns = 64;
      image.rows = 48;
      image.syntax = syntax;
      image.edit = [=](DcmDataset& d) {
        put(d, DCM_BitsStored, is_8_bit ? 8 : 12);
        put(d, DCM_HighBit, is_8_bit ? 7 : 11);
        if (!is_8_bit) return;
        put(d, DCM_BitsAllocated, 8);
        std::vector<Uint8> pixels;
        for (int n = 0; n < 64 * 48; ++n) pixels.push_back(static_cast<Uint8>(n % 64 + n / 64 + 20 * k));
        succeed(d.putAndInsertUint8Array(DCM_PixelData, pixels.data(), static_cast<unsigned long>(pixels.size())));
      };
    });
    const Volume truth = load(find_series(std::array{folder.path()}).series.at(0));
    EXPECT_EQ(truth.geometry.dimensions.z, 3);
    EXPECT_THAT(truth.warnings, ::testing::IsEmpty());
    for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
      std::fstream file(entry.path(), std::ios::in | std::ios::out | std::ios::binary);
      const std::string bytes{std::istreambuf_iterator<char>(file), {}};
      const auto scan = bytes.find(std::string("\xFF\xDA\x00\x08\x01", 5));
      ASSERT_NE(scan, std::string::npos);
      ASSERT_EQ(bytes[scan + 8], 63);
      file.clear();
      file.seekp(static_cast<std::streamoff>(scan + 8));
      file.put(0);
    }
    const Volume volume = load(find_series(std::array{folder.path()}).series.at(0));
    EXPECT_EQ(volume.voxels, truth.voxels);
    EXPECT_THAT(volume.warnings, ::testing::ElementsAre("its JPEG images name a range of frequencies that they do not "
                                                        "have; they are read whole"));
  }
}

TEST(DecodeOdd, JpegLsWithZerosBeforeItsEndIsReadWhole) {
  for (const std::size_t zeros : {1U, 2U}) {
    const TestFolder folder;
    write_stack(folder.path(), 3, [=](int k, TestImage& image) {
      image.columns = 64;
      image.rows = 64;
      image.value = [k](int i, int j) { return noise(k, i, j); };
      image.syntax = EXS_JPEGLSLossless;
      image.edit = [=, &image](DcmDataset& d) {
        std::vector<Uint8> bytes = jpeg_ls(64, 64, 16, 0, image.value);
        bytes.insert(bytes.end() - 2, zeros, 0);
        encapsulate(d, EXS_JPEGLSLossless, {bytes}, 1U << 20);
      };
    });
    const Volume volume = load(find_series(std::array{folder.path()}).series.at(0));
    ASSERT_EQ(volume.geometry.dimensions.z, 3);
    for (int k = 0; k < 3; ++k) {
      for (int n = 0; n < 64 * 64; ++n) ASSERT_EQ(volume.value_at(n % 64, n / 64, k), noise(k, n % 64, n / 64));
    }
    EXPECT_THAT(volume.warnings,
                ::testing::ElementsAre("its JPEG-LS images hold zeros before their end; they are whole without these"));
  }
}

TEST(JpegFrame, IsReadFromItsMarker) {
  const std::array<unsigned char, 21> jpeg{0xFF, 0xD8, 0xFF, 0xE0, 0x00, 0x04, 1, 2, 0xFF, 0xFF, 0xC3,
                                           0x00, 0x0B, 0x0C, 0x01, 0x02, 0x03, 4, 1, 0,    0};
  const auto frame = jpeg_frame(std::as_bytes(std::span(jpeg)));
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->columns, 0x0304);
  EXPECT_EQ(frame->rows, 0x0102);
  EXPECT_EQ(frame->precision, 12);
  EXPECT_FALSE(jpeg_frame({}));
}

}  // namespace
}  // namespace palpate::io::internal

// The limits on pixels for a number of bytes, and on the size after inflating.
#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcuid.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <tuple>
#include <utility>

#include "io/dicom/decode.h"
#include "io/errors.h"

namespace palpate::io::internal {
namespace {

bool is_dense_enough(const std::string& syntax, std::uint64_t pixels, std::uint64_t bytes) {
  PixelFormat format;
  format.columns = 512;
  format.rows = 1;
  try {
    check_density(syntax, format, static_cast<std::size_t>(pixels / 512), bytes);
  } catch (const DicomError&) {
    return false;
  }
  return true;
}

// Pixels a byte at most: RLE packs 128 bytes in 2 (PS3.5 G.3.1), JPEG has a bit for 8 by 8 coefficients, zlib 1032
// bytes in one (its documentation); JPEG-LS and JPEG 2000 of more than a thousand are empty. 2^18 pixels may be of
// nothing.
TEST(Density, IsAtMostWhatACompressionCanReach) {
  constexpr std::uint64_t small = 1U << 18U;
  for (const auto& [syntax, most] : {std::pair<std::string, std::uint64_t>{UID_RLELosslessTransferSyntax, 256},
                                     {UID_JPEGProcess1TransferSyntax, 256},
                                     {UID_JPEGProcess2_4TransferSyntax, 256},
                                     {UID_JPEGProcess14TransferSyntax, 256},
                                     {UID_JPEGProcess14SV1TransferSyntax, 256},
                                     {UID_JPEGLSLosslessTransferSyntax, 1024},
                                     {UID_JPEGLSLossyTransferSyntax, 1024},
                                     {UID_JPEG2000LosslessOnlyTransferSyntax, 1024},
                                     {UID_JPEG2000TransferSyntax, 1024},
                                     {UID_DeflatedExplicitVRLittleEndianTransferSyntax, 1032}}) {
    EXPECT_EQ(can_decode(syntax), syntax != UID_DeflatedExplicitVRLittleEndianTransferSyntax) << syntax;
    EXPECT_TRUE(is_dense_enough(syntax, small, 0)) << syntax;
    EXPECT_FALSE(is_dense_enough(syntax, small + 512, 0)) << syntax;
    for (const std::uint64_t bytes : {1000U, 4129U, 1000000U}) {
      // The most whole rows of 512 pixels that so many bytes hold; pixels beyond a whole byte's do not count.
      const std::uint64_t held = (bytes * most + most - 1) / 512 * 512;
      if (held <= small) continue;
      EXPECT_TRUE(is_dense_enough(syntax, held, bytes)) << syntax << ' ' << bytes;
      EXPECT_FALSE(is_dense_enough(syntax, held + 2 * most, bytes)) << syntax << ' ' << bytes;
    }
  }
}

// Up to 256 MiB of anything, fifty times what came in up to 8 GiB, and no more.
TEST(Inflation, IsAtMostFiftyfoldAndEightGibibytes) {
  constexpr std::uint64_t mib = 1U << 20U;
  for (const auto& [out, in, fits] : {std::tuple<std::uint64_t, std::uint64_t, bool>{256 * mib, 0, true},
                                      {256 * mib + 50, 0, false},
                                      {256 * mib + 50, (256 * mib + 50) / 50 - 1, false},
                                      {256 * mib + 50, (256 * mib + 50) / 50, true},
                                      {8192 * mib, 8192 * mib / 50, true},
                                      {8192 * mib, 8192 * mib / 50 - 1, false},
                                      {8192 * mib + 1, 8192 * mib, false}}) {
    if (fits) {
      EXPECT_NO_THROW(check_inflation(out, in)) << out;
    } else {
      EXPECT_THROW(check_inflation(out, in), DicomError) << out;
    }
  }
}

}  // namespace
}  // namespace palpate::io::internal

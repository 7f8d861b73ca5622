#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcdeftag.h>
#include <dcmtk/dcmdata/dcuid.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "io/dicom/decode.h"
#include "io/testing/provoked_scans.h"
#include "io/testing/test_coders.h"

namespace palpate::io::testing {
namespace {

using namespace std::string_literals;
using namespace internal;
using Bytes = std::vector<Uint8>;

constexpr int edge = 32;  // columns and rows of the images

int texture(int i, int j) {
  return (i * 2654435 + j * 40503 + i * j * 31) & 0xFFF;
}

/// A stack whose slices' pixels are these frames of compressed bytes.
std::string of_coded(E_TransferSyntax syntax, const Bytes& bytes, const std::function<void(DcmDataset&)>& edit = {}) {
  return of_stack(3, [&](int, TestImage& image) {
    image.columns = image.rows = edge;
    image.syntax = syntax;
    image.edit = [&](DcmDataset& dataset) {
      encapsulate(dataset, syntax, {bytes}, 1U << 20);
      if (edit) edit(dataset);
    };
  });
}

/// The same, whose files' bytes are edited.
std::string of_coded_file(const std::function<void(std::string&)>& damage) {
  return said_of([&](const TestFolder& folder) {
    TestImage image;
    image.syntax = EXS_RLELossless;
    image.edit = [](DcmDataset& dataset) { encapsulate(dataset, EXS_RLELossless, {Bytes(100, 7)}, 1U << 20); };
    write(image, folder / "a.dcm");
    std::string bytes = bytes_of(folder / "a.dcm");
    damage(bytes);
    write_bytes(folder / "a.dcm", bytes);
  });
}

/// What DCMTK's encoder makes of the texture, edited in the file.
std::string of_jpeg(const std::function<void(std::string&)>& damage) {
  register_encoders();
  return said_of([&](const TestFolder& folder) {
    write_stack(folder.path(), 2, [](int, TestImage& image) {
      image.columns = image.rows = edge;
      image.value = texture;
      image.syntax = EXS_JPEGProcess14SV1;
    });
    std::string bytes = bytes_of(folder / "s1.dcm");
    damage(bytes);
    write_bytes(folder / "s1.dcm", bytes);
  });
}

/// RLE with two segments at the given offsets.
Bytes rle(std::array<Uint8, 2> starts, const Bytes& behind) {
  Bytes bytes(64 + behind.size());
  bytes[0] = 2;
  bytes[4] = starts[0];
  bytes[8] = starts[1];
  std::copy(behind.begin(), behind.end(), bytes.begin() + 64);
  return bytes;
}

Bytes coded_2000(int columns, int bits) {
  return jpeg2000(columns, edge, bits, false, texture);
}

Bytes first_half(Bytes bytes) {
  bytes.resize(bytes.size() / 2);
  return bytes;
}

/// The messages about a JPEG 2000 image with one damaged byte, for each byte in turn.
std::string of_a_broken_byte() {
  const Bytes whole = coded_2000(edge, 12);
  std::string said;
  for (std::size_t at = whole.size() / 8; at < whole.size(); ++at) {
    for (const int flip : {0x01, 0x10, 0xFF}) {
      Bytes broken = whole;
      broken[at] = static_cast<Uint8>(broken[at] ^ flip);
      std::vector<std::uint16_t> values(edge * edge);
      const std::string one = said_when([&] {
        decode_frame(UID_JPEG2000LosslessOnlyTransferSyntax, {.columns = edge, .rows = edge},
                     std::as_bytes(std::span(broken)), values);
      });
      if (said.find(one) == std::string::npos) said += one + "\n";
    }
  }
  return said;
}

/// Two frames in three fragments, none of which begins an image.
void three_fragments_of_two_frames(DcmDataset& dataset) {
  const Bytes piece(20, 7);
  encapsulate(dataset, EXS_RLELossless, {piece, piece, piece}, 1U << 20);
  make_multi_frame(dataset, {0, 2});
}

std::vector<Provoked> provoke_lossless_coders() {
  return {
      {"rle", of_coded(EXS_RLELossless, Bytes(10, 7))},
      {"rle-is-missing", of_coded(EXS_RLELossless, Bytes(10, 7))},
      {"rle-not-one-a-byte", of_coded(EXS_RLELossless, Bytes(100, 7))},
      {"rle-ends-early", of_coded(EXS_RLELossless, rle({64, 66}, {0, 1, 0, 1}))},
      {"rle-does-not-fit", of_coded(EXS_RLELossless, rle({64, 66}, {9, 1, 0, 1}))},
      {"rle-outside-the-file", of_coded(EXS_RLELossless, rle({64, 200}, {0, 1}))},
      {"jpeg-ls-cannot-be-decoded", of_coded(EXS_JPEGLSLossless, Bytes(100, 7))},
      {"jpeg-ls-size", of_coded(EXS_JPEGLSLossless, jpeg_ls(edge + 1, edge, 12, 0, texture))},
      {"jpeg-2000", of_coded(EXS_JPEG2000LosslessOnly, Bytes(100, 7))},
      {"jpeg-2000-no-header", of_coded(EXS_JPEG2000LosslessOnly, Bytes(100, 7))},
      {"jpeg-2000-size", of_coded(EXS_JPEG2000LosslessOnly, coded_2000(edge + 1, 12))},
      {"jpeg-2000-kind", of_coded(EXS_JPEG2000LosslessOnly, coded_2000(edge, 20))},
      {"jpeg-2000-ends-early", of_coded(EXS_JPEG2000LosslessOnly, first_half(coded_2000(edge, 12)))},
      {"jpeg-2000-holds-errors", of_a_broken_byte()},
  };
}

std::vector<Provoked> provoke_jpeg() {
  return {
      {"no-jpeg-image", of_coded(EXS_JPEGProcess14SV1, Bytes(100, 7))},
      {"jpeg-size", of_jpeg([](std::string& b) { b[b.find("\xFF\xC3") + 6] = static_cast<char>(edge + 1); })},
      {"jpeg-huffman-table", of_jpeg([](std::string& b) { b[b.find("\xFF\xC4") + 21] = '\x77'; })},
      {"jpeg-holds-errors", of_jpeg([](std::string& b) { b.replace(b.size() - 300, 200, 200, '\x55'); })},
      {"jpeg-cannot-be-decoded", of_jpeg([](std::string& b) { b[b.find("\xFF\xC3") + 1] = '\xC9'; })},
  };
}

}  // namespace

std::vector<Provoked> provoke_pixels() {
  std::vector<Provoked> said{
      {"series-cannot-be-read", of_coded(EXS_RLELossless, Bytes(10, 7))},
      {"compression-is-unknown-here", of_coded(EXS_JPEGProcess7_9, Bytes(100, 7))},
      {"pixels-are-not-compressed", of_bytes([](std::string b) {
         return b.replace(b.find(UID_LittleEndianExplicitTransferSyntax), 19, "1.2.840.10008.1.2.5");
       })},
      {"compressed-pixels-are-not-items",
       of_coded_file([](std::string& b) { b[b.rfind("\xFE\xFF\x00\xE0"s) + 2] = 7; })},
      {"truncated-its-compressed-pixels-end-early",
       of_coded_file([](std::string& b) { b[b.rfind("\xFE\xFF\x00\xE0"s) + 6] = 7; })},
      {"truncated-the-file-ends-early", of_coded_file([](std::string& b) { b.resize(b.find("\xFE\xFF\x00\xE0"s)); })},
      {"no-pixels-in-it", of_coded(EXS_RLELossless, {})},
      {"damaged-bytes-cannot-hold-pixels",
       of_coded(EXS_RLELossless, Bytes(100, 7), [](DcmDataset& d) { put(d, DCM_Rows, 60000); })},
      {"truncated-its-deflated-pixels-end-early", of_stack(2,
                                                           [](int, TestImage& image) {
                                                             image.syntax = EXS_DeflatedLittleEndianExplicit;
                                                             image.edit = [](DcmDataset& d) { put(d, DCM_Rows, 8); };
                                                           })},
      {"compressed-fragments-do-not-make-up", said_of([](const TestFolder& folder) {
         TestImage image;
         image.syntax = EXS_RLELossless;
         image.edit = three_fragments_of_two_frames;
         write(image, folder / "a.dcm");
       })},
  };
  for (const auto& more : {provoke_lossless_coders(), provoke_jpeg()}) {
    said.insert(said.end(), more.begin(), more.end());
  }
  return said;
}

}  // namespace palpate::io::testing

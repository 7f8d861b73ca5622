// Writes small segmentations and scans in rare forms as seeds for the reader's fuzzer: write_seeds FOLDER
#include <zlib.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "io/testing/file_bytes.h"
#include "io/testing/test_coders.h"
#include "io/testing/test_image.h"
#include "io/testing/test_segmentation.h"

namespace {

using namespace palpate::io::internal;

constexpr int columns = 7, rows = 5, frames = 3;

std::vector<Uint8> deflated(const std::vector<Uint8>& bytes) {
  std::vector<Uint8> out(1024);
  z_stream stream{};
  deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, -MAX_WBITS, MAX_MEM_LEVEL, Z_DEFAULT_STRATEGY);
  std::vector<Uint8> in = bytes;
  stream.next_in = in.data();
  stream.avail_in = static_cast<uInt>(in.size());
  stream.next_out = out.data();
  stream.avail_out = static_cast<uInt>(out.size());
  deflate(&stream, Z_FINISH);
  out.resize(out.size() - stream.avail_out);
  deflateEnd(&stream);
  return out;
}

/// Frames of so many bits, each by itself run-length coded or deflated.
void write_packed(const std::filesystem::path& file, int bits, bool is_deflated) {
  register_encoders();
  TestImage image{.columns = columns, .rows = rows};
  image.syntax = is_deflated ? EXS_JPEG2000LosslessOnly : EXS_RLELossless;
  image.edit = [&](DcmDataset& dataset) {
    make_multi_frame(dataset, {0, 2, 4});
    put(dataset, DCM_BitsAllocated, bits);
    put(dataset, DCM_BitsStored, bits);
    put(dataset, DCM_HighBit, bits - 1);
    std::vector<std::vector<Uint8>> coded;
    for (int k = 0; k < frames; ++k) {
      std::vector<Uint8> bytes;
      if (!is_deflated) {  // a segment for each byte of a pixel, each of literals
        bytes.resize(64);
        bytes[0] = static_cast<Uint8>(bits / 8);
      }
      for (int part = 0; part < bits / 8; ++part) {
        if (!is_deflated) bytes[static_cast<std::size_t>(4 + 4 * part)] = static_cast<Uint8>(bytes.size());
        if (!is_deflated) bytes.push_back(columns * rows - 1);
        for (int n = 0; n < columns * rows; ++n) bytes.push_back(static_cast<Uint8>(n + 3 * k + part));
      }
      coded.push_back(is_deflated ? deflated(bytes) : bytes);
    }
    encapsulate(dataset, image.syntax, coded, 1U << 16);
  };
  write(image, file);
  if (is_deflated) call_deflated_frames(file);
}

std::string nrrd_of(const std::string& type, const std::string& encoding, const std::string& axes) {
  return "NRRD0005\ntype: " + type + "\nspace: LPS\nspace origin: (1,2,3)\nendian: little\nencoding: " + encoding +
         "\n" + axes + "\n\n";
}

void write_scans(const std::filesystem::path& folder) {
  const std::string three = "dimension: 3\nsizes: 2 2 2\nspace directions: (1,0,0) (0,2,0) (0,0,3)";
  const std::string four = "dimension: 4\nsizes: 3 2 2 2\nspace directions: none (1,0,0) (0,2,0) (0,0,3)\nkinds: ";
  const std::string of_time =
      "dimension: 4\nsizes: 2 2 2 3\nspace directions: (1,0,0,0) (0,2,0,0) (0,0,3,0) (0,0,0,1)\nspace units: \"um\"";
  const std::string bytes = "abcdefghijklmnopqrstuvwx";
  write_bytes(folder / "words.nrrd", nrrd_of("short", "ascii", three) + "1 -2 3, 4\n5 6 7 8");
  write_bytes(folder / "digits.nrrd", nrrd_of("uint64", "hex", three) + std::string(128, 'a'));
  write_bytes(folder / "colors.nrrd", nrrd_of("uchar", "raw", four + "RGB-color domain domain domain") + bytes);
  write_bytes(folder / "beside.nrrd", nrrd_of("uchar", "raw", four + "list domain domain domain") + bytes);
  std::string with_time = nrrd_of("uchar", "raw", of_time) + bytes;
  with_time.replace(with_time.find("LPS"), 3, "LPST").replace(with_time.find("(1,2,3)"), 7, "(1,2,3,0)");
  write_bytes(folder / "time.nrrd", with_time);
  write_bytes(folder / "colors.mha",
              "NDims = 4\nDimSize = 2 2 2 1\nElementType = MET_UCHAR\nElementNumberOfChannels = 3\n"
              "ElementSpacing = 1 2 3 1\nOffset = 1 2 3 0\nElementDataFile = LOCAL\n" +
                  bytes);
  std::string nifti(544, '\0');  // nifti2.h
  const auto put = [&](std::size_t at, auto number) { std::memcpy(nifti.data() + at, &number, sizeof number); };
  put(0, std::int32_t{540});
  std::memcpy(nifti.data() + 4, "n+2\0\r\n\032\n", 8);
  put(12, std::int16_t{2});
  for (const std::size_t axis : {0U, 1U, 2U, 3U}) put(16 + 8 * axis, std::int64_t{axis == 0 ? 3 : 2});
  put(168, std::int64_t{544});
  put(348, std::int32_t{1});
  for (const std::size_t axis : {0U, 1U, 2U}) put(400 + 40 * axis, 1.5);
  write_bytes(folder / "second.nii", nifti + bytes.substr(0, 8));
}

}  // namespace

int main(int count, char** words) {
  using palpate::io::internal::TestSegmentation;
  using palpate::io::internal::write;
  if (count != 2) {
    std::cerr << "Usage: write_seeds FOLDER\n";
    return 2;
  }
  const std::filesystem::path folder = words[1];
  const auto box = [](int i, int j) { return i >= 3 && i < 8 && j >= 2 && j < 6 ? 1 : 0; };
  const auto half = [&](int i, int j) { return 100 * box(i, j); };
  const TestSegmentation bits{.names = {"Liver", "Spleen"}, .frames = {{1, 0, box}, {1, 2, box}, {2, 2, box}}};
  write(bits, folder / "bits.seg");
  write({.type = "FRACTIONAL", .bits = 8, .frames = {{1, 0, half}, {1, 2, half}}}, folder / "fractions.seg");
  write({.type = "LABELMAP", .bits = 8, .frames = {{0, 0, box}, {0, 2, box}}}, folder / "labels.seg");
  write({.type = "LABELMAP", .bits = 16, .frames = {{0, 0, box}, {0, 2, box}}}, folder / "wide_labels.seg");
  for (const int width : {8, 16, 32}) {
    for (const bool is_deflated : {false, true}) {
      write_packed(folder / (std::to_string(width) + (is_deflated ? ".deflated" : ".rle")), width, is_deflated);
    }
  }
  write_scans(folder);
}

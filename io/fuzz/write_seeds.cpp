// Writes small segmentations for the reader's fuzzer to begin with: write_seeds FOLDER
#include <filesystem>
#include <iostream>

#include "io/testing/test_segmentation.h"

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
}

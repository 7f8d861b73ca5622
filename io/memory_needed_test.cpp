// The memory named in a refusal is that of the voxels.
#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdint>
#include <fstream>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "io/errors.h"
#include "io/interchange/voxel_scan.h"
#include "io/load.h"
#include "io/testing/test_coders.h"
#include "io/testing/test_image.h"
#include "solver/text/testing/sanitized.h"

namespace palpate::io {
namespace {

/// What an act is refused with where a GiB more is all the memory that there is.
std::string refusal_of(const std::function<void()>& act) {
  rlimit before{};
  ::getrlimit(RLIMIT_AS, &before);
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  const rlimit little{pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE)) + (1UL << 30U), before.rlim_max};
  ::setrlimit(RLIMIT_AS, &little);
  std::string said = "not refused";
  try {
    act();
  } catch (const DicomError& error) {
    said = error.what();
  }
  ::setrlimit(RLIMIT_AS, &before);
  return said;
}

constexpr int wide = 60000, slices = 2;

std::string needed(const std::string& name, std::uint64_t bytes_a_voxel) {
  const std::uint64_t bytes = bytes_a_voxel * wide * wide * slices;
  return name + " needs more memory than there is: " + std::to_string(bytes / (1U << 20U)) +
         " MiB; close other programs first";
}

// Two bytes a voxel; four where slices are rescaled each in its own way, for then they are kept as floats.
TEST(MemoryNeeded, OfASeriesIsThatOfItsVoxels) {
  if (is_sanitized) GTEST_SKIP() << "sanitizers end a program that asks for too much";
  for (const bool is_float : {false, true}) {
    const internal::TestFolder folder;
    internal::write_stack(folder.path(), slices, [&](int k, internal::TestImage& image) {
      image.syntax = EXS_RLELossless;
      image.edit = [k, is_float](DcmDataset& d) {
        internal::put(d, DCM_Rows, wide);
        internal::put(d, DCM_Columns, wide);
        internal::put(d, DCM_RescaleSlope, std::string(is_float && k == 1 ? "2" : "1"));
        internal::put(d, DCM_RescaleIntercept, std::string("0"));
        internal::encapsulate(d, EXS_RLELossless, {std::vector<Uint8>(15'000'000)}, 1U << 30U);
      };
    });
    const Series series = internal::only_series_in(folder);
    EXPECT_EQ(refusal_of([&] { load(series); }), needed("series 1.2.3.4", is_float ? 4 : 2));
  }
}

// Whole numbers of up to 16 bits take two bytes, all others are kept as floats.
TEST(MemoryNeeded, OfAVoxelFileIsThatOfItsVoxels) {
  if (is_sanitized) GTEST_SKIP() << "sanitizers end a program that asks for too much";
  using Number = VoxelFile::Number;
  for (const auto& [number, bytes] : {std::pair{Number::u8, 2U},
                                      {Number::i8, 2U},
                                      {Number::u16, 2U},
                                      {Number::i16, 2U},
                                      {Number::u32, 4U},
                                      {Number::i64, 4U},
                                      {Number::f32, 4U},
                                      {Number::f64, 4U}}) {
    VoxelFile file;
    file.number = number;
    file.geometry.dimensions = {wide, wide, slices};
    file.geometry.slice_positions = {{0, 0, 0}, {0, 0, 1}};
    EXPECT_EQ(refusal_of([&] { load_voxels(file, "a scan", {}); }), needed("a scan", bytes))
        << static_cast<int>(number);
  }
}

}  // namespace
}  // namespace palpate::io

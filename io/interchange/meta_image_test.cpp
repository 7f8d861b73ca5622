// MetaImage: every voxel where its matrix puts it, packed or not, in one file or in two.
#include <gtest/gtest.h>

#include "io/testing/file_bytes.h"
#include "io/testing/test_image.h"
#include "io/testing/voxel_files.h"

namespace palpate::io::internal {
namespace {

TEST(MetaImage, LiesWhereItsMatrixSays) {
  const TestFolder folder;
  const std::string data = voxels<std::int16_t>();
  write_bytes(folder / "raw.mha", meta_image(meta_place + "ElementDataFile = LOCAL\n") + data);
  write_bytes(folder / "zlib.mha",
              meta_image(meta_place + "CompressedData = True\nElementDataFile = LOCAL\n") + packed(data, 15));
  write_bytes(folder / "apart.mhd", meta_image(meta_place + "ElementDataFile = apart.raw\n"));
  write_bytes(folder / "apart.raw", data);
  write_bytes(folder / "packed.mhd", meta_image(meta_place + "CompressedData = True\nElementDataFile = apart.zraw\n"));
  write_bytes(folder / "apart.zraw", packed(data, 15));
  for (const char* const name : {"raw.mha", "zlib.mha", "apart.mhd", "packed.mhd"}) {
    SCOPED_TRACE(name);
    expect_all(
        only_volume(folder / name), [](int a, int b, int c) { return place_of(meta_rows, a, b, c); }, stored);
  }
}

}  // namespace
}  // namespace palpate::io::internal

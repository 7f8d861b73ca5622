// MetaImage: every voxel at the position of its matrix, packed or not, in one file or in two.
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

// HeaderSize: so many bytes before the voxels; -1 if they are what the file ends with (itk::MetaImageIO).
TEST(MetaImage, VoxelsMayBeginWithinTheirFile) {
  const TestFolder folder;
  write_bytes(folder / "a.raw", "before" + voxels<std::int16_t>());
  for (const char* const size : {"6", "-1"}) {
    SCOPED_TRACE(size);
    write_bytes(folder / "a.mhd", meta_image(meta_place + "HeaderSize = " + size + "\nElementDataFile = a.raw\n"));
    expect_all(
        only_volume(folder / "a.mhd"), [](int a, int b, int c) { return place_of(meta_rows, a, b, c); }, stored);
  }
}

TEST(MetaImage, FieldsGoByEachOfTheirNames) {
  const TestFolder folder;
  const std::string data = voxels<std::int16_t>();
  for (const std::string turn : {"TransformMatrix", "Rotation", "Orientation"}) {
    for (const std::string offset : {"Offset", "Position", "Origin"}) {
      for (const std::string spacing : {"ElementSpacing", "ElementSize"}) {
        SCOPED_TRACE(turn + ' ' + offset + ' ' + spacing);
        write_bytes(folder / "a.mha", meta_image(turn + " = 0.6 0.8 0 -0.8 0.6 0 0 0 -1\n" + offset + " = -12 5 90\n" +
                                                 spacing + " = 0.5 2 3\nElementDataFile = LOCAL\n") +
                                          data);
        expect_all(
            only_volume(folder / "a.mha"), [](int a, int b, int c) { return place_of(meta_rows, a, b, c); }, stored);
      }
    }
  }
  write_bytes(folder / "a.mha", meta_image("ElementDataFile = LOCAL\n") + data);
  expect_all(
      only_volume(folder / "a.mha"), [](int a, int b, int c) { return Vec3(a, b, c); }, stored);
}

}  // namespace
}  // namespace palpate::io::internal

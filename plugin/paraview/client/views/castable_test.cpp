#include "plugin/paraview/client/views/castable.h"

#include <gtest/gtest.h>
#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>

#include <array>

namespace palpate::plugin {
namespace {

// Values of 0, but for one voxel's.
bool can_be_cast_of(int type, std::array<int, 3> size, double greatest, int components = 1) {
  vtkNew<vtkImageData> image;
  image->SetDimensions(size.data());
  image->AllocateScalars(type, components);
  vtkDataArray* const values = image->GetPointData()->GetScalars();
  values->Fill(0);
  values->SetComponent(values->GetNumberOfTuples() / 2, 0, greatest);
  return can_be_cast(*image);
}

TEST(Castable, IsAnyScanOfSixteenBits) {
  EXPECT_TRUE(can_be_cast_of(VTK_SHORT, {2, 3, 4}, 32767));
  EXPECT_TRUE(can_be_cast_of(VTK_UNSIGNED_SHORT, {100, 3, 4}, 65535));
  EXPECT_TRUE(can_be_cast_of(VTK_UNSIGNED_CHAR, {1, 1, 1}, 255));
  EXPECT_FALSE(can_be_cast_of(VTK_SHORT, {20, 30, 40}, 1000, 3));
}

TEST(Castable, IsAScanOfWideNumbersWithinBounds) {
  for (const int type : {VTK_FLOAT, VTK_DOUBLE, VTK_INT}) {
    EXPECT_TRUE(can_be_cast_of(type, {8, 8, 8}, 999'999));
    EXPECT_FALSE(can_be_cast_of(type, {8, 8, 8}, 1'000'001));
    EXPECT_FALSE(can_be_cast_of(type, {7, 8, 8}, 100));
    EXPECT_FALSE(can_be_cast_of(type, {8, 7, 8}, 100));
    EXPECT_FALSE(can_be_cast_of(type, {8, 8, 7}, 100));
  }
}

TEST(Castable, IsNothingWithoutValues) {
  vtkNew<vtkImageData> image;
  image->SetDimensions(8, 8, 8);
  EXPECT_FALSE(can_be_cast(*image));
}

}  // namespace
}  // namespace palpate::plugin

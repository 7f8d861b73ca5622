#include "plugin/paraview/client/views/castable.h"

#include <gtest/gtest.h>
#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>

#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "plugin/paraview/common/value_range.h"

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

// Where nothing was measured: what a velocity, a float scan with padding and one with NaN have there.
TEST(Castable, IsAScanOfFloatsWithPlacesThatWereNotMeasured) {
  constexpr float padding = std::numeric_limits<float>::lowest(), infinite = std::numeric_limits<float>::infinity();
  for (const float unmeasured : {padding, std::nanf("")}) {
    vtkNew<vtkImageData> image;
    image->SetDimensions(9, 8, 10);
    image->SetSpacing(1, 2, 3);
    image->SetOrigin(4, 5, 6);
    image->AllocateScalars(VTK_FLOAT, 1);
    vtkDataArray& values = *image->GetPointData()->GetScalars();
    for (vtkIdType n = 0; n < values.GetNumberOfTuples(); ++n) {
      values.SetComponent(n, 0, n % 3 == 0 ? static_cast<double>(unmeasured) : 0.25 + static_cast<double>(n));
    }
    keep_range(values);
    EXPECT_TRUE(can_be_cast(*image));
    const auto numbers = of_numbers_alone(*image);
    ASSERT_NE(numbers.Get(), image.Get());
    vtkDataArray& cast = *numbers->GetPointData()->GetScalars();
    for (vtkIdType n = 0; n < values.GetNumberOfTuples(); ++n) {
      const double least = 1.25;
      ASSERT_EQ(cast.GetComponent(n, 0), n % 3 == 0 ? least : values.GetComponent(n, 0));
    }
    EXPECT_EQ(std::vector<double>(cast.GetRange(0), cast.GetRange(0) + 2), (std::vector<double>{1.25, 719.25}));
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(numbers->GetDimensions()[axis], image->GetDimensions()[axis]);
      EXPECT_EQ(numbers->GetSpacing()[axis], image->GetSpacing()[axis]);
      EXPECT_EQ(numbers->GetOrigin()[axis], image->GetOrigin()[axis]);
    }
  }
  for (const auto& [type, value] : {std::pair{VTK_FLOAT, 7.F}, {VTK_SHORT, 7.F}, {VTK_DOUBLE, -infinite}}) {
    vtkNew<vtkImageData> image;
    image->SetDimensions(8, 8, 8);
    image->AllocateScalars(type, 1);
    image->GetPointData()->GetScalars()->Fill(value);
    EXPECT_EQ(of_numbers_alone(*image).Get(), image.Get()) << "nothing is to be replaced in type " << type;
  }
}

}  // namespace
}  // namespace palpate::plugin

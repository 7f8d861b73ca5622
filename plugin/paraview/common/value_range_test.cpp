#include "plugin/paraview/common/value_range.h"

#include <gtest/gtest.h>
#include <vtkDataArray.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkShortArray.h>
#include <vtkUnsignedShortArray.h>

#include <array>
#include <limits>
#include <random>

namespace palpate::plugin {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

using Range = std::array<double, 2>;

/// What VTK finds by itself in a copy of the values.
template <typename Array>
void expect_ranges_of_vtk(Array& array) {
  vtkNew<Array> copy;
  for (vtkIdType n = 0; n < array.GetNumberOfValues(); ++n) copy->InsertNextValue(array.GetValue(n));
  Range all, finite;
  copy->GetRange(all.data(), 0);
  copy->GetFiniteRange(finite.data(), 0);
  keep_range(array);
  Range kept_all, kept_finite;
  array.GetRange(kept_all.data(), 0);
  array.GetFiniteRange(kept_finite.data(), 0);
  EXPECT_EQ(kept_all, all);
  EXPECT_EQ(kept_finite, finite);
}

/// Seeded values of all the type's numbers, of 1 to 1000.
template <typename Array>
void expect_ranges_of_random_values() {
  using Value = typename Array::ValueType;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> values(std::numeric_limits<Value>::lowest() / 2.,
                                                std::numeric_limits<Value>::max() / 2.);
  for (int round = 0; round < 50; ++round) {
    vtkNew<Array> array;
    const int count = 1 + static_cast<int>(random() % 1000);
    for (int n = 0; n < count; ++n) array->InsertNextValue(static_cast<Value>(values(random)));
    expect_ranges_of_vtk(*array);
  }
}

TEST(ValueRange, IsThatOfVtk) {
  expect_ranges_of_random_values<vtkShortArray>();
  expect_ranges_of_random_values<vtkUnsignedShortArray>();
  expect_ranges_of_random_values<vtkFloatArray>();
}

TEST(ValueRange, LeavesOutWhatIsNoNumber) {
  vtkNew<vtkFloatArray> array;
  for (const double value : {3., std::numeric_limits<double>::quiet_NaN(), -2., infinite, 5., -infinite}) {
    array->InsertNextValue(static_cast<float>(value));
    array->Modified();
    expect_ranges_of_vtk(*array);
  }
}

// io marks so what was not measured: without this the colors of a flow's volume would reach from -3e38 on.
TEST(ValueRange, LeavesOutWhatWasNotMeasured) {
  vtkNew<vtkFloatArray> array;
  for (const float value : {0.5F, std::numeric_limits<float>::lowest(), -2.F, std::numeric_limits<float>::max()}) {
    array->InsertNextValue(value);
  }
  keep_range(*array);
  constexpr double greatest = std::numeric_limits<float>::max();
  Range range;
  array->GetRange(range.data(), 0);
  EXPECT_EQ(range, (Range{-2, greatest}));
  array->GetFiniteRange(range.data(), 0);
  EXPECT_EQ(range, (Range{-2, greatest}));
}

TEST(ValueRange, OfNothingIsLeftToVtk) {
  vtkNew<vtkFloatArray> array;
  array->InsertNextValue(std::numeric_limits<float>::quiet_NaN());
  expect_ranges_of_vtk(*array);
  vtkNew<vtkShortArray> empty;
  expect_ranges_of_vtk(*empty);
}

// What is kept is what is answered: a range that is not the values' own shows that VTK makes no pass of its own.
TEST(ValueRange, IsNotSoughtAgainUntilTheArrayIsModified) {
  vtkNew<vtkShortArray> array;
  array->InsertNextValue(1);
  array->InsertNextValue(4);
  keep_range(*array);
  array->GetPointer(0)[0] = -9;  // behind VTK's back
  Range range;
  array->GetRange(range.data(), 0);
  EXPECT_EQ(range, (Range{1, 4}));
  array->GetFiniteRange(range.data(), 0);
  EXPECT_EQ(range, (Range{1, 4}));
  array->Modified();
  array->GetRange(range.data(), 0);
  EXPECT_EQ(range, (Range{-9, 4}));
}

}  // namespace
}  // namespace palpate::plugin

// The body alone, of a CT in which something lies around it.

#include "plugin/paraview/client/views/body_of.h"

#include <gtest/gtest.h>
#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>

#include <cmath>

#include "plugin/paraview/common/body_mask.h"

namespace palpate::plugin {
namespace {

// Sizes that are no multiples of the mask's steps.
constexpr int columns_of_ct = 101, rows_of_ct = 118, slices_of_ct = 41;
constexpr double around_hu = -1000, body_hu = 40, table_hu = -150, least_hu = -1010;

/// A body of 30 mm about the middle axis; 10 mm behind it a table, where there is one. One voxel has the least value.
void make_body(vtkImageData& image, int type, bool has_table) {
  image.SetDimensions(columns_of_ct, rows_of_ct, slices_of_ct);
  image.SetSpacing(0.8, 0.8, 1.5);
  image.SetOrigin(3, 4, 5);
  image.AllocateScalars(type, 1);
  vtkDataArray& values = *image.GetPointData()->GetScalars();
  values.SetName("HU");
  vtkIdType at = 0;
  for (int k = 0; k < slices_of_ct; ++k) {
    for (int j = 0; j < rows_of_ct; ++j) {
      for (int i = 0; i < columns_of_ct; ++i) {
        const double x = 0.8 * (i - 50), y = 0.8 * (j - 50);
        const bool on_table = has_table && y > 40 && y < 48;
        values.SetComponent(at++, 0, std::hypot(x, y) < 30 ? body_hu : on_table ? table_hu : around_hu);
      }
    }
  }
  values.SetComponent(0, 0, least_hu);
}

TEST(BodyOf, HasTheBodysValuesAndTheLeastAroundIt) {
  for (const int type : {VTK_SHORT, VTK_FLOAT, VTK_DOUBLE}) {
    vtkNew<vtkImageData> image;
    make_body(*image, type, true);
    vtkDataArray& whole = *image->GetPointData()->GetScalars();
    const BodyMask body =
        body_mask([&](int i, int j, int k) { return whole.GetComponent((k * rows_of_ct + j) * columns_of_ct + i, 0); },
                  {columns_of_ct, rows_of_ct, slices_of_ct}, {0.8, 0.8, 1.5}, Rim::one_voxel);
    const auto cut = body_of(*image, {});
    ASSERT_NE(cut, nullptr) << type;
    vtkDataArray& kept = *cut->GetPointData()->GetScalars();
    ASSERT_EQ(kept.GetDataType(), type);
    ASSERT_EQ(kept.GetNumberOfTuples(), whole.GetNumberOfTuples());
    EXPECT_STREQ(kept.GetName(), "HU");
    vtkIdType at = 0;
    for (int k = 0; k < slices_of_ct; ++k) {
      for (int j = 0; j < rows_of_ct; ++j) {
        for (int i = 0; i < columns_of_ct; ++i, ++at) {
          ASSERT_EQ(kept.GetComponent(at, 0), body.holds(i, j, k) ? whole.GetComponent(at, 0) : least_hu)
              << i << ", " << j << ", " << k;
        }
      }
    }
    EXPECT_EQ(kept.GetRange(0)[0], least_hu);
    EXPECT_EQ(kept.GetRange(0)[1], body_hu);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(cut->GetDimensions()[axis], image->GetDimensions()[axis]);
      EXPECT_EQ(cut->GetSpacing()[axis], image->GetSpacing()[axis]);
      EXPECT_EQ(cut->GetOrigin()[axis], image->GetOrigin()[axis]);
    }
  }
}

TEST(BodyOf, IsNothingWhereNothingLiesAroundIt) {
  vtkNew<vtkImageData> image, empty;
  make_body(*image, VTK_SHORT, false);
  EXPECT_EQ(body_of(*image, {}), nullptr);
  empty->SetDimensions(8, 8, 8);
  EXPECT_EQ(body_of(*empty, {}), nullptr);
}

/// Another scan is chosen while the body of the one before is sought: the views are not closed before the work ends.
TEST(BodyOf, EndsAtTheNextSliceWhereNobodyWantsIt) {
  vtkNew<vtkImageData> image;
  make_body(*image, VTK_SHORT, true);
  int all = 0;
  ASSERT_NE(body_of(*image, [&] { return ++all > 0; }), nullptr);
  // Read, told apart, grown and copied, slice by slice; three of those on a lattice of 3 mm.
  EXPECT_GE(all, 3 * ((slices_of_ct + 1) / 2) + slices_of_ct);
  for (const int wanted : {0, 1, all / 3, all / 2, all - 1}) {
    int asked = 0;
    EXPECT_THROW(body_of(*image, [&] { return ++asked <= wanted; }), io::Cancelled);
    EXPECT_EQ(asked, wanted + 1) << "it is asked no more";
  }
}

}  // namespace
}  // namespace palpate::plugin

#pragma once

/// The range of an array's values, computed in one fast pass and kept where VTK looks for it. VTK's own pass takes
/// 25 ns a value, on the thread that paints (`first_image` in plugin/docs/measurements.md).

class vtkDataArray;

namespace palpate::plugin {

/// Of an array with one component of 16-bit integers or floats; others are left to VTK, as are those without a finite
/// value. The range is VTK's until the array is modified.
void keep_range(vtkDataArray& array);

}  // namespace palpate::plugin

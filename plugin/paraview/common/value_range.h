#pragma once

/// Computes the range of an array's values in one fast pass and stores it where VTK looks for it. VTK's own pass is
/// slower, and runs on the UI thread.

class vtkDataArray;

namespace palpate::plugin {

/// For an array with one component of 16-bit integers or floats; others are left to VTK, and so are arrays without a
/// finite value. The lowest float marks missing data, and does not count. The range is VTK's until the array is
/// modified.
void keep_range(vtkDataArray& array);

}  // namespace palpate::plugin

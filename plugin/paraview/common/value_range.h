#pragma once

/// The range of an array's values, computed in one fast pass and kept where VTK looks for it: its own pass is slower,
/// and runs on the thread that paints.

class vtkDataArray;

namespace palpate::plugin {

/// Of an array with one component of 16-bit integers or floats; others are left to VTK, as are those without a finite
/// value. The least float there is says that nothing was measured, and does not count. The range is VTK's until the
/// array is modified.
void keep_range(vtkDataArray& array);

}  // namespace palpate::plugin

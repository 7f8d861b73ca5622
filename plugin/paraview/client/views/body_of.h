#pragma once

#include <vtkSmartPointer.h>

#include "plugin/paraview/common/keep_going.h"

class vtkImageData;

namespace palpate::plugin {

/// A copy of a CT (one number a voxel, HU) in which everything outside the body has the scan's least value. Null if
/// nothing solid lies around the body. The image is only read, and needs the range of its values. Takes some tenths of
/// a second, on any thread. Throws io::Cancelled.
vtkSmartPointer<vtkImageData> body_of(vtkImageData& image, const KeepGoing& keep_going);

}  // namespace palpate::plugin

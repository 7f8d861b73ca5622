#pragma once

/// A volume's voxels as a VTK array, without a copy.

#include <vtkSmartPointer.h>
#include <cstddef>
#include <memory>

#include "PalpateServerModule.h"
#include "io/volume.h"

class vtkDataArray;

namespace palpate::plugin {

/// An array that views `count` voxels from `first` on. The volume lives as long as the array, or any shallow copy of
/// it. VTK must not write into it, because others read the same voxels.
vtkSmartPointer<vtkDataArray> share_voxels(const std::shared_ptr<const io::Volume>& volume, std::size_t first,
                                           std::size_t count);

/// The same of `count` values from `first` on of an array that views a volume's voxels; null for any other array.
vtkSmartPointer<vtkDataArray> share_part(vtkDataArray& array, std::size_t first, std::size_t count);

/// Ties a volume to an array with values of its own that shows the volume resampled: volume_behind() finds it. The
/// array has to have allocated its values itself.
void tie_to_volume(vtkDataArray& array, const std::shared_ptr<const io::Volume>& volume);

/// The volume that the array, or a shallow copy of it, shows; none for any other array. From any thread.
std::shared_ptr<const io::Volume> volume_behind(vtkDataArray& array);

/// How many buffers keep a volume alive at the moment.
std::size_t shared_array_count();

}  // namespace palpate::plugin

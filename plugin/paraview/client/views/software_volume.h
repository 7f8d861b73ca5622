#pragma once

/// Drawing a volume without a graphics card. There ParaView's own volume rendering, which is written for one, takes
/// seconds for a picture. VTK's ray caster for processors takes a fraction of that, once it has the gradients of all
/// voxels: they take seconds too, and are computed ahead, off the thread that paints.

#include <vtkSmartPointer.h>

#include <functional>

class vtkFixedPointVolumeRayCastMapper;
class vtkImageData;
class vtkMatrix4x4;
class vtkVolumeProperty;

namespace palpate::plugin {

/// Whether this program's pictures are drawn by the processor. Asked once, on the thread that paints.
bool draws_without_card();

/// Work for another thread, made on the one that paints: returns a mapper that has all that it needs for its first
/// picture; null where it is not to go on. It draws every `step`-th voxel along each axis, and leaves the image's
/// origin and directions to place_of().
using PrepareToCast =
    std::function<vtkSmartPointer<vtkFixedPointVolumeRayCastMapper>(const std::function<bool()>& keep_going)>;
PrepareToCast preparing_to_cast(vtkImageData& image, int step);

/// Colors and opacities are shared; the light is made such that a picture is as bright as a graphics card's.
void light_for_casting(vtkVolumeProperty& theirs, vtkVolumeProperty& ours);

/// From the voxels' own axes, in mm, to the patient's.
vtkSmartPointer<vtkMatrix4x4> place_of(vtkImageData& image);

}  // namespace palpate::plugin

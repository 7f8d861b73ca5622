#pragma once

/// Draws a volume without a graphics card. ParaView's own volume rendering is made for graphics cards, and then takes
/// seconds for a picture. VTK's software ray caster takes a fraction of that, once the gradients of all voxels exist.
/// These also take seconds, and are computed beforehand in another thread.

#include <vtkSmartPointer.h>

#include <functional>

class vtkFixedPointVolumeRayCastMapper;
class vtkImageData;
class vtkMatrix4x4;
class vtkVolumeProperty;

namespace palpate::plugin {

/// Whether this program's pictures are drawn by the processor. Determined once, on the UI thread.
bool draws_without_card();

/// A function made on the UI thread, to be run on another. It returns a mapper that is ready for its first picture, or
/// null if keep_going returns false. It draws every `step`-th voxel along each axis, and ignores the image's origin and
/// directions: see place_of().
using PrepareToCast =
    std::function<vtkSmartPointer<vtkFixedPointVolumeRayCastMapper>(const std::function<bool()>& keep_going)>;
PrepareToCast preparing_to_cast(vtkImageData& image, int step);

/// Shares colors and opacities; sets the lighting so that a picture is as bright as a graphics card's.
void light_for_casting(vtkVolumeProperty& theirs, vtkVolumeProperty& ours);

/// The transformation from the voxels' own axes, in mm, to the patient's.
vtkSmartPointer<vtkMatrix4x4> place_of(vtkImageData& image);

}  // namespace palpate::plugin

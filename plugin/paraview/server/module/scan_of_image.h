#pragma once

/// From an image in the pipeline back to a scan that can be felt.

#include <array>
#include <memory>
#include <string>

#include "io/volume.h"
#include "modes/scene/scene.h"

class vtkImageData;

namespace palpate::plugin {

/// The volume that the image's active point scalars show, where a Palpate reader made them, also where the image is a
/// part or an even copy of it; else a volume of its own from any image with one scalar component. Throws
/// std::invalid_argument for an image that has none.
std::shared_ptr<const io::Volume> scan_of(vtkImageData& image);

/// Whether the image's points are voxels of the volume, and which is the first of them.
struct VoxelBlock {
  bool aligned = false;
  std::array<int, 3> first{};
};
VoxelBlock block_of(vtkImageData& image, const io::Volume& volume);

/// A scene given as JSON, as the name of a starting scene or as a file; without modes where it is empty. Throws
/// std::invalid_argument as modes::scene_from_json() and modes::load_scene() do.
modes::Scene scene_of(const std::string& text);
/// The same; the one that suits the modality where it is empty.
modes::Scene scene_of(const std::string& text, const io::Volume& volume);

/// The gradient's scale (mm) that a scene asks for; 0 where it leaves it to the scan, or is no scene.
double gradient_scale_of(const std::string& text);

}  // namespace palpate::plugin

#pragma once

/// Finds the scan that an image in the pipeline shows.

#include <array>
#include <memory>
#include <string>

#include "io/volume.h"
#include "modes/scene/scene.h"

class vtkImageData;

namespace palpate::plugin {

/// The volume that the active point scalars of the image show, if a Palpate reader made them. The image may be a part
/// or an even copy of the volume. For any other image with one scalar component: a new volume with its values. Throws
/// std::invalid_argument for an image without one.
std::shared_ptr<const io::Volume> scan_of(vtkImageData& image);

/// Whether the image's points are voxels of the volume, and the first of them.
struct VoxelBlock {
  bool aligned = false;
  std::array<int, 3> first{};
};
VoxelBlock block_of(vtkImageData& image, const io::Volume& volume);

/// A scene given as JSON, as the name of a starting scene or as a file; without modes if the text is empty. Throws
/// std::invalid_argument as modes::scene_from_json() and modes::load_scene() do.
modes::Scene scene_of(const std::string& text);
/// The same. Empty: the starting scene that suits the modality.
modes::Scene scene_of(const std::string& text, const io::Volume& volume);

/// The scale of the gradient (mm) that a scene asks for; 0 if it asks for none, or if the text is not a scene.
double gradient_scale_of(const std::string& text);

}  // namespace palpate::plugin

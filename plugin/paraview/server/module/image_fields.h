#pragma once

/// The core's fields at every point of an image, as VTK arrays.

#include <vtkSmartPointer.h>

#include <memory>
#include <string>
#include <vector>

#include "io/progress.h"
#include "io/volume.h"
#include "modes/scene/scene.h"

class vtkFloatArray;
class vtkImageData;

namespace palpate::plugin {

inline constexpr const char* gradient_name = "Gradient";
inline constexpr const char* magnitude_name = "Gradient magnitude";
inline constexpr const char* felt_name = "Felt strength";

struct FieldChoice {
  bool gradient = false;   ///< per mm, patient axes
  bool magnitude = false;  ///< per mm
  bool felt = false;       ///< N
  modes::Scene scene;      ///< what is felt; its gradient scale holds for all three
  std::string mode;        ///< name of the mode that is felt; empty: all surfaces
};

/// The chosen fields of the volume at the points of the image; zero outside the volume, in gaps and in padding. At a
/// point that is a voxel they are those of the voxel (felt strength: modes/scene/felt_strength.h). Elsewhere they are
/// sampled. Uses all cores. Throws std::invalid_argument for a mode that the scene does not have, and io::Cancelled.
std::vector<vtkSmartPointer<vtkFloatArray>> fields_of(vtkImageData& image,
                                                      const std::shared_ptr<const io::Volume>& volume,
                                                      const FieldChoice& choice, const io::Progress& progress);

/// Voxels on each side that a gradient of that scale may read, on any axis; scale 0: the default for that spacing.
int furthest_reach(const double* spacing_mm, double scale_mm);

}  // namespace palpate::plugin

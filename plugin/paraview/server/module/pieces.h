#pragma once

/// What a rank of a parallel server has of an image: its own part, and its neighbors' voxels around that (ghosts).

#include <array>

class vtkImageData;
class vtkInformation;

namespace palpate::plugin {

/// How many ranks share what is asked for, and the ghost levels asked for.
int pieces_of(vtkInformation& output);
int ghosts_of(vtkInformation& output);

/// Asks for `more` ghost levels than are asked of the output.
void ask_for_ghosts(vtkInformation& input, vtkInformation& output, int more);

/// The part of the image's extent that is the rank's own, grown by `ghosts` within the image.
std::array<int, 6> own_extent(vtkImageData& image, int ghosts);

/// Cuts an image to an extent within its own. The scan's voxels are shared, not copied, where they are whole slices.
void cut_to(const std::array<int, 6>& extent, vtkImageData& image);

}  // namespace palpate::plugin

#pragma once

/// The piece of an image that a rank of a parallel server has: its own part, and voxels of its neighbors around that
/// part (ghosts).

#include <array>

class vtkImageData;
class vtkInformation;

namespace palpate::plugin {

/// How many ranks share the requested image, and the requested ghost levels.
int pieces_of(vtkInformation& output);
int ghosts_of(vtkInformation& output);

/// Requests `more` ghost levels from the input than are requested from the output.
void ask_for_ghosts(vtkInformation& input, vtkInformation& output, int more);

/// The part of the image's extent that is the rank's own, grown by `ghosts` within the image.
std::array<int, 6> own_extent(vtkImageData& image, int ghosts);

/// Removes the arrays that mark points and cells as other ranks': a byte for each.
void remove_ghost_marks(vtkImageData& image);

/// Cuts an image to an extent within its own. The scan's voxels are shared, not copied, where they are whole slices.
void cut_to(const std::array<int, 6>& extent, vtkImageData& image);

}  // namespace palpate::plugin

#pragma once

/// What the client knows of an image without its voxels: asked of the server.

#include <vtkSmartPointer.h>

#include <array>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "plugin/paraview/common/scan_look.h"

class vtkSMProxy;
class vtkSMSourceProxy;

namespace palpate::plugin {

struct ImageLattice {
  glm::ivec3 dimensions{1};
  glm::dvec3 spacing{1};
  std::array<glm::dvec3, 3> directions{glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)};  ///< unit
  glm::dvec3 origin{0};
  std::string array;               ///< name of the point scalars
  bool counted_from_last = false;  ///< the scanner's image numbers descend along the slices
  Values values;

  glm::dvec3 center() const;
};

/// Of a source that is up to date; from a remote server, one question and answer of a tenth of a second. Throws
/// std::runtime_error where it gives no image.
ImageLattice lattice_of(vtkSMSourceProxy& source);

/// The value of the voxel nearest to a place in the patient (mm); none outside and in gaps. Asked of the server.
class ValueProbe {
 public:
  explicit ValueProbe(vtkSMSourceProxy& reader);
  std::optional<double> at(const glm::dvec3& place);
  /// Below the n-th are n percent of the voxels; empty if that is not known.
  std::vector<double> shares();
  /// Of the patient's body, what is as light as lungs, 0 to 1; none if that is not known.
  std::optional<double> light_part();

 private:
  vtkSmartPointer<vtkSMProxy> proxy_;
};

}  // namespace palpate::plugin

#pragma once

/// Facts about an image that a client gets from the server, without its voxels.

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

/// For a source that is up to date. On a remote server, one request that takes a tenth of a second. Throws
/// std::runtime_error if the source gives no image.
ImageLattice lattice_of(vtkSMSourceProxy& source);

/// The value of the voxel nearest to a place in the patient (mm); none outside and in gaps. Requested from the server.
class ValueProbe {
 public:
  explicit ValueProbe(vtkSMSourceProxy& reader);
  std::optional<double> at(const glm::dvec3& place);
  /// Percentiles: n percent of the voxels are below the n-th; empty if unknown.
  std::vector<double> shares();
  /// The fraction of the patient's body that is as light as lungs, 0 to 1; none if unknown.
  std::optional<double> light_part();

 private:
  vtkSmartPointer<vtkSMProxy> proxy_;
};

}  // namespace palpate::plugin

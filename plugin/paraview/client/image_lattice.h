#pragma once

/// What the client knows of an image without its voxels: asked of the server.

#include <array>
#include <glm/vec3.hpp>
#include <string>

class vtkSMSourceProxy;

namespace palpate::plugin {

struct ImageLattice {
  glm::ivec3 dimensions{1};
  glm::dvec3 spacing{1};
  std::array<glm::dvec3, 3> directions{glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)};  ///< unit
  glm::dvec3 origin{0};
  std::string array;        ///< name of the point scalars
  bool hounsfield = false;  ///< whether their unit is HU
  double low = 0;           ///< least value
  double high = 1;

  glm::dvec3 center() const;
};

/// Of a source that is up to date. Throws std::runtime_error where it gives no image.
ImageLattice lattice_of(vtkSMSourceProxy& source);

}  // namespace palpate::plugin

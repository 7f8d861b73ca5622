#pragma once

/// The felt boundaries as shaded surfaces in their own colors, in the volume view.

#include <array>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "io/volume.h"
#include "plugin/paraview/client/views/clinical_views.h"
#include "plugin/paraview/client/views/felt_contours.h"

namespace palpate::plugin {

/// The surface of one of the scene's modes: triangles in patient space, mm.
struct FeltSurface {
  std::size_t mode = 0;
  double opacity = 1;  ///< by its strength, relative to the strongest
  std::vector<glm::vec3> points;
  std::vector<glm::vec3> normals;
  std::vector<std::array<int, 3>> triangles;
};

/// As felt_contours(), on the whole scan, on a lattice of at most some millions of its voxels. Takes up to seconds.
/// Throws io::Cancelled.
std::vector<FeltSurface> felt_surfaces(const io::Volume& volume, const modes::Scene& scene, const modes::Plan& plan,
                                       const io::FieldSource& source, const KeepGoing& keep_going);

/// Draws the surfaces. While they are visible, the scan is not.
class FeltSurfaces {
 public:
  FeltSurfaces();
  ~FeltSurfaces();
  FeltSurfaces(const FeltSurfaces&) = delete;
  FeltSurfaces& operator=(const FeltSurfaces&) = delete;

  /// The views of a new scan; empty: none. The surfaces are hidden at first.
  void set_views(const std::vector<ClinicalView>& views);
  void set_visible(bool visible);
  /// As BoundaryContours::set_felt(); null: nothing is drawn. Computed in the background while visible. Meanwhile the
  /// surfaces of the same volume stay; those of another are removed at once.
  void set_felt(const std::shared_ptr<const io::Volume>& volume, const modes::Scene& scene,
                const std::shared_ptr<const modes::Plan>& plan, const std::shared_ptr<const io::FieldSource>& source);

 private:
  struct Felt;
  struct One;
  void draw();

  std::shared_ptr<const Felt> felt_;
  std::unique_ptr<One> one_;
  bool visible_ = false;
};

}  // namespace palpate::plugin

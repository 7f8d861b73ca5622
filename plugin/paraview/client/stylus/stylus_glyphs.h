#pragma once

/// Stylus, proxy, the spring between them, the primitives that act and the force, in one view: over all else, faint
/// where the patient hides them. Only their matrices move.

#include <vtkSmartPointer.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "modes/scene/scene.h"
#include "plugin/paraview/client/panel/session_controller.h"

class vtkBillboardTextActor3D;
class vtkPVRenderView;

namespace palpate::plugin {

class OverlayLayer;

class StylusGlyphs {
 public:
  explicit StylusGlyphs(vtkPVRenderView& view);
  StylusGlyphs(const StylusGlyphs&) = delete;
  StylusGlyphs& operator=(const StylusGlyphs&) = delete;
  ~StylusGlyphs();

  /// `faint`: 0 to 1, how much of it is hidden; `mm_per_pixel` keeps their size on the screen.
  /// `caption`: beside the stylus; empty: none.
  void show(const SessionStatus& look, const modes::Scene& scene, double faint, double mm_per_pixel,
            const std::string& caption = {});
  void hide();

 private:
  struct Part;
  std::unique_ptr<Part> add(int shape);

  std::unique_ptr<OverlayLayer> layer_;
  vtkSmartPointer<vtkBillboardTextActor3D> caption_;
  std::unique_ptr<Part> stylus_, proxy_, spring_, force_, tip_;
  std::vector<std::unique_ptr<Part>> planes_, rods_, balls_;
};

}  // namespace palpate::plugin

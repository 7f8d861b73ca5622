#pragma once

/// Draws in one view the stylus, the proxy, the spring between them, the acting primitives and the force. They are in
/// front of everything else, and faint where the patient hides them. Only their matrices change.

#include <vtkSmartPointer.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "modes/scene/scene.h"
#include "plugin/paraview/client/model/session_controller.h"

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

  /// `faint`: 0 to 1, the degree to which it is hidden; `mm_per_pixel` keeps its size on the screen constant.
  /// `caption`: beside the stylus; empty: none.
  void show(const SessionStatus& look, const modes::Scene& scene, double faint, double mm_per_pixel,
            const std::string& caption = {});
  void hide();

 private:
  struct Part;
  struct Drawing;
  std::unique_ptr<Part> add(int shape);
  void show_stylus(const SessionStatus& look, const Drawing& how);
  void show_spring(const SessionStatus& look, const Drawing& how);
  void show_force(const SessionStatus& look, const Drawing& how);
  void show_shares(const SessionStatus& look, const modes::Scene& scene, const Drawing& how);

  std::unique_ptr<OverlayLayer> layer_;
  vtkSmartPointer<vtkBillboardTextActor3D> caption_;
  std::unique_ptr<Part> stylus_, proxy_, spring_, force_, tip_, handle_, fin_;
  std::unique_ptr<Part> dark_stylus_, dark_proxy_, dark_spring_;  // their rims
  std::vector<std::unique_ptr<Part>> planes_, rods_, balls_;
};

}  // namespace palpate::plugin

#pragma once

/// One slice on the screen: letters at its edges, what it shows in a corner, and a radiologist's mouse: left drag for
/// the window, the wheel for the slice.

#include <QObject>
#include <QPointer>

#include <array>
#include <functional>
#include <memory>

#include "anatomy.h"
#include "colour_maps.h"

class pqRenderView;
class vtkSMProxy;

namespace palpate::plugin {

/// What the slice views of a scan have in common.
struct SharedWindow {
  vtkSMProxy* grey_map = nullptr;
  Window window;
  std::function<void()> changed;  ///< after the window has been changed by hand
};

struct SliceSetup {
  Plane plane = Plane::axial;
  Sight sight;
  int slices = 1;
  int slice = 0;
  double first_mm = 0;      ///< of the first slice along `sight.along`, in patient space
  double pitch_mm = 1;      ///< from slice to slice along `sight.along`; negative where they run towards the eye
  glm::dvec3 center_mm{0};  ///< of the volume
  double half_height_mm = 100;
  double half_width_mm = 100;
};

/// Belongs to its view and goes with it.
class SliceView : public QObject {
 public:
  SliceView(pqRenderView& view, vtkSMProxy& representation, const SliceSetup& setup,
            std::shared_ptr<SharedWindow> window);
  ~SliceView() override;

  void show_slice(int slice);
  /// The slice nearest to a place in the patient, mm; drawn anew only where it is another one.
  void show_point(const glm::dvec3& place);
  void refresh_text();

 private:
  class Overlay;
  class Mouse;
  void place_camera();

  pqRenderView& view_;
  vtkSMProxy& representation_;
  SliceSetup setup_;
  std::shared_ptr<SharedWindow> window_;
  std::unique_ptr<Overlay> overlay_;
  std::unique_ptr<Mouse> mouse_;
};

}  // namespace palpate::plugin

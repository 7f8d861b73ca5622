#pragma once

/// One slice on the screen: letters at its edges, what it shows in a corner, and what is under the
/// pointer in another, and a radiologist's mouse: left drag for the window, the wheel for the slice.

#include <QObject>
#include <QPointer>
#include <QString>

#include <array>
#include <functional>
#include <memory>
#include <optional>

#include "plugin/paraview/client/views/anatomy.h"
#include "plugin/paraview/client/views/color_maps.h"

class pqRenderView;
class vtkSMProxy;

namespace palpate::plugin {

class SliceOverlay;

/// What the left button does while places are being picked.
enum class Pick { pressed, moved, let_go };

/// What the slice views of a scan have in common.
struct SharedWindow {
  vtkSMProxy* gray_map = nullptr;
  Window window;
  std::function<void()> changed;  ///< after the window has been changed by hand
  Coordinates coordinates = Coordinates::letters;
  /// Of the voxel nearest to a place in the patient, mm; may be empty.
  std::function<std::optional<double>(const glm::dvec3& place)> value_at;
  QString unit;
  /// Gets the left button instead of the window while it is set.
  std::function<void(Pick, const glm::dvec3& place)> pick;
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
  bool keeps_camera = false;  ///< a state file has placed it
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
  class Mouse;
  void place_camera();
  glm::dvec3 place_under(int x, int y) const;
  void tell_of(int x, int y);
  void set_pointer_text(const QString& text);

  pqRenderView& view_;
  vtkSMProxy& representation_;
  SliceSetup setup_;
  std::shared_ptr<SharedWindow> window_;
  std::unique_ptr<SliceOverlay> overlay_;
  std::unique_ptr<Mouse> mouse_;
};

}  // namespace palpate::plugin

#pragma once

/// One slice on the screen: letters at its edges, and in its corners the image, the patient, the position, and the
/// place under the pointer.

#include <QObject>
#include <QPointer>
#include <QString>

#include <vtkSMProxy.h>
#include <vtkWeakPointer.h>

#include <array>
#include <functional>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>

#include "plugin/paraview/client/views/anatomy.h"
#include "plugin/paraview/client/views/color_maps.h"
#include "plugin/paraview/client/views/slice_numbers.h"

class pqRenderView;
class vtkSMProxy;

namespace palpate::plugin {

class SliceMeasures;
class SliceMouse;
class SliceOverlay;
class SliceScrollBar;
class SliceView;

/// The measurement that the next drag in a slice makes.
enum class Measure { none, ruler, angle };

/// The left button's events while places are being picked.
enum class Pick { pressed, moved, let_go };

/// The common state of a scan's slice views.
struct SharedWindow {
  vtkWeakPointer<vtkSMProxy> gray_map;
  Window window;
  std::function<void()> changed;  ///< called after the user has changed the window
  Coordinates coordinates = Coordinates::letters;
  /// The value of the voxel nearest to a place in the patient, mm; may be empty.
  std::function<std::optional<double>(const glm::dvec3& place)> value_at;
  QString unit;
  /// Called with the place under the pointer while the pointer is moved with Shift held down.
  std::function<void(const glm::dvec3& place)> pointed_with_shift;
  /// Called for the keys 1 to 9.
  std::function<void(int)> digit_pressed;
  /// Called with the place under the pointer when it has moved, and with none when it has left.
  std::function<void(const std::optional<glm::dvec3>&)> pointed;
  /// If set, gets the left button, which then does not adjust the window.
  std::function<void(Pick, const glm::dvec3& place)> pick;
  Measure measure = Measure::none;
  /// Called when the type of measurement changes; it may be none.
  std::function<void(Measure)> measure_wanted;
  /// Called for the key I.
  std::function<void()> texts_toggled;
  bool texts_shown = true;
  /// Patient, series and date, in lines; only on the screen.
  QString identity;
  QString frame;            ///< "frame 3 of 17"; empty if there is one
  QString window_name;      ///< of the window
  double thickness_mm = 0;  ///< of the slices as scanned; 0: unknown
  /// Called when the user goes to another slice.
  std::function<void()> leafed;
  std::function<void(SliceView&)> slice_shown;
};

struct SliceSetup {
  Plane plane = Plane::axial;
  Sight sight;
  int slices = 1;
  int slice = 0;
  SliceNumbers numbers;
  bool as_scanned = false;  ///< the scanner's own slices, not slices perpendicular to them
  double pixel_mm = 1;      ///< the smaller side of a voxel in the slice
  double first_mm = 0;      ///< of the first slice along `sight.along`, in patient space
  double pitch_mm = 1;      ///< from slice to slice along `sight.along`; negative if the slices run towards the eye
  glm::dvec3 center_mm{0};  ///< of the volume
  double half_height_mm = 100;
  double half_width_mm = 100;
  bool keeps_camera = false;  ///< a state file has set it
};

/// Belongs to its view and is deleted with it.
class SliceView : public QObject {
 public:
  SliceView(pqRenderView& view, vtkSMProxy& representation, const SliceSetup& setup,
            std::shared_ptr<SharedWindow> window);
  ~SliceView() override;

  void show_slice(int slice);
  /// Shows the slice nearest to a place in the patient, mm; redraws only if the slice changes.
  void show_point(const glm::dvec3& place);
  void refresh_text();
  /// Patient identity and scroll bar are hidden in saved pictures.
  void set_for_picture(bool for_picture);
  /// Updates the text about the place under the pointer, if it is in the view.
  void refresh_pointer();
  /// The signed distance of a place from the shown slice, mm along wheel_direction().
  double off_plane_mm(const glm::dvec3& place) const;
  /// Half the distance to the next slice, mm: nearer places belong to this slice.
  double half_pitch_mm() const;
  /// Whether a place is clearly visible: inside the view and under none of its texts.
  bool shows(const glm::dvec3& place) const;
  Plane plane() const { return setup_.plane; }
  const Sight& sight() const { return setup_.sight; }
  /// Half the size of the scan as this view sees it, mm: to the right and up.
  glm::dvec2 half_size_mm() const { return {setup_.half_width_mm, setup_.half_height_mm}; }
  /// A place on the shown slice, mm to the right and up from the middle of the scan.
  glm::dvec3 place_at(const glm::dvec2& off_middle_mm) const;
  /// The place on the shown slice under a pixel, counted from the left and from below.
  glm::dvec3 place_under(int x, int y) const;
  /// The index of the shown slice, from 0.
  int slice() const { return setup_.slice; }

 private:
  friend class SliceMouse;
  void place_camera();
  /// Steps of the wheel: towards the patient's head, front or left for +1.
  void leaf(int steps);
  /// To this fraction of the way up, 0 to 1.
  void scroll_to(double part);
  bool runs_upwards() const;
  void tell_place(int height_pixels);
  bool tell_of(int x, int y);

  pqRenderView& view_;
  vtkWeakPointer<vtkSMProxy> representation_;  // deleted with the scan
  SliceSetup setup_;
  std::shared_ptr<SharedWindow> window_;
  std::unique_ptr<SliceOverlay> overlay_;
  std::optional<std::array<int, 2>> pointer_;  // while it is in the view
  std::unique_ptr<SliceScrollBar> bar_;
  std::unique_ptr<SliceMouse> mouse_;
  std::unique_ptr<SliceMeasures> measures_;
};

}  // namespace palpate::plugin

#pragma once

/// The scan in the volume view as a patient: without table and headrest, and cropped by a box with handles. ParaView's
/// own representation stays in the pipeline with its colors and opacity; while something is cut away, a copy is drawn
/// in its place. Of several frames the shown one is drawn. Only for scans in this process: a server's scan is drawn as
/// ParaView draws it.

#include <vtkSmartPointer.h>

#include <QObject>
#include <QPointer>

#include <functional>
#include <memory>

#include "plugin/paraview/client/jobs/job.h"
#include "plugin/paraview/client/views/casting.h"

class pqPipelineSource;
class pqRenderView;
class vtkImageData;
class vtkVolume;

namespace palpate::plugin {

class CropBox;
class EventWatch;

class PatientVolume {
 public:
  /// Searches the body in the background, if the scan has HU and one frame. `changed` is called when can_cut() is
  /// known. Then, or after 3 s, the volume is drawn, but always after the slices: without a graphics card its picture
  /// takes seconds.
  PatientVolume(pqRenderView& view, pqPipelineSource& scan, bool hounsfield, std::function<void()> changed);
  PatientVolume(const PatientVolume&) = delete;
  PatientVolume& operator=(const PatientVolume&) = delete;
  ~PatientVolume();

  /// Whether there is anything outside the body that can be cut away.
  bool can_cut() const { return cut_image_ != nullptr; }
  /// Cuts away table and headrest, if they were found; on at first.
  void set_cut(bool cut);
  /// Whether the scan is in this process, and can be cropped.
  bool can_crop() const { return whole_image_ != nullptr; }
  void set_cropped(bool cropped);
  /// True: the scan is not drawn, because something else is shown in its place.
  void set_hidden(bool hidden);

 private:
  void take_image();
  void begin_to_draw();
  void refresh();
  void draw_ours(vtkVolume& theirs, vtkImageData& image, bool cast);
  void take_out(vtkVolume& theirs, bool out);
  vtkVolume* of_paraview() const;
  bool is_shown() const;

  QPointer<pqRenderView> view_;
  QPointer<pqPipelineSource> scan_;
  bool hounsfield_;
  std::function<void()> changed_;
  vtkSmartPointer<vtkImageData> whole_image_, cut_image_;
  vtkSmartPointer<vtkVolume> own_;
  std::unique_ptr<EventWatch> look_watch_;  // watches the properties of ParaView's representation
  std::unique_ptr<EventWatch> type_watch_;  // watches whether that is a volume
  vtkSmartPointer<vtkVolume> taken_out_;    // ParaView's volume, while it is not drawn
  std::unique_ptr<CropBox> box_;
  bool cut_ = true, cropped_ = false, hidden_ = false, waits_ = true;
  QObject lifetime_;  // its destructor ends the connections to the scan
  // Last: they end before the members that they set.
  Casting casting_{[this] { refresh(); }};  // without a graphics card
  Job seeking_body_{Job::Newer::follows};
};

}  // namespace palpate::plugin

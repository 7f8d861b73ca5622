#pragma once

/// How the volume is drawn: the box that says so, and the representations that follow it.

#include <QObject>

#include <functional>

class QWidget;
class vtkSMProxy;

namespace palpate::plugin {

class DrawnLayers;
class KeptText;
class ScanPipeline;
class VolumeLookBox;

class VolumeLooks {
 public:
  VolumeLooks(ScanPipeline& readers, DrawnLayers& layers, KeptText& kept, QWidget* parent);
  VolumeLooks(const VolumeLooks&) = delete;
  VolumeLooks& operator=(const VolumeLooks&) = delete;

  VolumeLookBox& box() { return *box_; }
  /// Another scan: what is chosen here is of the one before.
  void begin_scan();
  /// Once the views are there: the look that a state file names, where it was restored.
  void restore(bool restored);
  /// A frame may be a tenth as bright as the one before: windows and looks are its own, as far as nobody chose others.
  void show_frame_values();
  /// What is seen of the volume, as it is shown now: it may have been edited in ParaView.
  void read_opacity();

 private:
  void change(const std::function<void(vtkSMProxy&)>& change);
  void show_felt(bool felt);

  ScanPipeline& readers_;
  DrawnLayers& layers_;
  KeptText& kept_;
  VolumeLookBox* box_;
  QObject lifetime_;  // its end ends what is connected to the box
};

}  // namespace palpate::plugin

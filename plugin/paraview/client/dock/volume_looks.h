#pragma once

/// The volume's appearance: the box to choose it, and the representations that follow the choice.

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
  /// Another scan: forgets the choice made for the previous one.
  void begin_scan();
  /// To be called when the views exist. `restored`: take the appearance from the state file.
  void restore(bool restored);
  /// A frame may be a tenth as bright as the previous one: each frame has its own windows and appearance unless the
  /// user chose them.
  void show_frame_values();
  /// Reads the opacity of the volume as it is shown now, because it may have been edited in ParaView.
  void read_opacity();

 private:
  void change(const std::function<void(vtkSMProxy&)>& change);
  void show_felt(bool felt);

  ScanPipeline& readers_;
  DrawnLayers& layers_;
  KeptText& kept_;
  VolumeLookBox* box_;
  QObject lifetime_;  // its destructor ends the connections to the box
};

}  // namespace palpate::plugin

#pragma once

/// The frame of a scan with several frames: step buttons, and a slider that follows ParaView's time.

#include <QWidget>

#include "plugin/paraview/client/model/scan_model.h"

class QLabel;
class QSlider;

namespace palpate::plugin {

class FrameRow : public QWidget {
  Q_OBJECT

 public:
  explicit FrameRow(ScanModel& model, QWidget* parent = nullptr);

 private:
  void refresh();

  ScanModel& model_;
  QSlider* frame_;
  QLabel* text_;
};

}  // namespace palpate::plugin

#pragma once

/// The filter of the scan: what the stylus feels, and whether the views show it.

#include <QWidget>

#include "io/filter.h"
#include "plugin/paraview/client/scan/scan_loader.h"

class QCheckBox;
class QComboBox;
class QDoubleSpinBox;
class QLabel;
class QProgressBar;

namespace palpate::plugin {

class SceneModel;
class ScanSection;
class SessionController;

/// The scene has the filter; this row asks for another one. The voxels are filtered in the background, and the scene is
/// edited once they are there.
class FilterRow : public QWidget {
  Q_OBJECT

 public:
  FilterRow(SceneModel& model, SessionController& touching, ScanSection& scan, QWidget* parent = nullptr);

  /// Another scan, or none.
  void refresh();
  /// "Gaussian filter of 1 mm", and what the views show where that is not the same; empty without a filter.
  QString in_words() const;

 private:
  void ask();
  void follow();
  void offer_amount();
  io::Filter wanted() const;
  void show_in_views();

  SceneModel& model_;
  SessionController& touching_;
  ScanSection& scan_;
  QComboBox* type_;
  QDoubleSpinBox* amount_;
  QCheckBox* shown_;
  QProgressBar* progress_;
  ScanLoader loader_;  // last: its thread is to end before all that its callbacks use
};

}  // namespace palpate::plugin

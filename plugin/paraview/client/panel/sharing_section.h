#pragma once

/// The switch that shares the session with 3D Slicer.

#include <QWidget>

#include "plugin/paraview/client/model/sharing_model.h"

class QCheckBox;
class QLabel;
class QSpinBox;

namespace palpate::plugin {

class SharingSection : public QWidget {
  Q_OBJECT

 public:
  explicit SharingSection(SharingModel& model, QWidget* parent = nullptr);

  /// "1 client", for the section's title; empty: sharing is off.
  QString in_words() const;

 private:
  void turn(bool on);
  void show_state();

  SharingModel& model_;
  QCheckBox* on_;
  QSpinBox* port_;
  QLabel* message_;
};

}  // namespace palpate::plugin

#pragma once

/// The panel's fourth section: how the strength of a boundary depends on the scan.

#include <QWidget>

#include <memory>

#include "plugin/paraview/client/panel/curve_editor.h"
#include "plugin/paraview/client/panel/scene_model.h"
#include "plugin/paraview/client/scan/scan_study.h"

class QComboBox;

namespace palpate::plugin {

class CurvesSection : public QWidget {
  Q_OBJECT

 public:
  explicit CurvesSection(SceneModel& model, QWidget* parent = nullptr);

  void set_study(const std::shared_ptr<const ScanStudy>& study, const QString& unit);

 private:
  const Counts& counts_of(modes::Datum datum) const;
  void list_modes();
  void show_mode();
  void use_preset(int index);
  std::size_t mode() const;
  modes::Gate* gate_of(modes::Scene& scene) const;

  SceneModel& model_;
  std::shared_ptr<const ScanStudy> study_;
  QString unit_;
  QComboBox* modes_;
  QComboBox* presets_;
  CurveEditor* strength_;
  CurveEditor* gate_;
  bool editing_ = false;
};

}  // namespace palpate::plugin

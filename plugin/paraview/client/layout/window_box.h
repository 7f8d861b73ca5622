#pragma once

/// The box of gray windows: those that suit the scan, and the slices' current one.

#include <QComboBox>

#include "plugin/paraview/client/model/scan_model.h"
#include "plugin/paraview/client/views/clinical_views.h"

namespace palpate::plugin {

class WindowBox : public QComboBox {
  Q_OBJECT

 public:
  WindowBox(ScanModel& model, ClinicalViews& views, QWidget* parent = nullptr);

 private:
  void follow();
  void list();
  void show_window();
  void choose();

  ScanModel& model_;
  ClinicalViews& views_;
  std::vector<NamedWindow> listed_;
};

}  // namespace palpate::plugin

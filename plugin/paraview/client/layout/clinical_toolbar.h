#pragma once

/// The only toolbar of the clinical layout, with the controls needed while a scan is viewed and felt.

#include <QToolBar>

#include "plugin/paraview/client/views/slice_view.h"

class QAction;
class QComboBox;
class QPushButton;
class QToolButton;

namespace palpate::plugin {

class ClinicalToolbar : public QToolBar {
  Q_OBJECT

 public:
  /// The toolbar takes the boxes of gray windows and of the volume's appearance.
  ClinicalToolbar(QComboBox& window, QComboBox& look, QWidget* parent);

  /// Whether a stylus is connected, and whether that can be changed.
  void show_connection(bool connected, bool can_connect);
  void show_enlarged(bool enlarged);
  void show_advanced(bool advanced);
  void show_measure(Measure measure);
  /// The number of marks, in words; empty: the label is hidden.
  void show_marks(const QString& words);
  /// What can be cut away from the volume: the table, a box. When the table becomes removable, it is cut away.
  void show_volume_cuts(bool can_cut, bool can_crop);

 signals:
  void open_wanted();
  void folder_wanted(const QString& folder);
  void picture_wanted();
  void enlarged_wanted(bool enlarged);
  void measure_wanted(palpate::plugin::Measure measure);
  void cut_wanted(bool cut);
  void crop_wanted(bool crop);
  void marks_wanted();
  void connect_wanted();
  void release_wanted();
  void advanced_wanted(bool advanced);

 private:
  void add_open();
  void add_layouts();
  void add_measures();
  void add_connection();
  QToolButton* make_volume_menu();
  QAction* add(const char* name, const QString& text, const QString& tip);

  QAction* four_ = nullptr;
  QAction* one_ = nullptr;
  QAction* cut_ = nullptr;
  QAction* crop_ = nullptr;
  QAction* ruler_ = nullptr;
  QAction* angle_ = nullptr;
  QAction* marks_ = nullptr;
  QAction* connect_ = nullptr;
  QAction* advanced_ = nullptr;
  QPushButton* release_ = nullptr;
};

}  // namespace palpate::plugin

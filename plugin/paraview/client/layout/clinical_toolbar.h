#pragma once

/// The one toolbar of the clinical layout: what is pressed while a scan is looked at and felt.

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
  /// The boxes of gray windows and of the volume's looks come to stand here.
  ClinicalToolbar(QComboBox& window, QComboBox& look, QWidget* parent);

  /// How it is connected now, and whether that can be changed.
  void show_connection(bool connected, bool can_connect);
  void show_enlarged(bool enlarged);
  void show_advanced(bool advanced);
  void show_measure(Measure measure);
  /// How many there are, in words; empty: no room is taken for them.
  void show_marks(const QString& words);
  /// What can be cut away from the volume; what is, is asked for anew: the table is, the box is not.
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

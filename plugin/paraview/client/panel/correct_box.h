#pragma once

/// The box to correct a structure by touch: the doubtful places of its outline, the tools, and save and send.

#include <QWidget>

#include "plugin/paraview/client/model/correction_model.h"

class QButtonGroup;
class QCheckBox;
class QDoubleSpinBox;
class QLabel;
class QPushButton;
class QToolButton;
class QTreeWidget;
class QTreeWidgetItem;

namespace palpate::plugin {

class OutlineOut;

class CorrectBox : public QWidget {
  Q_OBJECT

 public:
  explicit CorrectBox(CorrectionModel& model, QWidget* parent = nullptr);

  /// The effect of the edits, in words.
  void set_change(const QString& words);
  /// The progress of the search for doubtful places, 0 to 1; below 0: no search.
  void set_looking(double done);
  /// Whether the felt outline has every stroke: only then can the outline be saved or sent.
  void set_whole(bool whole);
  /// Its progress bar is outside this box, which is hidden while no structure is corrected.
  OutlineOut& out() { return *out_; }

 signals:
  void save_wanted();
  void send_wanted();
  /// The stylus is to be held in the slice of the active view, or to be free.
  void slice_wanted(bool held);

 private:
  QWidget* build_tools();
  QWidget* build_ways_out();
  void follow();
  void list_places();
  QString note_of_places() const;
  void show_place(QTreeWidgetItem& item, std::size_t place) const;

  CorrectionModel& model_;
  QTreeWidget* places_ = nullptr;
  QLabel* places_note_ = nullptr;
  QToolButton* take_ = nullptr;
  QToolButton* leave_ = nullptr;
  QButtonGroup* tools_ = nullptr;
  QDoubleSpinBox* radius_ = nullptr;
  QDoubleSpinBox* snap_ = nullptr;
  QCheckBox* in_slice_ = nullptr;
  QLabel* change_ = nullptr;
  QToolButton* undo_ = nullptr;
  QToolButton* redo_ = nullptr;
  QToolButton* before_ = nullptr;
  QPushButton* save_ = nullptr;
  QPushButton* send_ = nullptr;
  OutlineOut* out_ = nullptr;
  double looking_ = -1;  // progress of the search for doubtful places
  bool whole_ = false;
};

}  // namespace palpate::plugin

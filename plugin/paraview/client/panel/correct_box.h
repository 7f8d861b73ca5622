#pragma once

/// What corrects a structure by touch: the doubtful places of its outline, the tools, and the way out.

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

  /// What the edits have changed, in words.
  void set_change(const QString& words);
  /// How far the looking for doubtful places is, 0 to 1; less than 0: it is not done.
  void set_looking(double done);
  /// Whether what is felt has all that was drawn: only then it goes out.
  void set_whole(bool whole);
  /// Its bar stands beside this box, which is hidden where nothing is corrected.
  OutlineOut& out() { return *out_; }

 signals:
  void save_wanted();
  void send_wanted();
  /// The stylus is to be held in the slice of the marked view, or to be free.
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
  double looking_ = -1;  // for doubtful places: how far
  bool whole_ = false;
};

}  // namespace palpate::plugin

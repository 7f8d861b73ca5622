#pragma once

/// The panel's section of marks: lists them, measures between chosen ones, renames, moves and deletes.

#include <QWidget>

#include <string>
#include <vector>

#include "plugin/paraview/client/model/mark_rows.h"
#include "plugin/paraview/client/model/marks_model.h"
#include "plugin/paraview/client/model/session_controller.h"

class QLabel;
class QPushButton;
class QToolButton;
class QTreeWidget;
class QTreeWidgetItem;

namespace palpate::plugin {

class MarksSender;

class MarksSection : public QWidget {
  Q_OBJECT

 public:
  MarksSection(MarksModel& model, SessionController& session, QWidget* parent = nullptr);

  /// The number of marks and measurements, in words; empty if there are none.
  QString in_words() const;
  void tell(const QString& message, bool problem = false);
  MarksSender& sender() { return *sender_; }

 signals:
  void listed();
  /// The chosen marks, in the order of choice.
  void chosen(const std::vector<std::size_t>& marks);
  /// The user wants to see a mark: the slices go there.
  void place_wanted(const glm::dvec3& place_mm);
  void send_wanted();

 private:
  using Kind = MarkRow::Kind;

  void build();
  void list();
  QString path_in_words(const MarkedPath& path) const;
  void fill(QTreeWidgetItem& item, const MarkRow& row);
  void follow_choice();
  void show_measure();
  void show_uses();
  void rename(const QTreeWidgetItem& item);
  void keep_measure();
  void move_here();
  void remove();
  MarkRow row_of(const QTreeWidgetItem& item) const;
  QString unit() const;

  MarksModel& model_;
  SessionController& session_;
  QTreeWidget* list_ = nullptr;
  QLabel* measured_ = nullptr;
  QLabel* message_ = nullptr;
  QToolButton* keep_ = nullptr;
  QToolButton* move_ = nullptr;
  QToolButton* remove_ = nullptr;
  QToolButton* undo_ = nullptr;
  QPushButton* send_ = nullptr;
  MarksSender* sender_ = nullptr;
  std::vector<std::size_t> chosen_;  // chosen marks, in the order of choice
  Marks listed_;                     // the marks in the list
  std::string listed_of_;            // their scan
  bool listing_ = false;
};

}  // namespace palpate::plugin

#pragma once

/// A section of the panel: a header that folds what is under it away.

#include <QWidget>

class QToolButton;

namespace palpate::plugin {

class Fold : public QWidget {
 public:
  /// `name` is its object name; "<name>Fold" is its header's.
  Fold(const QString& title, const QString& name, QWidget* content, bool open, QWidget* parent = nullptr);

  void set_open(bool open);
  /// What is said beside the title. Its end is cut where there is no room; the tool tip has all of it.
  void set_note(const QString& note);

 protected:
  void resizeEvent(QResizeEvent* event) override;

 private:
  void show_title();

  QString title_;
  QString note_;
  QToolButton* header_;
};

}  // namespace palpate::plugin

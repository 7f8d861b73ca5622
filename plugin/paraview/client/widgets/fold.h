#pragma once

/// A section of the panel with a header that hides or shows its content.

#include <QWidget>

class QToolButton;

namespace palpate::plugin {

class Fold : public QWidget {
 public:
  /// `name` is its object name; "<name>Fold" is its header's.
  Fold(const QString& title, const QString& name, QWidget* content, bool open, QWidget* parent = nullptr);

  void set_open(bool open);
  /// The text beside the title. It is cut if there is not enough room; the tool tip has all of it.
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

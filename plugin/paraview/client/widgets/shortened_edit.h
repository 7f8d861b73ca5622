#pragma once

#include <QLineEdit>

namespace palpate::plugin {

/// A line of text without a frame that can be edited. A text that is too long has "…" in its middle until the line
/// gets the keyboard, since names of boundaries differ at their ends. The tool tip should hold all of it.
class ShortenedEdit : public QLineEdit {
  Q_OBJECT

 public:
  explicit ShortenedEdit(QWidget* parent);

 protected:
  void paintEvent(QPaintEvent* event) override;
};

}  // namespace palpate::plugin

#pragma once

#include <QLineEdit>

namespace palpate::plugin {

/// A line of text without a frame that can be edited. If the text is too long, it ends in "…" until the line gets the
/// keyboard. The tool tip should hold all of it.
class ShortenedEdit : public QLineEdit {
  Q_OBJECT

 public:
  explicit ShortenedEdit(QWidget* parent);

 protected:
  void paintEvent(QPaintEvent* event) override;
};

}  // namespace palpate::plugin

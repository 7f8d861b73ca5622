#include "plugin/paraview/client/widgets/fold.h"

#include <QToolButton>
#include <QVBoxLayout>

namespace palpate::plugin {

Fold::Fold(const QString& title, const QString& name, QWidget* content, bool open, QWidget* parent)
    : QWidget(parent), title_(title), header_(new QToolButton(this)) {
  setObjectName(name);
  auto* const column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(2);
  header_->setObjectName(name + QStringLiteral("Fold"));
  header_->setCheckable(true);
  header_->setChecked(open);
  header_->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  header_->setArrowType(open ? Qt::DownArrow : Qt::RightArrow);
  header_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Fixed);
  header_->setStyleSheet(
      QStringLiteral("QToolButton { font-weight: bold; border: none; text-align: left; padding: 2px }"));
  column->addWidget(header_);
  content->setParent(this);
  content->setVisible(open);
  column->addWidget(content);
  connect(header_, &QToolButton::toggled, content, [this, content](bool unfolded) {
    header_->setArrowType(unfolded ? Qt::DownArrow : Qt::RightArrow);
    content->setVisible(unfolded);
  });
  show_title();
}

void Fold::set_open(bool open) {
  header_->setChecked(open);
}

void Fold::set_note(const QString& note) {
  note_ = note;
  header_->setToolTip(note);
  show_title();
}

void Fold::resizeEvent(QResizeEvent* event) {
  QWidget::resizeEvent(event);
  show_title();
}

void Fold::show_title() {
  constexpr int arrow_and_margins = 30;
  const QString title = note_.isEmpty() ? title_ : QStringLiteral("%1: %2").arg(title_, note_);
  // A QToolButton would cut out the middle, where the size of the scan is.
  const QString shown = header_->fontMetrics().elidedText(title, Qt::ElideRight, width() - arrow_and_margins);
  if (header_->text() != shown) header_->setText(shown);
}

}  // namespace palpate::plugin

#include "plugin/paraview/client/layout/series_card.h"

#include <QHBoxLayout>
#include <QImage>
#include <QLabel>
#include <QPixmap>
#include <QVBoxLayout>

#include "io/series.h"
#include "plugin/paraview/client/jobs/thumbnail.h"
#include "plugin/paraview/client/words/series_words.h"

namespace palpate::plugin {
namespace {

QLabel* add_line(QVBoxLayout& column, const QString& text, const QString& style = {}) {
  auto* const line = new QLabel(text);
  line->setTextFormat(Qt::PlainText);
  line->setWordWrap(true);
  line->setAttribute(Qt::WA_TransparentForMouseEvents);  // the card is one button
  line->setStyleSheet(style);
  column.addWidget(line);
  return line;
}

}  // namespace

SeriesCard::SeriesCard(const io::Series& series, const QString& best, QWidget* parent) : QPushButton(parent) {
  setObjectName(QStringLiteral("palpateCard"));
  setEnabled(series.usable);
  QSizePolicy policy(QSizePolicy::Expanding, QSizePolicy::Preferred);
  policy.setHeightForWidth(true);
  setSizePolicy(policy);
  const QString title = series_title(series), details = series_details(series), why = why_not_usable(series);
  setAccessibleName(title + QLatin1Char('\n') + details + QLatin1Char('\n') + why);
  setToolTip(series.usable ? tr("Opens this series") : why);
  auto* const row = new QHBoxLayout(this);
  row->setContentsMargins(6, 6, 6, 6);
  picture_ = new QLabel(this);
  picture_->setFixedSize(thumbnail_pixels, thumbnail_pixels);
  picture_->setAlignment(Qt::AlignCenter);
  picture_->setStyleSheet(QStringLiteral("background: black; color: #909090"));
  picture_->setText(QString::fromStdString(series.modality));
  picture_->setAttribute(Qt::WA_TransparentForMouseEvents);
  row->addWidget(picture_);
  auto* const column = new QVBoxLayout;
  column->setSpacing(3);
  row->addLayout(column, 1);
  add_line(*column, QString::fromStdString(series.modality) + QStringLiteral("  ") + title,
           QStringLiteral("font-weight: bold"));
  add_line(*column, details);
  if (!best.isEmpty()) {
    add_line(*column, tr("★ Recommended: %1").arg(best), QStringLiteral("color: #1b6e2c; font-weight: bold"));
  }
  if (!why.isEmpty()) add_line(*column, tr("Cannot be felt: %1").arg(why), QStringLiteral("color: #8a4b00"));
  column->addStretch(1);
  setMinimumHeight(thumbnail_pixels + 14);
}

QSize SeriesCard::sizeHint() const {
  return layout()->totalSizeHint();
}

QSize SeriesCard::minimumSizeHint() const {
  return layout()->totalMinimumSize();
}

int SeriesCard::heightForWidth(int width) const {
  return layout()->totalHeightForWidth(width);
}

void SeriesCard::set_picture(const QImage& picture) {
  if (!picture.isNull()) picture_->setPixmap(QPixmap::fromImage(picture));
}

}  // namespace palpate::plugin

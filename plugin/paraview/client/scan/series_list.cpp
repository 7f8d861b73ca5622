#include "plugin/paraview/client/scan/series_list.h"

#include <QIcon>
#include <QPixmap>
#include <QResizeEvent>
#include <QStringList>
#include <QTimer>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <vector>

#include "io/choose_first.h"
#include "plugin/app/scan_choice.h"
#include "plugin/paraview/client/words/patient_words.h"
#include "plugin/paraview/client/words/series_words.h"

namespace palpate::plugin {

SeriesList::SeriesList(ScanModel& model, QWidget* parent) : QListWidget(parent), model_(model) {
  setObjectName(QStringLiteral("palpateSeries"));
  setWordWrap(true);
  setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  fit();
  setIconSize({40, 40});
  const auto choose = [this](QListWidgetItem* item) { model_.choose(item->data(Qt::UserRole).toULongLong()); };
  connect(this, &QListWidget::itemActivated, this, choose);
  connect(this, &QListWidget::itemClicked, this, choose);
  connect(&model, &ScanModel::listed, this, [this] { list(); });
}

void SeriesList::list() {
  clear();
  thumbnails_.cancel();
  if (const FoundList* const found = model_.found()) {
    if (found->catalogue) {
      list_files(*found);
      draw_thumbnails(*found);
    }
    for (std::size_t n = 0; n < found->on_server.size(); ++n) {
      const SeriesOnServer& one = found->on_server[n];
      auto* const row = new QListWidgetItem(QString::fromStdString(one.label), this);
      row->setData(Qt::UserRole, static_cast<qulonglong>(n));
      if (!one.usable) row->setForeground(palette().brush(QPalette::Disabled, QPalette::Text));
    }
  }
  fit();
}

/// In the catalogue's order: by study, number and path; but first the series that a file was named of.
void SeriesList::list_files(const FoundList& found) {
  std::vector<std::size_t> order = choices(*found.catalogue, found.path);
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(found.path, ignored)) std::ranges::sort(order);
  const auto first = io::choose_first(found.catalogue->series);
  QPixmap no_picture_yet(iconSize());  // the words keep their width and the rows their places when the pictures come
  no_picture_yet.fill(Qt::transparent);
  for (const std::size_t n : order) {
    const io::Series& series = scan_at(*found.catalogue, n);
    QStringList lines{QString::fromStdString(scan_label(series)), series_details(series)};
    if (!series.usable) lines << why_not_usable(series);
    if (first && first->index == n && order.size() > 1) {
      lines << tr("★ Recommended: %1").arg(why_first(series));
    }
    auto* const row = new QListWidgetItem(no_picture_yet, lines.join(QLatin1Char('\n')), this);
    row->setData(Qt::UserRole, static_cast<qulonglong>(n));
    // Shown to verify the patient, never stored: only where the pointer rests.
    row->setToolTip(tr("%1\nID %2, study of %3")
                        .arg(patient_in_words(series.identity.patient_name),
                             QString::fromStdString(series.identity.patient_id),
                             date_in_words(series.identity.study_date)));
    if (!series.usable) row->setForeground(palette().brush(QPalette::Disabled, QPalette::Text));
  }
}

void SeriesList::draw_thumbnails(const FoundList& found) {
  thumbnails_.draw_thumbnails(found.catalogue, [this, of = found.catalogue](std::size_t n, const QImage& image) {
    if (!model_.found() || of != model_.found()->catalogue || image.isNull()) return;
    for (int at = 0; at < count(); ++at) {
      QListWidgetItem& row = *item(at);
      if (row.data(Qt::UserRole).toULongLong() == n) row.setIcon(QIcon(QPixmap::fromImage(image)));
    }
    emit thumbnail_drawn(n, image);
  });
}

/// As high as its rows, up to a dozen: the panel's column scrolls, not a list within it.
void SeriesList::fit() {
  constexpr int most_rows = 12, least_height = 30;
  const int rows = std::min(count(), most_rows);
  // No bar for those: it would take the width that their words are broken for.
  setVerticalScrollBarPolicy(count() > most_rows ? Qt::ScrollBarAsNeeded : Qt::ScrollBarAlwaysOff);
  doItemsLayout();
  const int height = rows == 0 ? 0 : visualItemRect(item(rows - 1)).bottom() - visualItemRect(item(0)).top() + 1;
  setFixedHeight(std::max(height + 2 * frameWidth(), least_height));
}

void SeriesList::resizeEvent(QResizeEvent* event) {
  QListWidget::resizeEvent(event);
  if (event->size().width() == event->oldSize().width()) return;
  QTimer::singleShot(0, this, [this] { fit(); });  // its words are broken for another width
}

}  // namespace palpate::plugin

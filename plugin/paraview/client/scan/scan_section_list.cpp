#include <pqApplicationCore.h>
#include <pqObjectBuilder.h>
#include <pqUndoStack.h>

#include <QIcon>
#include <QListWidget>
#include <QPixmap>
#include <QStringList>

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "io/choose_first.h"
#include "plugin/app/scan_choice.h"
#include "plugin/paraview/client/scan/archive_tab.h"
#include "plugin/paraview/client/scan/patient_words.h"
#include "plugin/paraview/client/scan/scan_section.h"
#include "plugin/paraview/client/scan/series_words.h"

// The list of what was found in a folder, and what becomes of the scan that was open before.

namespace palpate::plugin {
namespace {

QString text(const std::string& utf8) {
  return QString::fromStdString(utf8);
}

}  // namespace

/// In the catalogue's order: by study, number and path; but first the series that a file was named of.
void ScanSection::list_rows() {
  std::vector<std::size_t> order = choices(*catalogue_, path_);
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path_, ignored)) std::ranges::sort(order);
  const auto first = io::choose_first(catalogue_->series);
  for (const std::size_t n : order) {
    const io::Series& series = scan_at(*catalogue_, n);
    QStringList lines{text(scan_label(series)), series_details(series)};
    if (!series.usable) lines << why_not_usable(series);
    if (first && first->index == n && order.size() > 1) lines << tr("★ Best to feel first: %1").arg(text(first->why));
    auto* const item = new QListWidgetItem(lines.join(QLatin1Char('\n')), series_);
    item->setData(Qt::UserRole, static_cast<qulonglong>(n));
    // Shown to verify the patient, never stored: only where the pointer rests.
    item->setToolTip(tr("%1\nID %2, study of %3")
                         .arg(patient_in_words(series.identity.patient_name), text(series.identity.patient_id),
                              date_in_words(series.identity.study_date)));
    if (!series.usable) item->setForeground(palette().brush(QPalette::Disabled, QPalette::Text));
  }
  fit_series();
}

void ScanSection::draw_thumbnails() {
  thumbnails_.draw_thumbnails(catalogue_, [this, of = catalogue_](std::size_t n, const QImage& image) {
    if (of != catalogue_ || image.isNull()) return;
    for (int row = 0; row < series_->count(); ++row) {
      QListWidgetItem& item = *series_->item(row);
      if (item.data(Qt::UserRole).toULongLong() == n) item.setIcon(QIcon(QPixmap::fromImage(image)));
    }
    archive_->set_picture(text(catalogue_->series[n].uid), image);
    emit thumbnail_drawn(n, image);
  });
}

/// A patient is not left on the screen beside another's name.
void ScanSection::leave_other_patient() {
  if (!source_) return;
  const io::Series* const shown = series_shown();
  const auto is_same = [&](const io::Series& other) {
    return shown->identity.patient_name == other.identity.patient_name &&
           shown->identity.patient_id == other.identity.patient_id;
  };
  if (!shown || !std::ranges::all_of(catalogue_->series, is_same)) close_scan();
}

void ScanSection::close_scan() {
  SCOPED_UNDO_EXCLUDE();
  emit closing();
  emit out_of_reach({});
  views_.close();
  handle_ = {};
  frame_loader_.cancel();
  coming_.reset();
  catalogue_shown_.reset();
  felt_source_.clear();
  if (source_) pqApplicationCore::instance()->getObjectBuilder()->destroy(source_);
  show_frame();
}

}  // namespace palpate::plugin

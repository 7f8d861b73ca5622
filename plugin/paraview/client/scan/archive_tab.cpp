#include "plugin/paraview/client/scan/archive_tab.h"

#include <QComboBox>
#include <QCoreApplication>
#include <QImage>
#include <QPixmap>
#include <QProgressBar>
#include <QPushButton>
#include <QTreeWidget>
#include <QVBoxLayout>

#include <algorithm>
#include <chrono>
#include <exception>

#include "plugin/app/archive_settings.h"
#include "plugin/messages/messages.h"
#include "plugin/paraview/client/scan/archive_dialog.h"
#include "plugin/paraview/client/scan/archive_items.h"
#include "plugin/paraview/client/scan/archive_search.h"
#include "plugin/paraview/client/scan/archive_words.h"
#include "plugin/paraview/client/widgets/message_label.h"
#include "plugin/paraview/client/words.h"

namespace palpate::plugin {

ArchiveTab::ArchiveTab(QWidget* parent) : QWidget(parent) {
  setObjectName(QStringLiteral("palpateArchive"));
  new QVBoxLayout(this);
  layout()->setContentsMargins(2, 4, 2, 2);
  build_archives();
  build_search();
  build_fetch();
  connect(QCoreApplication::instance(), &QCoreApplication::aboutToQuit, this, [this] { close(); });
  set_fetching(false);
  tell({});
}

ArchiveTab::~ArchiveTab() = default;

/// Nothing of a patient stays behind.
void ArchiveTab::close() {
  fetching_.finish();
  counting_.finish();
  try {
    run_.close();
  } catch (const std::exception&) {  // the next start deletes it
  }
}

void ArchiveTab::tell(const QString& message, bool problem) {
  show_message(*message_, in_fields(message), problem);
}

void ArchiveTab::showEvent(QShowEvent* event) {
  QWidget::showEvent(event);
  list_archives(archives_->currentText());
  count_on_disk();
  search_->focus();
  if (archive() && found_->topLevelItemCount() == 0) search(false);
}

void ArchiveTab::list_archives(const QString& chosen) {
  try {
    entered_ = read_archives();
  } catch (const std::exception& error) {
    entered_.clear();
    tell(QString::fromUtf8(error.what()), true);
  }
  archives_->clear();
  for (const io::Archive& one : entered_) archives_->addItem(QString::fromStdString(one.name));
  archives_->setCurrentIndex(std::max(archives_->findText(chosen), entered_.empty() ? -1 : 0));
  archives_->setEnabled(!entered_.empty());
  echo_->setEnabled(!entered_.empty());
  if (entered_.empty() && message_->text().isEmpty()) tell(words(say("no-archive-here-yet")));
}

std::optional<io::Archive> ArchiveTab::archive() const {
  const int chosen = archives_->currentIndex();
  if (chosen < 0 || chosen >= static_cast<int>(entered_.size())) return {};
  return entered_[static_cast<std::size_t>(chosen)];
}

void ArchiveTab::enter_archive() {
  ArchiveDialog dialog(echoing_, this);
  if (dialog.exec() != QDialog::Accepted) return;
  tell({});
  list_archives(dialog.name());
  search(false);
}

void ArchiveTab::echo() {
  const auto asked = archive();
  if (!asked) return;
  tell(words(say("archive-is-asked", asked->name)));
  echoing_.ask([asked](const auto& /*job*/) { return echo_ms(*asked); },
               [this, asked](const auto& ms, const QString& error) {
                 tell(ms ? words(say("archive-answers", asked->name, asked->calling, static_cast<int>(*ms))) : error,
                      !ms);
               });
}

void ArchiveTab::search(bool begun_date) {
  const auto asked = archive();
  const auto query = search_->query(begun_date);
  if (!asked || !query) return;
  listing_.cancel();
  unlisted_.clear();
  tell(words(say("archive-is-asked", asked->name)));
  finding_.ask([asked, query](const auto& job) { return io::find(*asked, *query, job.keep_going); },
               [this](const auto& found, const QString& error) {
                 tell(error, true);
                 if (found) list(*found);
               });
}

void ArchiveTab::list(const io::Found& found) {
  found_->clear();
  for (const io::ArchivedStudy& study : found.studies) add_study(*found_, study);
  if (found.studies.empty()) {
    tell(words(say("archive-holds-none-such")));
  } else if (found.more) {
    tell(words(say("archive-holds-more", found.studies.size())));
  } else {
    tell({});
  }
  if (found_->topLevelItemCount() > 0) found_->topLevelItem(0)->setExpanded(true);
  set_fetching(fetching_.is_busy());
}

void ArchiveTab::ask_series() {
  const auto asked = archive();
  if (!asked || listing_.is_busy() || unlisted_.empty()) return;
  const QString study = unlisted_.front();
  unlisted_.erase(unlisted_.begin());
  listing_.ask(
      [asked, uid = study.toStdString()](const auto& job) { return io::find_series_of(*asked, uid, job.keep_going); },
      [this, study](const auto& series, const QString& error) {
        if (series) list_series(study, *series);
        if (!series) tell(error, true);
        ask_series();
      });
}

void ArchiveTab::list_series(const QString& study, const std::vector<io::ArchivedSeries>& series) {
  for (int row = 0; row < found_->topLevelItemCount(); ++row) {
    QTreeWidgetItem& item = *found_->topLevelItem(row);
    if (study_of(item) == study) add_series(item, series);
  }
  show_pictures(*found_, pictures_);
}

void ArchiveTab::set_picture(const QString& series_uid, const QImage& picture) {
  pictures_[series_uid] = QIcon(QPixmap::fromImage(picture));
  show_pictures(*found_, {{series_uid, pictures_[series_uid]}});
}

void ArchiveTab::set_fetching(bool fetching) {
  progress_->setVisible(fetching);
  cancel_->setVisible(fetching);
  fetch_->setVisible(!fetching);
  fetch_->setEnabled(found_->currentItem() && found_->currentItem()->isSelected() && archive());
  empty_->setEnabled(!fetching && !counting_.is_busy());
}

void ArchiveTab::fetch() {
  const auto asked = archive();
  if (!asked || !found_->currentItem() || fetching_.is_busy()) return;
  const std::string uid = uid_of(*found_->currentItem()).toStdString();
  if (uid.empty()) return;  // of a line that stands for series to come
  std::filesystem::path folder;
  try {
    folder = run_.next_folder();
  } catch (const std::exception& error) {
    tell(QString::fromUtf8(error.what()), true);
    return;
  }
  tell({});
  emit fetch_began();
  progress_->setRange(0, 0);
  progress_->setFormat(tr("Waiting for %1").arg(QString::fromStdString(asked->name)));
  fetching_.ask(
      [this, asked, uid, folder](const auto& job) {
        auto told = std::chrono::steady_clock::now();
        return io::fetch(*asked, {uid}, folder, {}, [&](const io::FetchProgress& progress) {
          constexpr std::chrono::milliseconds often(100);
          if (const auto now = std::chrono::steady_clock::now(); now - told > often) {
            told = now;
            job.tell([this, progress] { show_progress(progress); });
          }
          return job.keep_going();
        });
      },
      [this, folder](const auto& fetched, const QString& error) {
        set_fetching(false);
        count_on_disk();
        if (fetched) take(*fetched, folder);
        if (!fetched) tell(error, true);
      });
  set_fetching(true);
}

void ArchiveTab::show_progress(const io::FetchProgress& progress) {
  progress_->setRange(0, std::max(progress.expected, 0));
  progress_->setValue(static_cast<int>(progress.files));
  const auto mib = static_cast<qulonglong>(progress.bytes >> 20U);
  progress_->setFormat(progress.expected > 0
                           ? tr("%1 of %2 images, %3 MiB").arg(progress.files).arg(progress.expected).arg(mib)
                           : tr("%1 images, %2 MiB").arg(progress.files).arg(mib));
}

void ArchiveTab::take(const io::Fetched& fetched, const std::filesystem::path& folder) {
  QStringList warnings;
  for (const Text& warning : fetched.warnings) warnings << words(warning);
  if (warnings.isEmpty()) {
    tell(words(say("fetched-images", fetched.files, fetched.bytes >> 20U)));
  } else {
    tell(warnings.join(QLatin1Char('\n')), true);
  }
  if (fetched.files > 0) emit this->fetched(QString::fromStdString(folder.string()));
}

void ArchiveTab::offer(const QString& folder) {
  offered_ = folder;
  offer_->setVisible(!folder.isEmpty());
}

void ArchiveTab::count_on_disk() {
  counting_.ask([](const auto& /*job*/) { return fetched_on_disk(); },
                [this](const auto& there, const QString& error) {
                  if (!there) tell(error, true);
                  if (there) {
                    on_disk_->setText(tr("On disk: %1 series, %2 MiB")
                                          .arg(there->series)
                                          .arg(static_cast<double>(there->bytes) / (1 << 20), 0, 'f', 1));
                  }
                  set_fetching(fetching_.is_busy());
                });
}

void ArchiveTab::empty() {
  offer({});
  const auto in_use = in_use_ ? in_use_() : std::vector<std::filesystem::path>();
  counting_.ask(
      [this, in_use](const auto& /*job*/) {
        run_.empty(in_use);
        return fetched_on_disk();
      },
      [this](const auto& /*there*/, const QString& error) {
        tell(error, true);
        count_on_disk();
      });
  set_fetching(fetching_.is_busy());
}

}  // namespace palpate::plugin

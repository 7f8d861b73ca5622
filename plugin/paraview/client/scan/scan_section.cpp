#include "plugin/paraview/client/scan/scan_section.h"

#include <pqFileDialog.h>

#include <QCheckBox>
#include <QDragEnterEvent>
#include <QFileDialog>
#include <QHBoxLayout>
#include <QMimeData>
#include <QProgressBar>
#include <QPushButton>
#include <QTabBar>
#include <QUrl>
#include <QVBoxLayout>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <vector>

#include "io/interchange/voxel_file.h"
#include "plugin/paraview/client/remote/server_series.h"
#include "plugin/paraview/client/scan/archive_tab.h"
#include "plugin/paraview/client/scan/frame_row.h"
#include "plugin/paraview/client/scan/recent_folders.h"
#include "plugin/paraview/client/scan/series_list.h"
#include "plugin/paraview/client/widgets/message_label.h"

namespace palpate::plugin {
namespace {

/// The current work and its progress.
struct Work {
  QString what;
  double done = 0;
  bool can_cancel = true;
};

std::optional<Work> work_of(const ScanModel& model) {
  if (const auto* const finding = std::get_if<coming::Finding>(&model.coming())) {
    return Work{ScanSection::tr("Finding series"), finding->done};
  }
  if (const auto* const loading = std::get_if<coming::Loading>(&model.coming())) {
    return Work{ScanSection::tr("Loading"), loading->done};
  }
  if (std::holds_alternative<in_views::Showing>(model.in_views())) return Work{ScanSection::tr("Showing"), 0, false};
  if (const auto* const fetching = std::get_if<in_views::Fetching>(&model.in_views())) {
    return Work{fetching->what, fetching->done};
  }
  const auto* const shown = std::get_if<in_views::Shown>(&model.in_views());
  if (shown && shown->coming && !shown->scan.of.catalogue) return Work{shown->coming->what, shown->coming->done};
  return std::nullopt;
}

}  // namespace

ScanSection::ScanSection(ScanModel& model, QWidget* parent) : QWidget(parent), model_(model) {
  setObjectName(QStringLiteral("palpateScan"));
  setAcceptDrops(true);
  auto* const column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  build_tabs();
  build_series();
  build_progress(*column);
  auto* const ras = new QCheckBox(tr("Show the pointer's position in RAS"), this);
  ras->setObjectName(QStringLiteral("palpateRas"));
  ras->setToolTip(tr("Right, anterior and superior are positive; DICOM and radiology write L/R, P/A, H/F instead."));
  connect(ras, &QCheckBox::toggled, this, &ScanSection::ras_wanted);
  column->addWidget(ras);
  build_notes();
  connect(&model, &ScanModel::changed, this, [this] { refresh(); });
  connect(&model, &ScanModel::told, this,
          [this](const QString& text, bool problem) { show_message(*message_, text, problem); });
  connect(&model, &ScanModel::not_coming, this, [this] {
    const bool is_open = model_.seen() && model_.seen()->path == fetched_;
    if (!fetched_.empty() && !is_open) archive_->offer(QString::fromStdString(fetched_));
  });
  connect(&model, &ScanModel::listed, this, [this] {
    if (model_.found() && !model_.found()->only()) tabs_->setCurrentIndex(0);
  });
  refresh();
}

ScanSection::~ScanSection() = default;

void ScanSection::build_tabs() {
  tabs_ = new QTabBar(this);
  tabs_->setObjectName(QStringLiteral("palpateScanTabs"));
  tabs_->addTab(tr("Folder"));
  tabs_->addTab(tr("Archive"));
  tabs_->setExpanding(false);
  folder_ = new QWidget(this);
  auto* const column = new QVBoxLayout(folder_);
  column->setContentsMargins(0, 0, 0, 0);
  archive_ = new ArchiveTab(this);
  archive_->hide();
  archive_->set_in_use([this] {
    std::vector<std::filesystem::path> open{model_.path()};
    if (const SeriesRef* const seen = model_.seen()) open.emplace_back(seen->path);
    return open;
  });
  for (QWidget* const one : {static_cast<QWidget*>(tabs_), folder_, static_cast<QWidget*>(archive_)}) {
    layout()->addWidget(one);
  }
  // Not pages of a tab widget, because all of these would be as tall as the tallest.
  connect(tabs_, &QTabBar::currentChanged, this, [this](int tab) {
    folder_->setVisible(tab == 0);
    archive_->setVisible(tab == 1);
  });
  connect(archive_, &ArchiveTab::fetch_began, this, [this] { requests_before_fetch_ = model_.requests(); });
  connect(archive_, &ArchiveTab::fetched, this, [this](const QString& folder) {
    const bool opens = model_.requests() == requests_before_fetch_;
    archive_->offer(opens ? QString() : folder);
    if (opens) {
      open(folder.toStdString());
    } else {
      emit fetch_offered();
    }
  });
  connect(archive_, &ArchiveTab::offer_taken, this, [this](const QString& folder) { open(folder.toStdString()); });
}

/// The tab of the folder: buttons to open one, and the series found in it.
void ScanSection::build_series() {
  auto* const folder = new QPushButton(tr("Open DICOM folder…"), this);
  folder->setObjectName(QStringLiteral("palpateOpen"));
  folder->setToolTip(tr("Opens a folder of DICOM files, with all its subfolders. A folder may also be dropped here."));
  connect(folder, &QPushButton::clicked, this, [this] { ask_folder(); });
  auto* const file = new QPushButton(tr("File…"), this);
  file->setObjectName(QStringLiteral("palpateOpenFile"));
  file->setToolTip(tr("A scan in NIfTI, NRRD or MetaImage, or a zipped study. It may also be dropped here."));
  connect(file, &QPushButton::clicked, this, [this] { ask_file(); });
  auto* const ways = new QHBoxLayout;
  ways->addWidget(folder, 1);
  ways->addWidget(file);
  static_cast<QVBoxLayout*>(folder_->layout())->addLayout(ways);
  series_ = new SeriesList(model_, this);
  folder_->layout()->addWidget(series_);
  connect(series_, &SeriesList::thumbnail_drawn, this, [this](std::size_t n, const QImage& picture) {
    const FoundList* const found = model_.found();
    if (found && found->catalogue) {
      archive_->set_picture(QString::fromStdString(found->catalogue->series[n].uid), picture);
    }
    emit thumbnail_drawn(n, picture);
  });
}

void ScanSection::build_progress(QVBoxLayout& column) {
  auto* const work = new QHBoxLayout;
  progress_ = new QProgressBar(this);
  progress_->setObjectName(QStringLiteral("palpateProgress"));
  cancel_ = new QPushButton(tr("Cancel"), this);
  cancel_->setObjectName(QStringLiteral("palpateCancel"));
  connect(cancel_, &QPushButton::clicked, this, [this] { model_.cancel(); });
  work->addWidget(progress_, 1);
  work->addWidget(cancel_);
  column.addLayout(work);
  copy_ = new QPushButton(tr("A copy on this machine…"), this);
  copy_->setObjectName(QStringLiteral("palpateCopy"));
  copy_->setToolTip(
      tr("A folder of this machine with the same scan. The scan is then read from here, not from the server."));
  connect(copy_, &QPushButton::clicked, this, [this] { ask_copy(); });
  column.addWidget(copy_);
}

void ScanSection::build_notes() {
  notes_ = new QWidget(this);
  auto* const column = new QVBoxLayout(notes_);
  column->setContentsMargins(0, 0, 0, 0);
  column->addWidget(new FrameRow(model_, notes_));
  message_ = make_message_label(*notes_, "palpateMessage");
  column->addWidget(message_);
}

void ScanSection::refresh() {
  const auto work = work_of(model_);
  progress_->setVisible(work.has_value());
  cancel_->setVisible(work && work->can_cancel);
  if (work) {
    progress_->setFormat(work->what + QStringLiteral(" %p%"));
    progress_->setValue(static_cast<int>(100 * work->done));
  }
  const auto* const fetching = std::get_if<in_views::Fetching>(&model_.in_views());
  const auto* const far = std::get_if<in_views::OutOfReach>(&model_.in_views());
  copy_->setVisible((fetching && fetching->from_server) || (far && !far->of.catalogue && remote_server()));
}

void ScanSection::open(const std::string& path) {
  const QString folder = QString::fromStdString(path);
  const bool is_fetched = archive_->has_fetched(path);
  fetched_ = is_fetched ? path : std::string();
  if (!remote_server() && !is_fetched) remember_folder(folder);  // that one goes with the program
  model_.open(path);
}

void ScanSection::show_archive() {
  tabs_->setCurrentIndex(1);
}

bool ScanSection::offers_fetched() const {
  return archive_->offers();
}

void ScanSection::ask_copy() {
  const QString folder =
      QFileDialog::getExistingDirectory(this, tr("Folder of this machine with the scan that the server shows"));
  if (!folder.isEmpty()) model_.add_copy(folder.toStdString());
}

void ScanSection::ask_folder() {
  const QString title = tr("Open DICOM folder");
  if (pqServer* const server = remote_server()) {
    pqFileDialog dialog(server, this, title + tr(" of the server"));
    dialog.setFileMode(pqFileDialog::Directory);
    if (dialog.exec() == QDialog::Accepted && !dialog.getSelectedFiles().isEmpty()) {
      open(dialog.getSelectedFiles().first().toStdString());
    }
    return;
  }
  const QString folder = QFileDialog::getExistingDirectory(this, title, last_place());
  if (!folder.isEmpty()) open(folder.toStdString());
}

void ScanSection::ask_file() {
  const QString title = tr("Open a file");
  QStringList endings;
  for (const io::LabelFormat* const format : io::label_formats()) {
    for (const std::string_view ending : format->endings) {
      endings << QStringLiteral("*") + QString::fromUtf8(ending.data(), static_cast<int>(ending.size()));
    }
  }
  const QString kinds = QStringLiteral("%1 (%2 *.zip *.tar.gz *.tgz)").arg(tr("Scans"), endings.join(QLatin1Char(' ')));
  if (pqServer* const server = remote_server()) {
    pqFileDialog dialog(server, this, title + tr(" of the server"), QString(), kinds);
    dialog.setFileMode(pqFileDialog::ExistingFile);
    if (dialog.exec() == QDialog::Accepted && !dialog.getSelectedFiles().isEmpty()) {
      open(dialog.getSelectedFiles().first().toStdString());
    }
    return;
  }
  const QString all = tr("All files") + QStringLiteral(" (*)");
  const QString file = QFileDialog::getOpenFileName(this, title, last_place(), kinds + QStringLiteral(";;") + all);
  if (!file.isEmpty()) open(file.toStdString());
}

void ScanSection::dragEnterEvent(QDragEnterEvent* event) {
  if (event->mimeData()->hasUrls() && event->mimeData()->urls().first().isLocalFile()) event->acceptProposedAction();
}

void ScanSection::dropEvent(QDropEvent* event) {
  open_later(event->mimeData()->urls().first().toLocalFile());
}

void ScanSection::open_later(const QString& path) {
  QMetaObject::invokeMethod(
      this, [this, path] { open(path.toStdString()); }, Qt::QueuedConnection);
}

}  // namespace palpate::plugin

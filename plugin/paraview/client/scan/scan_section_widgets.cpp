#include <pqFileDialog.h>
#include <vtkSMPropertyHelper.h>

#include <QCheckBox>
#include <QComboBox>
#include <QDragEnterEvent>
#include <QFileDialog>
#include <QHBoxLayout>
#include <QListWidget>
#include <QMimeData>
#include <QProgressBar>
#include <QPushButton>
#include <QResizeEvent>
#include <QTabBar>
#include <QTimer>
#include <QUrl>
#include <QVBoxLayout>

#include <algorithm>
#include <filesystem>

#include "plugin/messages/messages.h"
#include "plugin/paraview/client/message_label.h"
#include "plugin/paraview/client/scan/archive_tab.h"
#include "plugin/paraview/client/scan/recent_folders.h"
#include "plugin/paraview/client/scan/scan_section.h"
#include "plugin/paraview/client/words.h"

// What stands in the section, from top to bottom, and the dialogs that ask for a folder or a file.

namespace palpate::plugin {

void ScanSection::build() {
  auto* const column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  build_tabs();
  build_series();
  build_progress(*column);
  build_window();

  auto* const ras = new QCheckBox(tr("Places under the pointer in RAS"), this);
  ras->setObjectName(QStringLiteral("palpateRas"));
  ras->setToolTip(tr("Right, anterior and superior are positive; DICOM and radiology write L/R, P/A, H/F instead."));
  connect(ras, &QCheckBox::toggled, this,
          [this](bool on) { views_.set_coordinates(on ? Coordinates::ras : Coordinates::letters); });
  column->addWidget(ras);

  notes_ = new QWidget(this);
  auto* const notes = new QVBoxLayout(notes_);
  notes->setContentsMargins(0, 0, 0, 0);
  notes->addWidget(frames_ = build_frames());
  message_ = make_message_label(*notes_, "palpateMessage");
  notes->addWidget(message_);
}

/// Of the folder: what opens one, and what was found in it.
void ScanSection::build_series() {
  open_ = new QPushButton(tr("Open DICOM folder…"), this);
  open_->setObjectName(QStringLiteral("palpateOpen"));
  open_->setToolTip(tr("Opens a folder of DICOM files, with all its subfolders. A folder may also be dropped here."));
  connect(open_, &QPushButton::clicked, this, [this] { ask_folder(); });
  auto* const file = new QPushButton(tr("File…"), this);
  file->setObjectName(QStringLiteral("palpateOpenFile"));
  file->setToolTip(tr("A scan in NIfTI, NRRD or MetaImage, or a zipped study. It may also be dropped here."));
  connect(file, &QPushButton::clicked, this, [this] { ask_file(); });
  auto* const ways = new QHBoxLayout;
  ways->addWidget(open_, 1);
  ways->addWidget(file);
  static_cast<QVBoxLayout*>(folder_->layout())->addLayout(ways);

  series_ = new QListWidget(this);
  series_->setObjectName(QStringLiteral("palpateSeries"));
  series_->setWordWrap(true);
  series_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  fit_series();
  series_->setIconSize({40, 40});
  connect(series_, &QListWidget::itemActivated, this,
          [this](QListWidgetItem* item) { load(item->data(Qt::UserRole).toULongLong()); });
  connect(series_, &QListWidget::itemClicked, this,
          [this](QListWidgetItem* item) { load(item->data(Qt::UserRole).toULongLong()); });
  folder_->layout()->addWidget(series_);
}

void ScanSection::build_progress(QVBoxLayout& column) {
  auto* const work = new QHBoxLayout;
  progress_ = new QProgressBar(this);
  progress_->setObjectName(QStringLiteral("palpateProgress"));
  cancel_ = new QPushButton(tr("Cancel"), this);
  cancel_->setObjectName(QStringLiteral("palpateCancel"));
  connect(cancel_, &QPushButton::clicked, this, [this] {
    loader_.cancel();
    server_scan_.cancel();
    set_busy(false);
    tell(words(say("cancelled")));
    if (remote_server() && source_) {
      emit out_of_reach(words(say("scan-is-on-the-server")));
    }
  });
  work->addWidget(progress_, 1);
  work->addWidget(cancel_);
  column.addLayout(work);
  copy_ = new QPushButton(tr("A copy on this machine…"), this);
  copy_->setObjectName(QStringLiteral("palpateCopy"));
  copy_->setToolTip(tr("A folder of this machine that holds the same scan: it is then not fetched from the server."));
  copy_->hide();
  connect(copy_, &QPushButton::clicked, this, [this] { ask_copy(); });
  column.addWidget(copy_);
}

/// Stands elsewhere: window_box().
void ScanSection::build_window() {
  window_ = new QComboBox(this);
  window_->setObjectName(QStringLiteral("palpateWindow"));
  window_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  window_->setMinimumContentsLength(14);
  window_->setToolTip(
      tr("Keys 1 to 9. Also: drag in a slice, to the right for a wider window, up for a brighter one."));
  connect(window_, QOverload<int>::of(&QComboBox::activated), this, [this](int choice) { apply_window(choice); });
  views_.set_window_changed([this] { show_window(); });
}

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
    std::vector<std::filesystem::path> open{path_};
    if (source_) open.emplace_back(vtkSMPropertyHelper(source_->getProxy(), "FileName").GetAsString());
    return open;
  });
  for (QWidget* const one : {static_cast<QWidget*>(tabs_), folder_, static_cast<QWidget*>(archive_)}) {
    layout()->addWidget(one);
  }
  // No pages of a tab widget: all of those would be as tall as the tallest.
  connect(tabs_, &QTabBar::currentChanged, this, [this](int tab) {
    folder_->setVisible(tab == 0);
    archive_->setVisible(tab == 1);
  });
  connect(archive_, &ArchiveTab::fetched, this, [this](const QString& folder) { open(folder.toStdString()); });
}

/// As high as its rows, up to a dozen: the panel's column scrolls, not a list within it.
void ScanSection::fit_series() {
  constexpr int most_rows = 12, least_height = 30;
  const int rows = std::min(series_->count(), most_rows);
  // No bar for those: it would take the width that their words are broken for.
  series_->setVerticalScrollBarPolicy(series_->count() > most_rows ? Qt::ScrollBarAsNeeded : Qt::ScrollBarAlwaysOff);
  series_->doItemsLayout();
  const auto place = [this](int row) { return series_->visualItemRect(series_->item(row)); };
  const int height = rows == 0 ? 0 : place(rows - 1).bottom() - place(0).top() + 1;
  series_->setFixedHeight(std::max(height + 2 * series_->frameWidth(), least_height));
}

void ScanSection::resizeEvent(QResizeEvent* event) {
  QWidget::resizeEvent(event);
  QTimer::singleShot(0, this, [this] { fit_series(); });  // when the list has its width, too
}

void ScanSection::set_busy(bool busy, const QString& what) {
  progress_->setVisible(busy);
  progress_->setFormat(what + QStringLiteral(" %p%"));
  progress_->setValue(0);
  cancel_->setVisible(busy);
  window_->setEnabled(!busy && source_ != nullptr);
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
  const QString kinds =
      tr("Scans") + QStringLiteral(" (*.nii *.nii.gz *.nrrd *.nhdr *.mha *.mhd *.zip *.tar.gz *.tgz)");
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
  open(event->mimeData()->urls().first().toLocalFile().toStdString());
}

}  // namespace palpate::plugin

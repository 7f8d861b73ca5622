#include "plugin/paraview/client/scan/scan_section.h"

#include <pqActiveObjects.h>
#include <pqApplicationCore.h>
#include <pqFileDialog.h>
#include <pqObjectBuilder.h>
#include <pqPipelineSource.h>
#include <pqServer.h>
#include <pqUndoStack.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMSourceProxy.h>
#include <vtkSMTrace.h>

#include <QCheckBox>
#include <QComboBox>
#include <QDragEnterEvent>
#include <QFileDialog>
#include <QHBoxLayout>
#include <QIcon>
#include <QImage>
#include <QLabel>
#include <QListWidget>
#include <QMimeData>
#include <QProgressBar>
#include <QPushButton>
#include <QTimer>
#include <QUrl>
#include <QVBoxLayout>

#include <algorithm>
#include <exception>

#include "plugin/messages/messages.h"
#include "plugin/paraview/client/scan/animation_time.h"
#include "plugin/paraview/client/scan/recent_folders.h"
#include "plugin/paraview/client/words.h"
#include "plugin/paraview/common/display_image.h"
#include "plugin/paraview/common/scan_choice.h"
#include "plugin/session/scan.h"

namespace palpate::plugin {
namespace {

QString text(const std::string& utf8) {
  return QString::fromStdString(utf8);
}

}  // namespace

ScanSection::ScanSection(QWidget* parent) : QWidget(parent) {
  setObjectName(QStringLiteral("palpateScan"));
  setAcceptDrops(true);
  build();
  set_busy(false);
}

ScanSection::~ScanSection() = default;

void ScanSection::build() {
  auto* const column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);

  open_ = new QPushButton(tr("Open DICOM folder…"), this);
  open_->setObjectName(QStringLiteral("palpateOpen"));
  open_->setToolTip(tr("A folder of DICOM files, searched to the bottom. A folder may also be dropped here."));
  connect(open_, &QPushButton::clicked, this, [this] { ask_folder(); });
  column->addWidget(open_);

  series_ = new QListWidget(this);
  series_->setObjectName(QStringLiteral("palpateSeries"));
  series_->setWordWrap(true);
  series_->setFixedHeight(130);
  series_->setIconSize({40, 40});
  connect(series_, &QListWidget::itemActivated, this,
          [this](QListWidgetItem* item) { load(item->data(Qt::UserRole).toULongLong()); });
  connect(series_, &QListWidget::itemClicked, this,
          [this](QListWidgetItem* item) { load(item->data(Qt::UserRole).toULongLong()); });
  column->addWidget(series_);

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
  column->addLayout(work);
  copy_ = new QPushButton(tr("A copy on this machine…"), this);
  copy_->setObjectName(QStringLiteral("palpateCopy"));
  copy_->setToolTip(tr("A folder of this machine that holds the same scan: it is then not fetched from the server."));
  copy_->hide();
  connect(copy_, &QPushButton::clicked, this, [this] { ask_copy(); });
  column->addWidget(copy_);

  window_ = new QComboBox(this);
  window_->setObjectName(QStringLiteral("palpateWindow"));
  window_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  window_->setMinimumContentsLength(18);
  window_->setToolTip(tr("Also: drag in a slice, to the right for a wider window, up for a brighter one."));
  connect(window_, QOverload<int>::of(&QComboBox::activated), this, [this](int choice) { apply_window(choice); });
  views_.set_window_changed([this] { show_window(); });

  auto* const ras = new QCheckBox(tr("Places under the pointer in RAS"), this);
  ras->setObjectName(QStringLiteral("palpateRas"));
  ras->setToolTip(
      tr("Instead of L/R, P/A, H/F as DICOM and radiology count: right, anterior and superior are positive."));
  connect(ras, &QCheckBox::toggled, this,
          [this](bool on) { views_.set_coordinates(on ? Coordinates::ras : Coordinates::letters); });
  column->addWidget(ras);

  notes_ = new QWidget(this);
  auto* const notes = new QVBoxLayout(notes_);
  notes->setContentsMargins(0, 0, 0, 0);
  notes->addWidget(frames_ = build_frames());
  message_ = new QLabel(notes_);
  message_->setObjectName(QStringLiteral("palpateMessage"));
  message_->setWordWrap(true);
  message_->setTextFormat(Qt::PlainText);
  notes->addWidget(message_);
}

void ScanSection::set_busy(bool busy, const QString& what) {
  progress_->setVisible(busy);
  progress_->setFormat(what + QStringLiteral(" %p%"));
  progress_->setValue(0);
  cancel_->setVisible(busy);
  window_->setEnabled(!busy && source_ != nullptr);
}

void ScanSection::tell(const QString& message, bool problem) {
  message_->setText(message);
  message_->setStyleSheet(problem ? QStringLiteral("color: #b00020; font-weight: bold") : QString());
  message_->setVisible(!message.isEmpty());
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

void ScanSection::dragEnterEvent(QDragEnterEvent* event) {
  if (event->mimeData()->hasUrls() && event->mimeData()->urls().first().isLocalFile()) event->acceptProposedAction();
}

void ScanSection::dropEvent(QDropEvent* event) {
  open(event->mimeData()->urls().first().toLocalFile().toStdString());
}

void ScanSection::open(const std::string& path) {
  path_ = path;
  catalogue_.reset();
  on_server_.reset();
  series_->clear();
  loader_.cancel();
  server_scan_.cancel();
  copy_->hide();
  tell({});
  if (remote_server()) {
    open_on_server();
    return;
  }
  remember_folder(text(path));
  set_busy(true, tr("Finding series"));
  loader_.find(
      path, [this](double done) { progress_->setValue(static_cast<int>(100 * done)); },
      [this](auto catalogue, const std::string& error) { list(std::move(catalogue), error); });
}

void ScanSection::list(std::shared_ptr<const io::Catalogue> catalogue, const std::string& error) {
  set_busy(false);
  if (!catalogue) {
    tell(text(error), true);
    return;
  }
  catalogue_ = std::move(catalogue);
  for (const std::size_t n : choices(*catalogue_, path_)) {
    const io::Series& series = scan_at(*catalogue_, n);
    auto* const item = new QListWidgetItem(text(scan_label(series)), series_);
    item->setData(Qt::UserRole, static_cast<qulonglong>(n));
    // Shown to verify the patient, never stored: only where the pointer rests.
    item->setToolTip(tr("%1\nID %2, study of %3")
                         .arg(text(series.identity.patient_name), text(series.identity.patient_id),
                              text(series.identity.study_date)));
    if (!series.usable) item->setForeground(palette().brush(QPalette::Disabled, QPalette::Text));
  }
  thumbnails_.draw_thumbnails(catalogue_, [this](const std::vector<QImage>& images) {
    for (int row = 0; row < series_->count(); ++row) {
      const auto n = static_cast<std::size_t>(series_->item(row)->data(Qt::UserRole).toULongLong());
      if (n < images.size() && !images[n].isNull()) series_->item(row)->setIcon(QIcon(QPixmap::fromImage(images[n])));
    }
  });
  const auto usable = std::ranges::count_if(catalogue_->series, [](const io::Series& s) { return s.usable; });
  if (catalogue_->series.empty()) {
    tell(words(say("no-image-series-in-this-folder", catalogue_->skipped.size())), true);
  } else if (usable == 1 && catalogue_->velocity_fields.empty()) {
    series_->setCurrentRow(0);
    load(choices(*catalogue_, path_).front());
  } else {
    tell(words(say("series-choose-one", scan_count(*catalogue_))));
  }
}

void ScanSection::load(std::size_t series) {
  if (on_server_ && series < on_server_->series.size()) {
    server_scan_.cancel();
    show({.path = path_, .name = on_server_->series[series].name, .catalogue = {}, .volume = {}});
    return;
  }
  if (!catalogue_ || series >= scan_count(*catalogue_)) return;
  set_busy(true, tr("Loading"));
  tell({});
  loader_.load(
      scan_at(*catalogue_, series), 0, {}, [this](double done) { progress_->setValue(static_cast<int>(100 * done)); },
      [this, catalogue = catalogue_, path = path_, series](const auto& volume, const std::string& error) {
        if (volume) show({path, scan_name(*catalogue, series), catalogue, series, volume});
        set_busy(false);
        if (!error.empty()) tell(text(error), true);
      });
}

void ScanSection::show(const Loaded& loaded) {
  // ParaView handles events while it makes a layout: another scan may be asked for meanwhile, and comes after this one.
  if (showing_) {
    QTimer::singleShot(100, this, [this, loaded] { show(loaded); });
    return;
  }
  showing_ = true;
  show_now(loaded);
  showing_ = false;
}

void ScanSection::show_now(const Loaded& loaded) {
  pqObjectBuilder& builder = *pqApplicationCore::instance()->getObjectBuilder();
  pqServer* const server = pqActiveObjects::instance().activeServer();
  if (!server) {
    tell(words(say("paraview-is-not-connected-to-a-server")), true);
    return;
  }
  try {
    SCOPED_UNDO_EXCLUDE();  // undo is for what is edited
    emit closing();
    if (!loaded.volume) emit out_of_reach({});
    views_.close();
    handle_ = {};
    frame_loader_.cancel();
    coming_.reset();
    if (source_) builder.destroy(source_);
    source_ = builder.createSource(QStringLiteral("sources"), QStringLiteral("PalpateDicomReader"), server);
    if (!source_) {
      throw Refusal(say("server-has-no-palpate-plug"));
    }
    vtkSMProxy& proxy = *source_->getProxy();
    {
      SM_SCOPED_TRACE(PropertiesModified).arg("proxy", &proxy);  // else a trace has a reader of nothing
      vtkSMPropertyHelper(&proxy, "FileName").Set(loaded.path.c_str());
      vtkSMPropertyHelper(&proxy, "SeriesUid").Set(loaded.name.c_str());
      proxy.UpdateVTKObjects();
    }
    source_->updatePipeline();
    set_animation_time(loaded.frame);  // another series: the time starts anew
    // There is nothing left for an Apply button to do; but the properties panel is told of the series only later, and
    // takes that for a change.
    QTimer::singleShot(0, source_, [source = source_] { source->setModifiedState(pqProxy::UNMODIFIED); });
    views_.show(*source_);
    list_windows();
    say_what_to_know(loaded);
    take(loaded);
    if (!loaded.volume) fetch();
  } catch (const std::exception& error) {
    tell(text(error.what()), true);
  }
}

/// What is shown from now on is this.
void ScanSection::take(const Loaded& loaded) {
  catalogue_shown_ = loaded.catalogue;
  series_shown_ = loaded.series;
  if (!loaded.volume) {
    felt_source_.clear();
    return;
  }
  handle_ = {.series = source_->getSMName(), .volume = loaded.volume, .frame = loaded.frame};
  felt_source_ = source_;
  if (loaded.catalogue) {
    const io::Series& series = scan_at(*loaded.catalogue, loaded.series);
    handle_.series = text(scan_label(series));
    handle_.frames = series.frames_per_position;
    handle_.frame_names = series.frame_names;
  } else {
    handle_.series = text(describe_scan(*loaded.volume));
    handle_.frames =
        std::max(1, static_cast<int>(vtkSMPropertyHelper(source_->getProxy(), "TimestepValues").GetNumberOfElements()));
  }
  pqActiveObjects::instance().setActiveSource(source_);  // what ParaView's own panels are about
  watch_time();
  show_frame();
  emit scan_shown(handle_);
}

void ScanSection::list_windows() {
  window_->clear();
  for (const NamedWindow& named : views_.windows()) {
    window_->addItem(QStringLiteral("%1 (%2 / %3)")
                         .arg(tr(named.name))
                         .arg(named.window.level, 0, 'g', 4)
                         .arg(named.window.width, 0, 'g', 4));
  }
  show_window();
}

/// The one that the slices have; where it has no name, as one more.
void ScanSection::show_window() {
  const auto& named = views_.windows();
  const int custom = static_cast<int>(named.size());
  const Window& now = views_.window();
  const auto same = std::ranges::find_if(
      named, [&](const NamedWindow& of) { return of.window.level == now.level && of.window.width == now.width; });
  if (same != named.end() || named.empty()) {
    window_->removeItem(custom);
    window_->setCurrentIndex(named.empty() ? -1 : static_cast<int>(same - named.begin()));
    return;
  }
  if (window_->count() == custom) window_->addItem(QString());
  window_->setItemText(custom, tr("Custom (%1 / %2)").arg(now.level, 0, 'f', 0).arg(now.width, 0, 'f', 0));
  window_->setCurrentIndex(custom);
}

void ScanSection::say_what_to_know(const Loaded& loaded) {
  QStringList notes;
  if (!loaded.volume) {
    for (const std::string& message : messages_of(*source_->getSourceProxy())) notes << text(message);
    tell(notes.join(QStringLiteral("\n")));
    return;
  }
  const io::Series& shown = scan_at(*loaded.catalogue, loaded.series);
  for (const std::string& warning : shown.warnings) notes << text(warning);
  for (const std::string& warning : loaded.volume->warnings) notes << text(warning);
  if (display_grid(shown.geometry).resampled) notes << words(say("display-resampled-touch-is-not"));
  if (!is_straight(display_grid(shown.geometry))) {
    notes << words(say("oblique-or-tilted"));
  }
  tell(notes.join(QStringLiteral("\n")));
}

void ScanSection::apply_window(int choice) {
  if (choice >= 0 && choice < static_cast<int>(views_.windows().size())) {
    views_.set_window(views_.windows()[static_cast<std::size_t>(choice)].window);
  }
}

}  // namespace palpate::plugin

#include "plugin/paraview/client/scan/scan_section.h"

#include <pqActiveObjects.h>
#include <pqApplicationCore.h>
#include <pqObjectBuilder.h>
#include <pqPipelineSource.h>
#include <pqServer.h>
#include <pqUndoStack.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMSourceProxy.h>
#include <vtkSMTrace.h>

#include <QComboBox>
#include <QListWidget>
#include <QProgressBar>
#include <QPushButton>
#include <QTabBar>
#include <QTimer>

#include <algorithm>
#include <exception>
#include <filesystem>

#include "modes/scene/starting_scene.h"
#include "plugin/app/scan_choice.h"
#include "plugin/messages/messages.h"
#include "plugin/paraview/client/message_label.h"
#include "plugin/paraview/client/scan/animation_time.h"
#include "plugin/paraview/client/scan/archive_tab.h"
#include "plugin/paraview/client/scan/recent_folders.h"
#include "plugin/paraview/client/scan/scan_identity.h"
#include "plugin/paraview/client/words.h"
#include "plugin/paraview/common/display_image.h"
#include "plugin/session/scan.h"

namespace palpate::plugin {
namespace {

constexpr int again_ms = 100;

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

void ScanSection::tell(const QString& message, bool problem) {
  show_message(*message_, message, problem);
  emit said(message, problem);
}

void ScanSection::open(const std::string& path) {
  path_ = path;
  ++asked_;
  catalogue_.reset();
  on_server_.reset();
  series_->clear();
  fit_series();
  loader_.cancel();
  server_scan_.cancel();
  copy_->hide();
  emit finding();
  tell({});
  if (remote_server()) {
    open_on_server();
    return;
  }
  if (!archive_->has_fetched(path)) remember_folder(text(path));  // that one goes with the program
  set_busy(true, tr("Finding series"));
  loader_.find(
      path, [this](double done) { progress_->setValue(static_cast<int>(100 * done)); },
      [this](auto catalogue, const std::string& error) { list(std::move(catalogue), error); });
}

void ScanSection::list(std::shared_ptr<const io::Catalogue> catalogue, const std::string& error) {
  if (is_in_paraview()) {  // what is shown may have to be closed
    QTimer::singleShot(again_ms, this, [this, catalogue, error, path = path_] {
      if (path == path_) list(catalogue, error);
    });
    return;
  }
  set_busy(false);
  if (!catalogue) {
    tell(text(error), true);
    return;
  }
  catalogue_ = std::move(catalogue);
  leave_other_patient();
  list_rows();
  draw_thumbnails();
  if (catalogue_->series.empty()) {
    tell(words(say("no-image-series-in-this-folder", catalogue_->skipped.size())), true);
  } else if (const auto only = only_scan(*catalogue_)) {
    load(*only);
  } else {
    tabs_->setCurrentIndex(0);
    emit listed(catalogue_);
    tell(words(say("series-choose-one", scan_count(*catalogue_))));
  }
}

void ScanSection::show_archive() {
  tabs_->setCurrentIndex(1);
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
        volume ? show({path, scan_name(*catalogue, series), catalogue, series, volume}) : set_busy(false);
        if (!error.empty()) tell(text(error), true);
      });
}

/// ParaView handles events while it makes a view: what they ask for comes after it.
bool ScanSection::is_in_paraview() const {
  return showing_ || views_.is_inside();
}

void ScanSection::show(const Loaded& loaded) {
  ++asked_;
  if (is_in_paraview()) {
    QTimer::singleShot(again_ms, this, [this, loaded, asked = asked_] {
      if (asked == asked_) show(loaded);
    });
    return;
  }
  showing_ = true;
  show_now(loaded);
  showing_ = false;
}

void ScanSection::show_now(const Loaded& loaded) {
  pqServer* const server = pqActiveObjects::instance().activeServer();
  if (!server) {
    set_busy(false);
    tell(words(say("paraview-is-not-connected-to-a-server")), true);
    return;
  }
  set_busy(true, tr("Showing"));
  cancel_->hide();
  try {
    SCOPED_UNDO_EXCLUDE();  // undo is for what is edited
    emit closing();
    if (!loaded.volume) emit out_of_reach({});
    views_.close();
    handle_ = {};
    frame_loader_.cancel();
    coming_.reset();
    felt_source_.clear();
    catalogue_shown_ = loaded.catalogue;
    series_shown_ = loaded.series;
    if (source_) pqApplicationCore::instance()->getObjectBuilder()->destroy(source_);
    views_.make_room();
    read(loaded, *server);
    views_.show(*source_, [this, loaded](const std::string& error) { views_are_made(loaded, error); });
  } catch (const std::exception& error) {
    catalogue_shown_.reset();
    set_busy(false);
    tell(text(error.what()), true);
  }
}

/// The voxels are here already, or are the server's.
void ScanSection::read(const Loaded& loaded, pqServer& server) {
  source_ = pqApplicationCore::instance()->getObjectBuilder()->createSource(
      QStringLiteral("sources"), QStringLiteral("PalpateDicomReader"), &server);
  if (!source_) {
    throw Refusal(say("server-has-no-palpate-plug"));
  }
  vtkSMProxy& proxy = *source_->getProxy();
  vtkSMPropertyHelper(&proxy, "ShowMessages", true).Set(0);  // they stand in this section
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
}

void ScanSection::views_are_made(const Loaded& loaded, const std::string& error) {
  if (!loader_.is_busy()) set_busy(false);
  if (!error.empty()) {
    tell(text(error), true);
    return;
  }
  if (!source_) {  // deleted since the last of them was made
    views_.close();
    tell(words(say("scan-left-the-pipeline")), true);
    return;
  }
  try {
    SCOPED_UNDO_EXCLUDE();
    list_windows();
    if (loaded.path == path_) say_what_to_know(loaded);  // else another folder is open, and has told what it holds
    take(loaded);
    if (!loaded.volume) fetch(loaded.path);
  } catch (const std::exception& problem) {
    tell(text(problem.what()), true);
  }
}

/// What is shown from now on is this.
void ScanSection::take(const Loaded& loaded) {
  catalogue_shown_ = loaded.catalogue;
  series_shown_ = loaded.series;
  const io::Series* const of = loaded.catalogue ? &scan_at(*loaded.catalogue, loaded.series) : nullptr;
  views_.set_scan_texts(of ? identity_text(*of) : QString(), of ? of->details.thickness_mm : 0);
  if (!loaded.volume) {
    felt_source_.clear();
    return;
  }
  handle_ = {.series = source_->getSMName(), .volume = loaded.volume, .frame = loaded.frame};
  felt_source_ = source_;
  if (loaded.catalogue) {
    const io::Series& series = scan_at(*loaded.catalogue, loaded.series);
    handle_.series = text(scan_label(series));
    if (!loaded.volume->vectors) handle_.scene = modes::starting_scene(series);
    handle_.frames = series.frames_per_position;
    handle_.frame_names = series.frame_names;
  } else {
    handle_.series = text(describe_scan(*loaded.volume));
    handle_.frames = server_frames();
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
    window_->setItemData(window_->count() - 1, tr("Key %1").arg(window_->count()), Qt::ToolTipRole);
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

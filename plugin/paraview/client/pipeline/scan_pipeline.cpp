#include "plugin/paraview/client/pipeline/scan_pipeline.h"

#include <pqActiveObjects.h>
#include <pqApplicationCore.h>
#include <pqObjectBuilder.h>
#include <pqRepresentation.h>
#include <pqServer.h>
#include <pqServerManagerModel.h>
#include <pqTimeKeeper.h>
#include <pqUndoStack.h>
#include <pqView.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMSourceProxy.h>
#include <vtkSMTrace.h>

#include <QTimer>
#include <QWidget>

#include <algorithm>
#include <exception>
#include <utility>

#include "plugin/app/scan_choice.h"
#include "plugin/messages/messages.h"
#include "plugin/paraview/client/pipeline/animation_time.h"
#include "plugin/paraview/client/words.h"
#include "plugin/paraview/client/words/scan_identity.h"
#include "plugin/paraview/common/display_image.h"

namespace palpate::plugin {
namespace {

bool is_scan(const pqPipelineSource& source) {
  return source.getProxy() && source.getProxy()->GetXMLName() == std::string("PalpateDicomReader");
}

bool is_seen(const pqPipelineSource& source) {
  const auto shown = source.getRepresentations(nullptr);
  return std::ranges::any_of(shown, [](const pqDataRepresentation* one) {
    return one->isVisible() && one->getView() && one->getView()->widget()->isVisible();
  });
}

SeriesRef series_of(pqPipelineSource& reader) {
  SeriesRef of{.path = vtkSMPropertyHelper(reader.getProxy(), "FileName").GetAsString(),
               .name = vtkSMPropertyHelper(reader.getProxy(), "SeriesUid").GetAsString(),
               .label = {}};
  of.label = reader.getSMName();
  return of;
}

}  // namespace

void ScanPipeline::follow(ScanModel& model) {
  model_ = &model;
  QObject::connect(&model, &ScanModel::scan_shown, &lifetime_, [this](const ScanHandle& scan) { take(scan); });
  QObject::connect(&model, &ScanModel::frame_shown, &lifetime_, [this](const ScanHandle& scan) {
    views_.set_frame_text(scan.frame_in_words());
    views_.refresh_values();
  });
  auto* const pipeline = pqApplicationCore::instance()->getServerManagerModel();
  QObject::connect(pipeline, &pqServerManagerModel::preSourceRemoved, &lifetime_,
                   [this](pqPipelineSource* source) { watch_removed(source); });
  QObject::connect(pipeline, &pqServerManagerModel::sourceAdded, &lifetime_,
                   [this](pqPipelineSource* source) { watch_added(source); });
}

// Changes by the user.

/// After ParaView has finished the removal. If a scan was shown again meanwhile, it has a reader.
void ScanPipeline::watch_removed(const pqPipelineSource* removed) {
  if (removed != source_) return;
  QTimer::singleShot(0, &lifetime_, [this] {
    if (!source_) model_->lose();
  });
}

/// Undo brings a reader back, and what its views showed of it.
void ScanPipeline::watch_added(pqPipelineSource* added) {
  if (making_reader_ || !is_scan(*added)) return;
  QTimer::singleShot(0, &lifetime_, [this, added = QPointer(added)] {
    const auto* const lost = std::get_if<in_views::Lost>(&model_->in_views());
    if (!added || source_ || !lost) return;
    const SeriesRef of = series_of(*added);
    if (of.path == lost->of.path && of.name == lost->of.name) restore(*added, Brought::by_undo);
  });
}

void ScanPipeline::restore(pqPipelineSource& reader, Brought brought) {
  views_.stop_making();
  if (brought == Brought::by_state) {  // the scan before goes, with its views and their tab
    SCOPED_UNDO_EXCLUDE();
    views_.close();
    destroy_reader();
    views_.drop_layout();
  }
  source_ = &reader;
  model_->restore(series_of(reader), brought);
}

void ScanPipeline::watch_time() {
  QObject::disconnect(time_);
  // Once ParaView is done with it.
  time_ = QObject::connect(source_->getServer()->getTimeKeeper(), &pqTimeKeeper::timeChanged, &lifetime_,
                           [this] { QTimer::singleShot(0, &lifetime_, [this] { model_->follow_time(); }); });
}

/// From now on this is the shown scan.
void ScanPipeline::take(const ScanHandle& scan) {
  const io::Series* const details = scan.of.details();
  views_.set_scan_texts(details ? identity_text(*details) : QString(), details ? details->details.thickness_mm : 0);
  views_.set_frame_text(scan.frame_in_words());
  pqActiveObjects::instance().setActiveSource(source_);  // what ParaView's own panels are about
  watch_time();
}

// From a folder to a series.

bool ScanPipeline::is_remote() const {
  return remote_server() != nullptr;
}

void ScanPipeline::find(const std::string& path, Progress progress, Found found) {
  on_server_.reset();
  pqServer* const server = remote_server();
  if (!server) {
    loader_.find(
        path, [progress = std::move(progress)](double done) { progress({}, done); },
        [path, found = std::move(found)](auto catalogue, const std::string& error) {
          found({.path = path, .catalogue = std::move(catalogue)}, error);
        });
    return;
  }
  FoundList list{.path = path};
  try {
    on_server_ = find_on_server(*server, path);
  } catch (const std::exception& error) {
    found(list, error.what());
    return;
  }
  list.on_server = on_server_->series;
  found(list, {});
}

void ScanPipeline::load(const io::Series& series, int frame, Progress progress, Loaded loaded) {
  loader_.load(
      series, frame, {}, [progress = std::move(progress)](double done) { progress({}, done); }, std::move(loaded));
}

void ScanPipeline::stop() {
  loader_.cancel();
}

void ScanPipeline::load_frame(const io::Series& series, int frame, const io::Filter& filter, Loaded loaded) {
  frame_loader_.load(
      series, frame, filter, [](double) {}, std::move(loaded));
}

void ScanPipeline::stop_frames() {
  frame_loader_.cancel();
}

// Reader and views.

void ScanPipeline::show(const SeriesRef& of, int frame, Made made) {
  views_.alone([this, of, frame, made = std::move(made)] { show_now(of, frame, made); });
}

void ScanPipeline::show_now(const SeriesRef& of, int frame, const Made& made) {
  pqServer* const server = pqActiveObjects::instance().activeServer();
  if (!server) {
    made(words(say("paraview-is-not-connected-to-a-server")).toStdString());
    return;
  }
  // Undo would bring a deleted reader back beside the one that is made now.
  if (auto* const steps = pqApplicationCore::instance()->getUndoStack()) steps->clear();
  try {
    SCOPED_UNDO_EXCLUDE();  // undo is for what is edited
    views_.close();
    destroy_reader();
    views_.make_room();
    read(of, frame, *server);
    views_.show(*source_, made);
  } catch (const std::exception& error) {
    made(error.what());
  }
}

/// The voxels are here already, or are the server's.
void ScanPipeline::read(const SeriesRef& of, int frame, pqServer& server) {
  making_reader_ = true;
  source_ = pqApplicationCore::instance()->getObjectBuilder()->createSource(
      QStringLiteral("sources"), QStringLiteral("PalpateDicomReader"), &server);
  making_reader_ = false;
  if (!source_) {
    throw Refusal(say("server-has-no-palpate-plug"));
  }
  vtkSMProxy& proxy = *source_->getProxy();
  vtkSMPropertyHelper(&proxy, "ShowMessages", true).Set(0);  // they stand in the panel
  {
    SM_SCOPED_TRACE(PropertiesModified).arg("proxy", &proxy);  // else a trace has a reader of nothing
    vtkSMPropertyHelper(&proxy, "FileName").Set(of.path.c_str());
    vtkSMPropertyHelper(&proxy, "SeriesUid").Set(of.name.c_str());
    proxy.UpdateVTKObjects();
  }
  source_->updatePipeline();
  set_animation_time(frame);  // another series: the time starts anew
  // Nothing is left to apply; but the properties panel learns of the series only later, and takes that for a change.
  QTimer::singleShot(0, source_, [source = source_] { source->setModifiedState(pqProxy::UNMODIFIED); });
}

void ScanPipeline::destroy_reader() {
  const QPointer<pqPipelineSource> old = std::exchange(source_, nullptr);
  if (old) pqApplicationCore::instance()->getObjectBuilder()->destroy(old);
}

void ScanPipeline::adopt() {
  if (!source_) throw Refusal(say("scan-left-the-pipeline"));
  SCOPED_UNDO_EXCLUDE();
  source_->updatePipeline();
  views_.adopt(*source_);
}

void ScanPipeline::close() {
  views_.alone([this] {
    SCOPED_UNDO_EXCLUDE();
    views_.close();
    destroy_reader();
  });
}

void ScanPipeline::abandon() {
  views_.let_go();
  server_scan_.cancel();
  server_scan_.forget();
  on_server_.reset();
}

// From the views to the voxels.

void ScanPipeline::fetch(const SeriesRef& of, std::optional<int> frame, const io::Filter& filter,
                         std::vector<std::string> places, Progress progress, Fetched fetched) {
  if (!source_ || !source_->getServer()->isRemote()) {
    fetch_local(of, filter, progress, fetched);
    return;
  }
  const int frames =
      std::max(1, static_cast<int>(vtkSMPropertyHelper(source_->getProxy(), "TimestepValues").GetNumberOfElements()));
  const int wanted = frame.value_or(frame_in_views(frames));
  server_scan_.get(*source_, wanted, std::move(places), std::move(progress),
                   [of, wanted, frames, fetched = std::move(fetched)](const ServerScan::Found& found) {
                     fetched({.volume = found.volume, .said = found.said, .of = of, .frame = wanted, .frames = frames});
                   });
}

/// The series that a reader names, from its files.
void ScanPipeline::fetch_local(const SeriesRef& of, const io::Filter& filter, const Progress& progress,
                               const Fetched& fetched) {
  const auto fail = [fetched, of](const std::string& why) {
    fetched({.volume = {}, .said = QString::fromStdString(why), .of = of});
  };
  loader_.find(
      of.path, [progress](double done) { progress(tr("Finding series"), done); },
      [this, of, filter, progress, fetched, fail](const auto& catalogue, const std::string& error) {
        if (!catalogue) return fail(error);
        std::size_t series = 0;
        try {
          series = choose_scan(*catalogue, of.name, of.path);
        } catch (const std::exception& refused) {  // the folder is no longer the one that was saved
          return fail(refused.what());
        }
        const SeriesRef found = FoundList{.path = of.path, .catalogue = catalogue}.at(series);
        const int frames = found.details()->frames_per_position;
        const int frame = frame_in_views(frames);
        loader_.load(
            *found.details(), frame, filter, [progress](double done) { progress(tr("Loading"), done); },
            [fetched, fail, found, frame, frames](const auto& volume, const std::string& why) {
              if (!volume) return fail(why);
              fetched({.volume = volume, .said = {}, .of = found, .frame = frame, .frames = frames});
            });
      });
}

void ScanPipeline::stop_fetching() {
  server_scan_.cancel();
}

// The frame.

void ScanPipeline::show_frame(int frame) {
  set_animation_time(frame);
}

int ScanPipeline::frame_in_views(int frames) const {
  return source_ ? frame_at(frames, source_->getServer()->getTimeKeeper()->getTime()) : 0;
}

// What the views show.

ViewFacts ScanPipeline::facts() const {
  if (!source_) return {};
  ViewFacts facts{.in_pipeline = true, .seen = is_seen(*source_), .name = source_->getSMName().toStdString()};
  pqPipelineSource* const active = pqActiveObjects::instance().activeSource();
  if (active && active != source_ && is_scan(*active)) facts.other = active->getSMName().toStdString();
  return facts;
}

QStringList ScanPipeline::others_shown() const {
  QStringList names;
  for (auto* const source : pqApplicationCore::instance()->getServerManagerModel()->findItems<pqPipelineSource*>()) {
    if (source != source_ && is_scan(*source) && is_seen(*source)) names << source->getSMName();
  }
  return names;
}

QString ScanPipeline::notes(const SeriesRef& of, const io::Volume* volume) const {
  QStringList notes;
  if (!volume) {
    for (const std::string& message : messages_of(*source_->getSourceProxy())) notes << QString::fromStdString(message);
    return notes.join(QLatin1Char('\n'));
  }
  const io::Series& shown = *of.details();
  for (const std::string& warning : shown.warnings) notes << QString::fromStdString(warning);
  for (const std::string& warning : volume->warnings) notes << QString::fromStdString(warning);
  const DisplayGrid grid = display_grid(shown.geometry);
  if (grid.resampled) notes << words(say("display-resampled-touch-is-not"));
  if (!is_straight(grid) && advanced_) notes << words(say("oblique-or-tilted"));
  return notes.join(QLatin1Char('\n'));
}

}  // namespace palpate::plugin

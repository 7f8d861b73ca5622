#include <pqServer.h>
#include <pqTimeKeeper.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMSourceProxy.h>

#include <QFileDialog>
#include <QLabel>
#include <QListWidget>
#include <QProgressBar>
#include <QPushButton>

#include <algorithm>
#include <exception>

#include "plugin/app/scan_choice.h"
#include "plugin/messages/messages.h"
#include "plugin/paraview/client/scan/scan_section.h"
#include "plugin/paraview/client/words.h"

// What of the panel's first section has to do with another program: a server, or a state file's reader.

namespace palpate::plugin {
namespace {

QString text(const std::string& utf8) {
  return QString::fromStdString(utf8);
}

}  // namespace

void ScanSection::open_on_server() {
  try {
    emit out_of_reach({});  // looking and reading block: nothing is to be held meanwhile
    on_server_ = find_on_server(*remote_server(), path_);
  } catch (const std::exception& error) {
    set_busy(false);
    tell(text(error.what()), true);
    return;
  }
  std::vector<std::size_t> usable;
  for (std::size_t n = 0; n < on_server_->series.size(); ++n) {
    const ServerSeries::One& one = on_server_->series[n];
    auto* const item = new QListWidgetItem(text(one.label), series_);
    item->setData(Qt::UserRole, static_cast<qulonglong>(n));
    if (one.usable) usable.push_back(n);
    if (!one.usable) item->setForeground(palette().brush(QPalette::Disabled, QPalette::Text));
  }
  if (usable.size() == 1) {
    load(usable.front());
  } else {
    tell(words(say("series-choose-one", on_server_->series.size())));
  }
}

/// The frame that is shown.
void ScanSection::fetch(const std::string& path) {
  copy_->show();
  set_busy(true);
  std::vector<std::string> places{path};
  places.insert(places.end(), copies_.begin(), copies_.end());
  const int frames = server_frames();
  const int frame = frame_at(frames, source_->getServer()->getTimeKeeper()->getTime());
  server_scan_.get(
      *source_, frame, places,
      [this](const QString& what, double done) {
        progress_->setFormat(what + QStringLiteral(" %p%"));
        progress_->setValue(static_cast<int>(100 * done));
      },
      [this, frame, path](const ServerScan::Found& found) {
        set_busy(false);
        const QString notes = message_->text();
        tell(notes.isEmpty() ? found.said : notes + QLatin1Char('\n') + found.said, !found.volume);
        copy_->setVisible(!found.volume);
        if (found.volume) {
          take({.path = path, .name = {}, .catalogue = {}, .volume = found.volume, .frame = frame});
        } else {
          emit out_of_reach(found.said);
        }
      });
}

int ScanSection::server_frames() const {
  const vtkSMPropertyHelper times(source_->getProxy(), "TimestepValues");
  return std::max(1, static_cast<int>(times.GetNumberOfElements()));
}

/// What is felt stays the frame before until the other one is here: why_not_felt() keeps the force off meanwhile.
void ScanSection::fetch_frame(int frame) {
  if (server_scan_.is_busy() && frame == fetching_) return;
  fetching_ = frame;
  set_busy(true);
  std::vector<std::string> places{path_};
  places.insert(places.end(), copies_.begin(), copies_.end());
  server_scan_.get(
      *source_, frame, places,
      [this](const QString& what, double done) {
        progress_->setFormat(what + QStringLiteral(" %p%"));
        progress_->setValue(static_cast<int>(100 * done));
      },
      [this, frame](const ServerScan::Found& found) {
        set_busy(false);
        if (!found.volume) {
          tell(found.said, true);
          return;
        }
        show_frame_of(found.volume, frame);
      });
}

void ScanSection::ask_copy() {
  const QString folder =
      QFileDialog::getExistingDirectory(this, tr("Folder of this machine with the scan that the server shows"));
  if (folder.isEmpty() || !source_) return;
  copies_.push_back(folder.toStdString());
  fetch(path_);
}

void ScanSection::server_gone() {
  ++asked_;
  views_.stop_making();
  server_scan_.cancel();
  server_scan_.forget();
  on_server_.reset();
  copy_->hide();
  set_busy(false);
  frame_loader_.cancel();
  handle_ = {};
  show_frame();
}

void ScanSection::adopt(pqPipelineSource& reader) {
  ++asked_;
  views_.stop_making();
  source_ = &reader;
  path_ = vtkSMPropertyHelper(reader.getProxy(), "FileName").GetAsString();
  loader_.cancel();
  server_scan_.cancel();
  if (reader.getServer()->isRemote()) {
    adopt_from_server();
    return;
  }
  const std::string path = path_;
  const std::string name = vtkSMPropertyHelper(reader.getProxy(), "SeriesUid").GetAsString();
  set_busy(true, tr("Finding series"));
  loader_.find(
      path, [this](double done) { progress_->setValue(static_cast<int>(100 * done)); },
      [this, path, name](const auto& catalogue, const std::string& error) {
        set_busy(false);
        if (!catalogue) {
          tell(text(error), true);
          return;
        }
        std::size_t series = 0;
        try {
          series = choose_scan(*catalogue, name, path);
        } catch (const std::exception& refused) {  // the folder is no longer the one that was saved
          tell(text(refused.what()), true);
          return;
        }
        const int frames = scan_at(*catalogue, series).frames_per_position;
        const double time = source_ ? source_->getServer()->getTimeKeeper()->getTime() : 0;
        const int frame = frame_at(frames, time);
        loader_.load(
            scan_at(*catalogue, series), frame, felt_filter(), [](double) {},
            [this, catalogue, path, name, series, frame](const auto& volume, const std::string& why) {
              if (!volume || !source_) {
                tell(text(why), true);
                return;
              }
              source_->updatePipeline();
              views_.adopt(*source_);
              list_windows();
              const Loaded loaded{path, name, catalogue, series, volume, frame};
              say_what_to_know(loaded);
              take(loaded);
            });
      });
}

void ScanSection::adopt_from_server() {
  emit out_of_reach({});
  source_->updatePipeline();
  views_.adopt(*source_);
  list_windows();
  say_what_to_know({});
  fetch(path_);
}

}  // namespace palpate::plugin

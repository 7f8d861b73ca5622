#include "plugin/paraview/client/remote/server_scan.h"

#include <pqServer.h>
#include <vtkNew.h>
#include <vtkPVSession.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMSession.h>
#include <vtkSMSourceProxy.h>

#include <QElapsedTimer>
#include <QTimer>

#include <algorithm>
#include <exception>
#include <stdexcept>
#include <utility>
#include <variant>

#include "plugin/messages/messages.h"
#include "plugin/paraview/client/remote/server_series.h"
#include "plugin/paraview/client/words.h"
#include "plugin/paraview/server/module/PalpateScanSlices.h"
#include "plugin/session/scan_hash.h"

namespace palpate::plugin {
namespace {

/// Puts slices on top; where their types differ, all become floats, as of the whole scan.
void append(io::Volume::Voxels& to, const io::Volume::Voxels& more, std::size_t whole) {
  if (std::visit([](const auto& v) { return v.empty(); }, to)) {
    to = more;
    std::visit([&](auto& v) { v.reserve(whole); }, to);
    return;
  }
  if (to.index() != more.index() && !std::holds_alternative<std::vector<float>>(to)) {
    std::vector<float> floats;
    floats.reserve(whole);
    std::visit([&](const auto& v) { floats.assign(v.begin(), v.end()); }, to);
    to = std::move(floats);
  }
  std::visit([&](auto& all) { std::visit([&](const auto& v) { all.insert(all.end(), v.begin(), v.end()); }, more); },
             to);
}

std::size_t slice_size(const io::Volume& volume) {
  return static_cast<std::size_t>(volume.geometry.dimensions.x) *
         static_cast<std::size_t>(volume.geometry.dimensions.y);
}

}  // namespace

void ServerScan::get(pqPipelineSource& reader, int frame, std::vector<std::string> places, Progress progress,
                     Done done) {
  cancel();
  reader_ = &reader;
  frame_ = frame;
  places_ = std::move(places);
  progress_ = std::move(progress);
  done_ = std::move(done);
  differs_ = false;
  copies_.clear();
  next(&ServerScan::ask_head);
}

void ServerScan::cancel() {
  ++run_;
  loader_.cancel();
  done_ = {};
  voxels_ = {};
  start();
}

void ServerScan::start() {
  hashes_.clear();
  slice_ = 0;
  at_a_time_ = 1;
}

void ServerScan::next(Step step, int delay_ms) {
  QTimer::singleShot(delay_ms, this, [this, step, run = run_] {
    if (run != run_) return;
    constexpr int again_ms = 20;
    if (!reader_) {
      finish(nullptr, words(say("scan-left-the-server")));
    } else if (!is_free(*reader_->getServer())) {
      next(step, again_ms);
    } else {
      (this->*step)();
    }
  });
}

void ServerScan::finish(const std::shared_ptr<const io::Volume>& volume, const QString& said) {
  const Done done = std::move(done_);
  cancel();
  copies_.clear();
  if (done) done({volume, said});
}

bool ServerScan::ask(SlicesAsked asked, SlicesAnswered& answered) {
  vtkNew<PalpateScanSlices> slices;
  asked.frame = frame_;
  slices->asked() = asked;
  vtkSMProxy& proxy = *reader_->getProxy();
  const unsigned run = run_;
  // What GatherInformation() returns of a remote server says nothing; an answer takes this away.
  slices->answered().error = say("does-not-answer");
  proxy.GetSession()->GatherInformation(vtkPVSession::DATA_SERVER_ROOT, slices, proxy.GetGlobalID());
  answered = std::move(slices->answered());
  if (run != run_) return false;  // given up meanwhile: the server went
  if (answered.error.empty()) return true;
  finish(nullptr, words(say("server-cannot-give-the-scan-voxels", answered.error)));
  return false;
}

void ServerScan::ask_head() {
  SlicesAnswered answered;
  if (!ask({.what = SlicesAsked::What::head}, answered)) return;
  try {
    head_ = volume_of_head(answered.head);
  } catch (const std::exception& error) {
    finish(nullptr, QString::fromUtf8(error.what()));
    return;
  }
  look_for_copies();
}

void ServerScan::look_for_copies() {
  vtkSMProxy& proxy = *reader_->getProxy();
  std::string name = vtkSMPropertyHelper(&proxy, "SeriesUid").GetAsString();
  if (name.empty()) name = vtkSMPropertyHelper(&proxy, "SeriesUids").GetAsString();  // the first of them is meant
  loader_.find_copies(
      places_, name, head_.geometry.dimensions,
      [this](double done) { progress_(tr("Looking for a copy on this machine"), done); },
      [this](const std::vector<ScanCopy>& copies, const std::string&) {
        copies_ = copies;
        start();
        next(copies_.empty() && fetched_.empty() ? &ServerScan::fetch : &ServerScan::ask_hashes);
      });
}

bool ServerScan::more(SlicesAsked::What what, Step step) {
  const int slices = head_.geometry.dimensions.z;
  const int count = std::min(at_a_time_, slices - slice_);
  QElapsedTimer clock;
  clock.start();
  SlicesAnswered answered;
  if (!ask({.what = what, .first = slice_, .count = count}, answered)) return false;
  if (what == SlicesAsked::What::voxels && !append_checked(answered, count)) {
    finish(nullptr, words(say("voxels-did-not-arrive")));
    return false;
  }
  hashes_.insert(hashes_.end(), answered.hashes.begin(), answered.hashes.end());
  slice_ += count;
  const unsigned run = run_;
  progress_(what == SlicesAsked::What::voxels ? tr("Fetching from the server") : tr("Comparing with the server"),
            static_cast<double>(slice_) / slices);
  if (run != run_) return false;  // given up meanwhile
  // A piece is to take about a tenth of a second: the program is to stay alive.
  constexpr double piece_ms = 100, most_bytes = 64e6;
  const double faster = piece_ms / static_cast<double>(std::max<qint64>(clock.elapsed(), 1));
  const double most = std::max(1.0, most_bytes / (static_cast<double>(slice_size(head_)) * sizeof(float)));
  at_a_time_ = static_cast<int>(std::clamp(count * std::min(faster, 2.0), 1.0, most));
  if (slice_ == slices) return true;
  next(step);
  return false;
}

bool ServerScan::append_checked(SlicesAnswered& answered, int count) {
  io::Volume arrived = head_;
  arrived.geometry.dimensions.z = count;
  arrived.voxels = std::move(answered.voxels);
  const std::size_t voxels = std::visit([](const auto& v) { return v.size(); }, arrived.voxels);
  if (voxels != slice_size(head_) * static_cast<std::size_t>(count)) return false;
  if (hashes_of_slices(arrived) != answered.hashes) return false;
  append(voxels_, arrived.voxels, slice_size(head_) * head_.geometry.slice_positions.size());
  return true;
}

void ServerScan::ask_hashes() {
  if (!more(SlicesAsked::What::hashes, &ServerScan::ask_hashes)) return;
  const std::string hash = hash_of(head_, hashes_);
  if (const auto held = fetched_.find(hash); held != fetched_.end()) {
    finish(held->second, words(say("fetched-from-the-server-before")));
    return;
  }
  compare_copies();
}

void ServerScan::compare_copies() {
  const std::string hash = hash_of(head_, hashes_);
  start();
  if (copies_.empty()) {
    next(&ServerScan::fetch);
    return;
  }
  loader_.load_copy(
      copies_, frame_, hash, [this](double done) { progress_(tr("Comparing the copy on this machine"), done); },
      [this](const auto& volume, const std::string&) {
        if (volume) {
          finish(volume, words(say("felt-from-the-copy-on-this-machine")));
          return;
        }
        differs_ = true;
        next(&ServerScan::fetch);
      });
}

void ServerScan::fetch() {
  try {
    if (!more(SlicesAsked::What::voxels, &ServerScan::fetch)) return;
    io::Volume whole = head_;
    whole.voxels = std::move(voxels_);
    const auto volume = std::make_shared<const io::Volume>(std::move(whole));
    fetched_[hash_of(head_, hashes_)] = volume;
    finish(volume, differs_ ? words(say("copy-on-this-machine-is-not")) : words(say("fetched-from-the-server")));
  } catch (const std::bad_alloc&) {
    finish(nullptr, words(say("this-machine-has-not-enough-memory")));
  }
}

}  // namespace palpate::plugin

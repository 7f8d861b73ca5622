#include "plugin/paraview/client/model/scan_model.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "plugin/messages/messages.h"
#include "plugin/paraview/client/words.h"

namespace palpate::plugin {
namespace {

QString text(const std::string& utf8) {
  return QString::fromStdString(utf8);
}

}  // namespace

const ScanHandle* ScanModel::shown() const {
  const auto* const shown = std::get_if<in_views::Shown>(&in_views_);
  return shown ? &shown->scan : nullptr;
}

const FoundList* ScanModel::found() const {
  if (const auto* const choosing = std::get_if<coming::Choosing>(&coming_)) return &choosing->found;
  if (const auto* const loading = std::get_if<coming::Loading>(&coming_)) return &loading->found;
  return nullptr;
}

std::string ScanModel::path() const {
  if (const auto* const finding = std::get_if<coming::Finding>(&coming_)) return finding->path;
  return found() ? found()->path : std::string();
}

const SeriesRef* ScanModel::seen() const {
  if (const auto* const showing = std::get_if<in_views::Showing>(&in_views_)) return &showing->of;
  if (const auto* const fetching = std::get_if<in_views::Fetching>(&in_views_)) return &fetching->of;
  if (const auto* const far = std::get_if<in_views::OutOfReach>(&in_views_)) return &far->of;
  return shown() ? &shown()->of : nullptr;
}

std::optional<SeriesRef> ScanModel::on_its_way() const {
  if (const auto* const loading = std::get_if<coming::Loading>(&coming_)) return loading->found.at(loading->series);
  if (shown() || std::holds_alternative<in_views::OutOfReach>(in_views_) || !seen()) return std::nullopt;
  return *seen();
}

int ScanModel::wanted_frame() const {
  const auto* const shown = std::get_if<in_views::Shown>(&in_views_);
  if (!shown) return 0;
  return shown->coming ? shown->coming->frame : world_.frame_in_views(shown->scan.frames);
}

void ScanModel::tell(const QString& text, bool problem) {
  message_ = {text, problem};
  emit told(text, problem);
}

void ScanModel::set_coming(coming::State next) {
  const FoundList before = found() ? *found() : FoundList{};
  coming_ = std::move(next);
  const FoundList now = found() ? *found() : FoundList{};
  const bool same = before.path == now.path && before.catalogue == now.catalogue &&
                    before.on_server.size() == now.on_server.size() && (now.catalogue || now.on_server.empty());
  if (!same) emit listed();
  emit changed();
}

void ScanModel::set_in_views(in_views::State next) {
  in_views_ = std::move(next);
  emit changed();
}

// From a folder to a series.

void ScanModel::open(const std::string& path) {
  world_.stop();
  give_up_fetching(words(say("cancelled")));
  tell({});
  set_coming(coming::Finding{path});
  // Looking and reading block on a server: nothing is to be held meanwhile.
  if (world_.is_remote()) {
    if (shown()) set_in_views(in_views::OutOfReach{*seen(), words(say("scan-is-on-the-server"))});
    emit out_of_reach({});
  }
  const unsigned run = ++find_;
  world_.find(
      path,
      [this, run](const QString&, double done) {
        auto* const finding = std::get_if<coming::Finding>(&coming_);
        if (run != find_ || !finding) return;
        finding->done = done;
        emit changed();
      },
      [this, run](const FoundList& found, const std::string& error) {
        if (run == find_) list(found, error);
      });
}

void ScanModel::list(const FoundList& found, const std::string& error) {
  if (!error.empty()) {
    set_coming(coming::Nothing{});
    tell(text(error), true);
    return;
  }
  if (found.catalogue && seen() && is_of_other_patient(found)) close();
  set_coming(coming::Choosing{found});
  if (found.catalogue && found.catalogue->series.empty()) {
    tell(words(say("no-image-series-in-this-folder", found.catalogue->skipped.size())), true);
  } else if (const auto only = found.only()) {
    choose(*only);
  } else {
    tell(words(say("series-choose-one", found.count())));
  }
}

/// A patient is not left on the screen beside another's name.
bool ScanModel::is_of_other_patient(const FoundList& found) const {
  const io::Series* const before = seen()->details();
  return !before || !std::ranges::all_of(found.catalogue->series, [&](const io::Series& other) {
    return before->identity.patient_name == other.identity.patient_name &&
           before->identity.patient_id == other.identity.patient_id;
  });
}

void ScanModel::choose(std::size_t series) {
  if (!found() || series >= found()->count()) return;
  const FoundList list = *found();
  const SeriesRef of = list.at(series);
  const unsigned run = ++find_;
  if (!of.details()) {
    give_up_fetching(words(say("cancelled")));
    begin_showing(of, nullptr);
    return;
  }
  tell({});
  set_coming(coming::Loading{list, series});
  world_.load(
      *of.details(), 0,
      [this, run](const QString&, double done) {
        auto* const loading = std::get_if<coming::Loading>(&coming_);
        if (run != find_ || !loading) return;
        loading->done = done;
        emit changed();
      },
      [this, run, list, of](const auto& volume, const std::string& error) {
        if (run != find_) return;
        set_coming(coming::Choosing{list});
        if (volume) begin_showing(of, volume);
        if (!error.empty()) tell(text(error), true);
      });
}

void ScanModel::cancel() {
  ++find_;
  world_.stop();
  set_coming(found() ? coming::State(coming::Choosing{*found()}) : coming::Nothing{});
  const auto* const fetching = std::get_if<in_views::Fetching>(&in_views_);
  const bool far = fetching && fetching->from_server;
  give_up_fetching(far ? words(say("scan-is-on-the-server")) : words(say("cancelled")));
  tell(words(say("cancelled")));
  if (far) emit out_of_reach(words(say("scan-is-on-the-server")));
}

// From a series to the views.

void ScanModel::leave() {
  emit leaving();
  ++fetch_;
  world_.stop_fetching();
  ++frame_;
  world_.stop_frames();
}

void ScanModel::close() {
  leave();
  ++views_;
  set_in_views(in_views::Nothing{});
  emit out_of_reach({});
  world_.close();
}

void ScanModel::begin_showing(const SeriesRef& of, const std::shared_ptr<const io::Volume>& volume) {
  leave();
  set_in_views(in_views::Showing{of, volume});
  if (!volume) emit out_of_reach({});
  world_.show(of, 0, [this, run = ++views_](const std::string& error) {
    if (run == views_) views_made(error);
  });
}

void ScanModel::views_made(const std::string& error) {
  const auto* const showing = std::get_if<in_views::Showing>(&in_views_);
  if (!showing) return;
  const auto [of, volume, frame] = *showing;
  const bool there = world_.facts().in_pipeline;
  if (!error.empty() || !there) {
    const QString why = error.empty() ? words(say("scan-left-the-pipeline")) : text(error);
    set_in_views(in_views::Lost{of, why});
    world_.close();  // no reader is left over that nobody shows
    tell(why, true);
    return;
  }
  note(of, volume.get());
  if (volume) {
    take(handle_of(of, volume, frame, 1), Brought::by_opening);
  } else {
    fetch(of, true, Brought::by_opening);
  }
}

/// Unless another folder is open, and has its own to tell.
void ScanModel::note(const SeriesRef& of, const io::Volume* volume) {
  if (path().empty() || path() == of.path) tell(world_.notes(of, volume));
}

void ScanModel::take(const ScanHandle& scan, Brought brought) {
  set_in_views(in_views::Shown{.scan = scan, .brought = brought});
  emit scan_shown(scan, brought);
}

// From the views to the voxels, where those come last.

void ScanModel::fetch(const SeriesRef& of, bool from_server, Brought brought) {
  set_in_views(in_views::Fetching{.of = of, .from_server = from_server, .brought = brought});
  std::vector<std::string> places{of.path};
  places.insert(places.end(), copies_.begin(), copies_.end());
  const unsigned run = ++fetch_;
  world_.fetch(
      of, std::nullopt, filter_ ? filter_() : io::Filter{}, std::move(places),
      [this, run](const QString& what, double done) {
        auto* const fetching = std::get_if<in_views::Fetching>(&in_views_);
        if (run != fetch_ || !fetching) return;
        fetching->what = what;
        fetching->done = done;
        emit changed();
      },
      [this, run](const ScanWorld::Fetch& answer) {
        if (run == fetch_) take_fetched(answer);
      });
}

void ScanModel::take_fetched(const ScanWorld::Fetch& answer) {
  const auto* const before = std::get_if<in_views::Fetching>(&in_views_);
  if (!before) return;
  const in_views::Fetching fetching = *before;
  QString said = answer.said;
  if (answer.volume && !fetching.from_server) {
    try {
      world_.adopt();
      note(answer.of, answer.volume.get());
    } catch (const std::exception& error) {
      said = QString::fromUtf8(error.what());
      set_in_views(in_views::OutOfReach{fetching.of, said});
      tell(said, true);
      return;
    }
  }
  if (fetching.from_server || !answer.volume) {
    tell(message_.text.isEmpty() ? said : message_.text + QLatin1Char('\n') + said, !answer.volume);
  }
  if (!answer.volume) {
    set_in_views(in_views::OutOfReach{fetching.of, said});
    if (fetching.from_server) emit out_of_reach(said);
    return;
  }
  take(handle_of(answer.of, answer.volume, answer.frame, answer.frames), fetching.brought);
}

/// What is in the views stays there; what is felt stays, too.
void ScanModel::give_up_fetching(const QString& why) {
  ++fetch_;
  world_.stop_fetching();
  if (const auto* const fetching = std::get_if<in_views::Fetching>(&in_views_)) {
    set_in_views(in_views::OutOfReach{fetching->of, why});
  } else if (auto* const shown = std::get_if<in_views::Shown>(&in_views_); shown && !shown->scan.of.catalogue) {
    shown->coming.reset();
    emit changed();
  }
}

void ScanModel::add_copy(const std::string& folder) {
  copies_.push_back(folder);
  const auto* const far = std::get_if<in_views::OutOfReach>(&in_views_);
  const auto* const fetching = std::get_if<in_views::Fetching>(&in_views_);
  if (far || (fetching && fetching->from_server))
    fetch(*seen(), true, fetching ? fetching->brought : Brought::by_opening);
}

void ScanModel::restore(const SeriesRef& of, Brought brought) {
  leave();
  ++find_;
  ++views_;
  world_.stop();
  tell({});
  set_coming(coming::Nothing{});
  const bool remote = world_.is_remote();
  if (remote) {
    emit out_of_reach({});
    try {
      world_.adopt();
    } catch (const std::exception& error) {
      set_in_views(in_views::Lost{of, QString::fromUtf8(error.what())});
      tell(QString::fromUtf8(error.what()), true);
      return;
    }
    note(of, nullptr);
  }
  fetch(of, remote, brought);
}

// What goes.

void ScanModel::lose() {
  if (!seen()) return;
  const SeriesRef of = *seen();
  const bool half = std::holds_alternative<in_views::Showing>(in_views_);
  const QString why = words(say("scan-left-the-pipeline"));
  leave();
  ++views_;
  set_in_views(in_views::Lost{of, why});
  if (!half) return;
  world_.close();
  tell(why, true);
}

void ScanModel::lose_server() {
  leave();
  ++views_;
  if (found() && !found()->catalogue) set_coming(coming::Nothing{});
  set_in_views(in_views::Nothing{});
  world_.abandon();
}

QString ScanModel::why_not_felt() const {
  if (const auto* const far = std::get_if<in_views::OutOfReach>(&in_views_)) return far->why;
  if (const auto* const lost = std::get_if<in_views::Lost>(&in_views_)) return lost->why;
  if (std::holds_alternative<in_views::Nothing>(in_views_)) return words(say("scan-left-the-pipeline"));
  const auto* const shown = std::get_if<in_views::Shown>(&in_views_);
  if (!shown || (shown->coming && !shown->scan.of.catalogue)) return words(say("scan-is-still-being-read"));
  const ViewFacts facts = world_.facts();
  if (!facts.in_pipeline) return words(say("scan-left-the-pipeline"));
  if (!facts.seen) return words(say("no-view-shows-the-scan"));
  if (!facts.other.empty()) return words(say("another-scan-is-active-in-the-pipeline", facts.other, facts.name));
  const ScanHandle& scan = shown->scan;
  if (const int frame = world_.frame_in_views(scan.frames); frame != scan.frame && !shown->coming) {
    return words(
        say("views-show-another-scan", scan.frame_in_words(frame).toStdString(), scan.frame_in_words().toStdString()));
  }
  return {};
}

// The frame.

void ScanModel::go_to_frame(int frame) {
  if (!shown() || shown()->frames <= 1) return;
  const int wanted = std::clamp(frame, 0, shown()->frames - 1);
  shown()->of.catalogue ? load_frame(wanted) : world_.show_frame(wanted);
}

void ScanModel::follow_time() {
  auto* const shown = std::get_if<in_views::Shown>(&in_views_);
  if (!shown || shown->scan.frames <= 1) return;
  const int frame = world_.frame_in_views(shown->scan.frames);
  const bool comes = shown->coming && shown->coming->frame == frame;
  if (comes && shown->coming->volume) {
    take_frame(shown->coming->volume, frame);
  } else if (!comes && frame != shown->scan.frame) {
    shown->scan.of.catalogue ? load_frame(frame) : fetch_frame(frame);
  } else {
    emit changed();
  }
}

/// Here first; then ParaView's time, which all views follow.
void ScanModel::load_frame(int frame) {
  auto& of = std::get<in_views::Shown>(in_views_);
  of.coming = in_views::ComingFrame{.frame = frame};
  emit changed();
  world_.load_frame(*of.scan.of.details(), frame, filter_ ? filter_() : io::Filter{},
                    [this, run = ++frame_, frame](const auto& volume, const std::string& error) {
                      auto* const shown = std::get_if<in_views::Shown>(&in_views_);
                      if (run != frame_ || !shown) return;
                      if (!volume) {
                        shown->coming.reset();
                        emit changed();
                        if (!error.empty()) tell(text(error), true);
                        return;
                      }
                      if (world_.frame_in_views(shown->scan.frames) == frame) {
                        take_frame(volume, frame);
                      } else {
                        shown->coming = in_views::ComingFrame{.frame = frame, .volume = volume};
                        world_.show_frame(frame);
                      }
                    });
}

/// What is felt stays the frame before until the other one is here: why_not_felt() keeps the force off meanwhile.
void ScanModel::fetch_frame(int frame) {
  auto& of = std::get<in_views::Shown>(in_views_);
  of.coming = in_views::ComingFrame{.frame = frame};
  emit changed();
  std::vector<std::string> places{of.scan.of.path};
  places.insert(places.end(), copies_.begin(), copies_.end());
  const unsigned run = ++fetch_;
  world_.fetch(
      of.scan.of, frame, {}, std::move(places),
      [this, run](const QString& what, double done) {
        auto* const shown = std::get_if<in_views::Shown>(&in_views_);
        if (run != fetch_ || !shown || !shown->coming) return;
        shown->coming->what = what;
        shown->coming->done = done;
        emit changed();
      },
      [this, run, frame](const ScanWorld::Fetch& answer) {
        auto* const shown = std::get_if<in_views::Shown>(&in_views_);
        if (run != fetch_ || !shown) return;
        if (answer.volume) return take_frame(answer.volume, frame);
        shown->coming.reset();
        emit changed();
        tell(answer.said, true);
      });
}

void ScanModel::take_frame(const std::shared_ptr<const io::Volume>& volume, int frame) {
  auto& shown = std::get<in_views::Shown>(in_views_);
  shown.scan.volume = volume;
  shown.scan.frame = frame;
  shown.coming.reset();
  emit changed();
  emit frame_shown(shown.scan);
}

}  // namespace palpate::plugin

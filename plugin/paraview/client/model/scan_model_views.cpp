#include "plugin/paraview/client/model/scan_model.h"

#include <exception>
#include <utility>

#include "plugin/messages/messages.h"
#include "plugin/paraview/client/words.h"

namespace palpate::plugin {

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
    const QString why = error.empty() ? words(say("scan-left-the-pipeline")) : QString::fromStdString(error);
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
      emit out_of_reach(said);
      return;
    }
  }
  if (answer.volume && fetching.from_server && !world_.facts().in_pipeline) return lose();  // deleted meanwhile
  if (fetching.from_server || !answer.volume) {
    tell(message_.text.isEmpty() ? said : message_.text + QLatin1Char('\n') + said, !answer.volume);
  }
  if (!answer.volume) {
    set_in_views(in_views::OutOfReach{fetching.of, said});
    emit out_of_reach(said);
    return;
  }
  take(handle_of(answer.of, answer.volume, answer.frame, answer.frames), fetching.brought);
}

/// The views stay as they are.
void ScanModel::give_up_fetching(const QString& why) {
  ++fetch_;
  world_.stop_fetching();
  if (const auto* const fetching = std::get_if<in_views::Fetching>(&in_views_)) {
    set_in_views(in_views::OutOfReach{fetching->of, why});
    emit out_of_reach(why);
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
  ++requests_;
  leave();
  ++find_;
  ++views_;
  world_.stop();
  tell({});
  const bool keeps_list = brought == Brought::by_undo && found();
  set_coming(keeps_list ? coming::State(coming::Choosing{*found()}) : coming::Nothing{});
  const bool remote = world_.is_remote();
  if (remote) {
    emit out_of_reach({});
    try {
      world_.adopt();
    } catch (const std::exception& error) {
      const QString why = QString::fromUtf8(error.what());
      set_in_views(in_views::Lost{of, why});
      tell(why, true);
      emit out_of_reach(why);
      return;
    }
    note(of, nullptr);
  }
  fetch(of, remote, brought);
}

// The removal of scans.

void ScanModel::lose() {
  if (!seen()) return;
  const SeriesRef of = *seen();
  const bool half = std::holds_alternative<in_views::Showing>(in_views_);
  const bool without_voxels = std::holds_alternative<in_views::Fetching>(in_views_);
  const QString why = words(say("scan-left-the-pipeline"));
  leave();
  ++views_;
  set_in_views(in_views::Lost{of, why});
  if (half) world_.close();
  if (without_voxels) emit out_of_reach(why);
  half ? tell(why, true) : tell({});  // what was said of it goes with it
}

void ScanModel::lose_server() {
  leave();
  ++views_;
  if (found() && !found()->catalogue) set_coming(coming::Nothing{});
  set_in_views(in_views::Nothing{});
  world_.abandon();
}

}  // namespace palpate::plugin

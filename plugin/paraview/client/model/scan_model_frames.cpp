#include "plugin/paraview/client/model/scan_model.h"

#include <algorithm>
#include <utility>

#include "plugin/messages/messages.h"
#include "plugin/paraview/client/words.h"

// Whether the felt scan is the visible one, and the frame of both.

namespace palpate::plugin {

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
  const bool is_followed = shown->coming && shown->coming->volume;  // loaded: it is felt as soon as the views show it
  if (const int frame = world_.frame_in_views(scan.frames); frame != scan.frame && !is_followed) {
    return words(
        say("views-show-another-scan", scan.frame_in_words(frame).toStdString(), scan.frame_in_words().toStdString()));
  }
  return {};
}

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
                        if (!error.empty()) tell(QString::fromStdString(error), true);
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

/// The previous frame stays felt until the new one is loaded: why_not_felt() keeps the force off meanwhile.
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

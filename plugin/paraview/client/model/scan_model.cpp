#include "plugin/paraview/client/model/scan_model.h"

#include <algorithm>
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
  const auto list = [this] {
    return found() ? std::pair(found()->path, found()->catalogue)
                   : std::pair(std::string(), std::shared_ptr<const io::Catalogue>());
  };
  const auto before = list();
  coming_ = std::move(next);
  const bool same = list() == before;
  if (!same) emit listed();
  emit changed();
}

void ScanModel::set_in_views(in_views::State next) {
  in_views_ = std::move(next);
  emit changed();
}

// From a folder to a series.

void ScanModel::open(const std::string& path) {
  ++requests_;
  if (!may_leave()) {
    emit not_coming();
    return;
  }
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
    emit not_coming();
    return;
  }
  if (found.catalogue && seen() && is_of_other_patient(found)) {
    const unsigned run = find_;
    const bool may = may_leave();
    if (run != find_) return;  // events were handled while it was asked
    if (!may) {
      set_coming(coming::Nothing{});
      emit not_coming();
      return;
    }
    close();
  }
  set_coming(coming::Choosing{found});
  if (found.catalogue && found.catalogue->series.empty()) {
    tell(words(say("no-image-series-in-this-folder", found.catalogue->skipped.size())), true);
    emit not_coming();
  } else if (const auto only = found.only()) {
    bring(*only);
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
  ++requests_;
  const unsigned run = find_;
  if (found() && series < found()->count() && may_leave() && run == find_) bring(series);
}

void ScanModel::bring(std::size_t series) {
  const FoundList list = *found();
  const SeriesRef of = list.at(series);
  const unsigned run = ++find_;
  give_up_fetching(words(say("cancelled")));  // one worker reads for both
  if (!of.details()) {
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
        if (volume) {
          const bool may = may_leave();
          if (run != find_) return;
          if (may) return begin_showing(of, volume);
        }
        if (!error.empty()) tell(text(error), true);
        emit not_coming();
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
  emit not_coming();
}

}  // namespace palpate::plugin

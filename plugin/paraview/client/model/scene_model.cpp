#include "plugin/paraview/client/model/scene_model.h"

#include <exception>
#include <utility>

#include "modes/scene/scene_json.h"
#include "plugin/paraview/client/model/shown_mode.h"

namespace palpate::plugin {
namespace {

constexpr const char* scene_key = "Scene";
constexpr std::size_t most_edits = 20;  // that are remembered

/// From a scene's JSON, or its name or file. Throws if it is not a scene.
modes::Scene scene_of(const std::string& text) {
  return text.front() == '{' ? modes::scene_from_json(text, "scene") : modes::load_scene(text);
}

}  // namespace

SceneModel::SceneModel(KeptText& kept, QObject* parent) : QObject(parent), kept_(kept) {
  connect(&kept, &KeptText::opened, this, [this] { follow_text(); });
  connect(&kept, &KeptText::changed, this, [this] { follow_text(); });
}

void SceneModel::open(const modes::Scene& scene) {
  if (kept_.is_open()) {
    propose(scene);
  } else {
    kept_.open(modes::to_json(scene));
    opened_ = scene_;
  }
  edited_ = false;
}

void SceneModel::reopen() {
  kept_.open(modes::to_json(latest()));
  forget_steps();
}

void SceneModel::forget_steps() {
  edits_.clear();
  kept_.forget_steps();
}

std::optional<modes::Scene> SceneModel::kept() const {
  const std::string text = kept_.text(scene_key);
  if (text.empty()) return std::nullopt;
  try {
    return scene_of(text);
  } catch (const std::exception&) {  // it is refused and put back, which is told then
    return std::nullopt;
  }
}

bool SceneModel::propose(const modes::Scene& scene) {
  shown_before_.reset();
  const QString why = take(scene, Pace::stepped);
  if (!why.isEmpty()) {
    emit refused(why);
    return false;
  }
  edited_ = false;
  opened_ = scene_;
  keep({});
  return true;
}

bool SceneModel::is_settled() const {
  const std::string text = kept_.text(scene_key);
  const bool is_held = shown_before_ && shown_before_->is_held;
  return !is_waiting() && !is_held && (text.empty() || text == text_);
}

void SceneModel::follow_text() {
  const std::string text = kept_.text(scene_key);
  if (text != text_ && !text.empty()) make_ready(text);
}

void SceneModel::make_ready(const std::string& text) {
  try {
    const auto ready = [this, text] {
      put({.kind = Step::Kind::text, .what = {}, .change = {}, .told = {}, .text = text});
    };
    if (!make_ready_ || !make_ready_(scene_of(text), ready)) ready();
  } catch (const std::exception& error) {
    refuse_text(QString::fromUtf8(error.what()));
  }
}

void SceneModel::refuse_text(const QString& why) {
  emit refused(why);
  put_back();
}

void SceneModel::put(Step step) {
  if (step.kind != Step::Kind::before) show_now();
  if (!reading_) return run(step);
  if (step.kind == Step::Kind::drag && !waiting_.empty() && waiting_.back().kind == Step::Kind::drag)
    waiting_.pop_back();
  waiting_.push_back(std::move(step));
}

void SceneModel::run(const Step& step) {
  if (step.kind == Step::Kind::text) return run_text(step);
  if (step.kind == Step::Kind::finish) return keep(step.what);
  if (step.kind == Step::Kind::now && !shown_before_) return;
  modes::Scene scene = scene_;
  try {
    step.change(scene);
  } catch (const std::exception& error) {
    return tell(QString::fromUtf8(error.what()), step.told);
  }
  if (waits_for(scene, step)) return;
  if (step.kind == Step::Kind::now) shown_before_.reset();
  const QString why = take(scene, step.kind == Step::Kind::drag ? Pace::dragged : Pace::stepped);
  if (why.isEmpty() && step.kind == Step::Kind::edit) keep(step.what);
  tell(why, step.told);
}

void SceneModel::run_text(const Step& step) {
  if (step.text != kept_.text(scene_key)) return;
  try {
    modes::Scene scene = scene_of(step.text);
    const bool cleaned = clean_ && clean_(scene);
    if (waits_for(scene, step)) return;
    const QString why = take(scene, Pace::stepped);
    if (!why.isEmpty()) return refuse_text(why);
    text_ = step.text;
    if (cleaned) put_back();
  } catch (const std::exception& error) {
    refuse_text(QString::fromUtf8(error.what()));
  }
}

bool SceneModel::waits_for(const modes::Scene& scene, const Step& step) {
  const auto done = [this, run = ++run_](const QString& error) {
    if (run == run_) finish_reading(error);
  };
  if (!read_ || !read_(scene, done)) return false;
  reading_ = step;
  return true;
}

void SceneModel::finish_reading(const QString& error) {
  const Step step = *std::exchange(reading_, std::nullopt);
  if (error.isEmpty()) {
    run(step);
  } else if (step.kind == Step::Kind::text) {
    if (step.text == kept_.text(scene_key)) refuse_text(error);
  } else {
    if (step.kind == Step::Kind::now && shown_before_) shown_before_->ends = false;  // the next change tries again
    tell(error, step.told);
  }
  go_on();
}

void SceneModel::go_on() {
  while (!reading_ && !waiting_.empty()) {
    const Step next = std::move(waiting_.front());
    waiting_.pop_front();
    run(next);
  }
}

void SceneModel::drop_waiting() {
  std::erase_if(waiting_, [](const Step& step) { return step.kind != Step::Kind::text; });
  if (reading_ && reading_->kind != Step::Kind::text) {
    ++run_;
    reading_.reset();
  }
  if (shown_before_) take(std::exchange(shown_before_, std::nullopt)->now, Pace::stepped);
  go_on();
}

void SceneModel::put_back() {
  if (!kept_.is_open()) return;
  text_ = modes::to_json(latest());
  kept_.put(scene_key, text_);
}

QString SceneModel::take(const modes::Scene& scene, Pace pace) {
  try {
    commit_ ? commit_(scene, pace) : modes::validate(scene);
  } catch (const std::exception& error) {
    return QString::fromUtf8(error.what());
  }
  mode_ids_.follow(scene_, scene);
  scene_ = scene;
  edited_ = true;
  emit changed(pace);
  return {};
}

void SceneModel::tell(const QString& why, const Told& told) {
  if (told) {
    told(why);
  } else if (!why.isEmpty()) {
    emit refused(why);
  }
}

void SceneModel::keep(const QString& what) {
  std::string text = modes::to_json(scene_);
  if (!kept_.is_open() || text == text_) return;
  if (!what.isEmpty() && text_.starts_with('{')) edits_.push_back({.before = text_, .after = text});
  if (edits_.size() > most_edits) edits_.pop_front();
  text_ = std::move(text);
  kept_.keep(scene_key, text_, what);
}

void SceneModel::edit(const QString& what, const Change& change, const Told& told) {
  put({.kind = Step::Kind::edit, .what = what, .change = change, .told = told, .text = {}});
}

void SceneModel::edit_mode(const QString& what, std::size_t mode, std::function<void(modes::Mode&)> change,
                           const Told& told) {
  const auto of_scene = [shown = ShownMode(*this, mode), change = std::move(change)](modes::Scene& scene) {
    change(scene.modes[shown.in(scene)]);
  };
  edit(what, of_scene, told);
}

void SceneModel::drag(const Change& change, const Told& told) {
  put({.kind = Step::Kind::drag, .what = {}, .change = change, .told = told, .text = {}});
}

void SceneModel::pass(const Change& change, const Told& told) {
  put({.kind = Step::Kind::pass, .what = {}, .change = change, .told = told, .text = {}});
}

void SceneModel::finish_drag(const QString& what) {
  put({.kind = Step::Kind::finish, .what = what, .change = {}, .told = {}, .text = {}});
}

std::optional<modes::Scene> SceneModel::before_last_edit() const {
  const std::string now = modes::to_json(scene_);
  std::string text = text_;
  for (auto edit = edits_.rbegin(); edit != edits_.rend(); ++edit) {  // what was undone leads to no present text
    if (edit->after != text) continue;
    modes::Scene scene = scene_of(edit->before);
    if (clean_) clean_(scene);
    scene.filter = scene_.filter;
    scene.workspace = scene_.workspace;
    if (modes::to_json(scene) != now) return scene;
    text = edit->before;
  }
  return std::nullopt;
}

void SceneModel::show_before() {
  if (shown_before_ || is_waiting()) return;
  const auto before = before_last_edit();
  if (!before) return;
  shown_before_ = {.now = scene_};
  const auto change = [before = *before](modes::Scene& scene) { scene = before; };
  put({.kind = Step::Kind::before, .what = {}, .change = change, .told = {}, .text = {}});
}

void SceneModel::show_now() {
  if (!shown_before_) return;
  shown_before_->is_held = false;
  if (std::exchange(shown_before_->ends, true)) return;
  const auto change = [now = shown_before_->now](modes::Scene& scene) { scene = now; };
  put({.kind = Step::Kind::now, .what = {}, .change = change, .told = {}, .text = {}});
}

}  // namespace palpate::plugin

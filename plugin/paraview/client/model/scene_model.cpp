#include "plugin/paraview/client/model/scene_model.h"

#include <exception>

#include "modes/scene/scene_json.h"

namespace palpate::plugin {
namespace {

constexpr const char* scene_key = "Scene";

/// Of a scene's JSON, or of its name or file. Throws where it is none.
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

void SceneModel::follow_text() {
  const std::string text = kept_.text(scene_key);
  if (text != text_ && !text.empty()) take_text(text, true);
}

void SceneModel::take_text(const std::string& text, bool when_ready) {
  QString why;
  try {
    modes::Scene scene = scene_of(text);
    const bool cleaned = clean_ && clean_(scene);
    const auto ready = [this, text] {
      if (text == kept_.text(scene_key)) take_text(text, false);
    };
    if (when_ready && make_ready_ && make_ready_(scene, ready)) return;
    why = take(scene, Pace::stepped);
    if (why.isEmpty()) {
      text_ = text;
      if (cleaned) put_back();
      return;
    }
  } catch (const std::exception& error) {
    why = QString::fromUtf8(error.what());
  }
  emit refused(why);
  put_back();
}

void SceneModel::put_back() {
  if (!kept_.is_open()) return;
  text_ = modes::to_json(scene_);
  kept_.put(scene_key, text_);
}

QString SceneModel::take(const modes::Scene& scene, Pace pace) {
  try {
    commit_ ? commit_(scene, pace) : modes::validate(scene);
  } catch (const std::exception& error) {
    return QString::fromUtf8(error.what());
  }
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
  text_ = std::move(text);
  kept_.keep(scene_key, text_, what);
}

void SceneModel::edit(const QString& what, const Change& change, const Told& told) {
  modes::Scene scene = scene_;
  change(scene);
  const QString why = take(scene, Pace::stepped);
  if (why.isEmpty()) keep(what);
  tell(why, told);
}

void SceneModel::drag(const Change& change, const Told& told) {
  modes::Scene scene = scene_;
  change(scene);
  tell(take(scene, Pace::dragged), told);
}

void SceneModel::pass(const Change& change, const Told& told) {
  modes::Scene scene = scene_;
  change(scene);
  tell(take(scene, Pace::stepped), told);
}

void SceneModel::finish_drag(const QString& what) {
  keep(what);
}

}  // namespace palpate::plugin

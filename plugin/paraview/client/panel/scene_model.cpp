#include "plugin/paraview/client/panel/scene_model.h"

#include <pqActiveObjects.h>
#include <pqApplicationCore.h>
#include <pqCoreUtilities.h>
#include <pqObjectBuilder.h>
#include <pqPipelineSource.h>
#include <pqServer.h>
#include <pqUndoStack.h>
#include <vtkCommand.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>
#include <vtkSMTrace.h>

#include <exception>
#include <utility>

#include "modes/scene/scene_json.h"
#include "plugin/paraview/client/panel/kept_property.h"

namespace palpate::plugin {
pqPipelineSource* SceneModel::source() const {
  return source_;
}

void SceneModel::open(pqServer& server, const modes::Scene& scene) {
  if (!source_) {
    pqActiveObjects& active = pqActiveObjects::instance();
    pqPipelineSource* const scan = active.activeSource();
    SCOPED_UNDO_EXCLUDE();
    pqObjectBuilder& builder = *pqApplicationCore::instance()->getObjectBuilder();
    pqPipelineSource* const made =
        builder.createSource(QStringLiteral("sources"), QStringLiteral("PalpateScene"), &server);
    {
      SM_SCOPED_TRACE(PropertiesModified).arg("proxy", made->getProxy());
      vtkSMPropertyHelper(made->getProxy(), "Scene").Set(modes::to_json(scene).c_str());
      made->getProxy()->UpdateVTKObjects();
    }
    made->setModifiedState(pqProxy::UNMODIFIED);
    adopt(*made);
    if (scan) active.setActiveSource(scan);  // the scan stays what ParaView's own panels are about
    return;
  }
  propose(scene);
}

bool SceneModel::propose(const modes::Scene& scene) {
  SCOPED_UNDO_EXCLUDE();
  if (!take(scene, Pace::stepped)) return false;
  keep({});
  return true;
}

void SceneModel::adopt(pqPipelineSource& source) {
  if (source_ == &source) return;
  source_ = &source;
  pqCoreUtilities::connect(source.getProxy(), vtkCommand::PropertyModifiedEvent, this, SLOT(follow_source()));
  follow_source();
  emit sourced(source);
}

/// What changed the source need not have been the panel: undo, a trace, the property panel, a state file.
void SceneModel::follow_source() {
  if (keeping_ || !source_) return;
  const std::string text = vtkSMPropertyHelper(source_->getProxy(), "Scene").GetAsString();
  if (text != text_ && !text.empty()) take_text(text, true);
}

void SceneModel::take_text(const std::string& text, bool when_ready) {
  try {
    const modes::Scene scene = text.front() == '{' ? modes::scene_from_json(text, "scene") : modes::load_scene(text);
    const auto ready = [this, text] {
      const bool is_wanted = source_ && text == vtkSMPropertyHelper(source_->getProxy(), "Scene").GetAsString();
      if (is_wanted) take_text(text, false);
    };
    if (when_ready && make_ready_ && make_ready_(scene, ready)) return;
    if (take(scene, Pace::stepped)) {
      text_ = text;
      return;
    }
  } catch (const std::exception& error) {
    emit refused(QString::fromUtf8(error.what()));
  }
  put_back();
}

void SceneModel::put_back() {
  if (!source_) return;
  text_ = modes::to_json(scene_);
  keeping_ = true;
  put_text(*source_, "Scene", text_);
  keeping_ = false;
}

bool SceneModel::take(const modes::Scene& scene, Pace pace) {
  try {
    commit_ ? commit_(scene, pace) : modes::validate(scene);
  } catch (const std::exception& error) {
    emit refused(QString::fromUtf8(error.what()));
    return false;
  }
  scene_ = scene;
  emit changed(pace);
  return true;
}

void SceneModel::keep(const QString& what) {
  std::string text = modes::to_json(scene_);
  if (!source_ || text == text_) return;
  text_ = std::move(text);
  keeping_ = true;
  keep_text(*source_, "Scene", text_, what);
  keeping_ = false;
}

void SceneModel::edit(const QString& what, const Change& change) {
  modes::Scene scene = scene_;
  change(scene);
  if (take(scene, Pace::stepped)) keep(what);
}

void SceneModel::drag(const Change& change) {
  modes::Scene scene = scene_;
  change(scene);
  take(scene, Pace::dragged);
}

void SceneModel::finish_drag(const QString& what) {
  keep(what);
}

bool SceneModel::can_undo() const {
  auto* const stack = pqApplicationCore::instance()->getUndoStack();
  return stack && stack->canUndo();
}

void SceneModel::undo() {
  if (auto* const stack = pqApplicationCore::instance()->getUndoStack(); stack && stack->canUndo()) stack->undo();
}

void SceneModel::redo() {
  if (auto* const stack = pqApplicationCore::instance()->getUndoStack(); stack && stack->canRedo()) stack->redo();
}

void SceneModel::forget_steps() {
  if (auto* const stack = pqApplicationCore::instance()->getUndoStack()) stack->clear();
}

}  // namespace palpate::plugin

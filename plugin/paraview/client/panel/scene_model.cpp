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
#include <vtkSMUndoStack.h>
#include <vtkSMUndoStackBuilder.h>

#include <exception>
#include <utility>

#include "modes/scene/scene_json.h"

namespace palpate::plugin {
namespace {

constexpr int undo_steps = 100;  // ParaView keeps ten: fewer than one turns at a boundary in a minute

}  // namespace

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
}

/// What changed the source need not have been the panel: undo, a trace, the property panel, a state file.
void SceneModel::follow_source() {
  if (keeping_ || !source_) return;
  const std::string text = vtkSMPropertyHelper(source_->getProxy(), "Scene").GetAsString();
  if (text == text_ || text.empty()) return;
  try {
    const modes::Scene scene = text.front() == '{' ? modes::scene_from_json(text, "scene") : modes::load_scene(text);
    if (take(scene, Pace::stepped)) {
      text_ = text;
      return;
    }
  } catch (const std::exception& error) {
    emit refused(QString::fromUtf8(error.what()));
  }
  put_back();
}

/// The pipeline has a scene that was refused: it gets the one that is felt.
void SceneModel::put_back() {
  text_ = modes::to_json(scene_);
  keeping_ = true;
  {
    SCOPED_UNDO_EXCLUDE();
    vtkSMPropertyHelper(source_->getProxy(), "Scene").Set(text_.c_str());
    source_->getProxy()->UpdateVTKObjects();
  }
  source_->setModifiedState(pqProxy::UNMODIFIED);
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
  {
    pqUndoStack* const undo = what.isEmpty() ? nullptr : pqApplicationCore::instance()->getUndoStack();
    if (undo) {
      undo->GetUndoStackBuilder()->GetUndoStack()->SetStackDepth(undo_steps);
      undo->beginUndoSet(what);
    }
    SM_SCOPED_TRACE(PropertiesModified).arg("proxy", source_->getProxy());
    vtkSMPropertyHelper(source_->getProxy(), "Scene").Set(text_.c_str());
    source_->getProxy()->UpdateVTKObjects();
    if (undo) undo->endUndoSet();
  }
  source_->setModifiedState(pqProxy::UNMODIFIED);  // there is nothing left for an Apply button to do
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

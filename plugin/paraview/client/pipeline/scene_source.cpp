#include "plugin/paraview/client/pipeline/scene_source.h"

#include <pqActiveObjects.h>
#include <pqApplicationCore.h>
#include <pqCoreUtilities.h>
#include <pqObjectBuilder.h>
#include <pqServer.h>
#include <pqUndoStack.h>
#include <vtkCommand.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>
#include <vtkSMTrace.h>

#include <utility>

#include "plugin/paraview/client/pipeline/kept_property.h"

namespace palpate::plugin {

void SceneSource::open(const std::string& scene) {
  pqActiveObjects& active = pqActiveObjects::instance();
  pqServer* const server = active.activeServer();
  if (!server) return;
  pqPipelineSource* const scan = active.activeSource();
  SCOPED_UNDO_EXCLUDE();
  pqObjectBuilder& builder = *pqApplicationCore::instance()->getObjectBuilder();
  pqPipelineSource* const made =
      builder.createSource(QStringLiteral("sources"), QStringLiteral("PalpateScene"), server);
  {
    SM_SCOPED_TRACE(PropertiesModified).arg("proxy", made->getProxy());
    vtkSMPropertyHelper(made->getProxy(), "Scene").Set(scene.c_str());
    made->getProxy()->UpdateVTKObjects();
  }
  made->setModifiedState(pqProxy::UNMODIFIED);
  adopt(*made);
  if (scan) active.setActiveSource(scan);  // the scan stays what ParaView's own panels are about
}

void SceneSource::replace(pqPipelineSource* source) {
  const QPointer<pqPipelineSource> before = std::exchange(source_, nullptr);
  if (source) adopt(*source);
  SCOPED_UNDO_EXCLUDE();
  if (before && before != source) pqApplicationCore::instance()->getObjectBuilder()->destroy(before);
}

void SceneSource::adopt(pqPipelineSource& source) {
  source_ = &source;
  pqCoreUtilities::connect(source.getProxy(), vtkCommand::PropertyModifiedEvent, this, SIGNAL(changed()));
  emit opened();
}

std::string SceneSource::text(const char* key) const {
  return source_ ? kept_text_of(*source_, key) : std::string();
}

void SceneSource::keep(const char* key, const std::string& text, const QString& what) {
  if (!source_) return;
  if (what.isEmpty()) {
    SCOPED_UNDO_EXCLUDE();
    keep_text(*source_, key, text, what);
  } else {
    keep_text(*source_, key, text, what);
  }
}

void SceneSource::put(const char* key, const std::string& text) {
  if (source_) put_text(*source_, key, text);
}

bool SceneSource::can_undo() const {
  auto* const stack = pqApplicationCore::instance()->getUndoStack();
  return stack && stack->canUndo();
}

void SceneSource::undo() {
  if (can_undo()) pqApplicationCore::instance()->getUndoStack()->undo();
}

void SceneSource::redo() {
  if (auto* const stack = pqApplicationCore::instance()->getUndoStack(); stack && stack->canRedo()) stack->redo();
}

void SceneSource::forget_steps() {
  if (auto* const stack = pqApplicationCore::instance()->getUndoStack()) stack->clear();
}

}  // namespace palpate::plugin

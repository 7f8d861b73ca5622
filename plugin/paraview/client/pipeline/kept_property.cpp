#include "plugin/paraview/client/pipeline/kept_property.h"

#include <pqApplicationCore.h>
#include <pqPipelineSource.h>
#include <pqUndoStack.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>
#include <vtkSMTrace.h>
#include <vtkSMUndoStack.h>
#include <vtkSMUndoStackBuilder.h>

namespace palpate::plugin {
namespace {

constexpr int undo_steps = 100;  // ParaView keeps ten: fewer than one turns at a boundary in a minute

void set(pqPipelineSource& source, const char* property, const std::string& text) {
  vtkSMPropertyHelper(source.getProxy(), property).Set(text.c_str());
  source.getProxy()->UpdateVTKObjects();
}

}  // namespace

void keep_text(pqPipelineSource& source, const char* property, const std::string& text, const QString& what) {
  {
    pqUndoStack* const undo = what.isEmpty() ? nullptr : pqApplicationCore::instance()->getUndoStack();
    if (undo) {
      undo->GetUndoStackBuilder()->GetUndoStack()->SetStackDepth(undo_steps);
      undo->beginUndoSet(what);
    }
    SM_SCOPED_TRACE(PropertiesModified).arg("proxy", source.getProxy());
    set(source, property, text);
    if (undo) undo->endUndoSet();
  }
  source.setModifiedState(pqProxy::UNMODIFIED);  // there is nothing left for an Apply button to do
}

void put_text(pqPipelineSource& source, const char* property, const std::string& text) {
  {
    SCOPED_UNDO_EXCLUDE();
    set(source, property, text);
  }
  source.setModifiedState(pqProxy::UNMODIFIED);
}

std::string kept_text_of(pqPipelineSource& source, const char* property) {
  const char* const text = vtkSMPropertyHelper(source.getProxy(), property, true).GetAsString();
  return text ? text : "";
}

}  // namespace palpate::plugin

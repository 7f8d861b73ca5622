#include "plugin/paraview/client/pipeline/animation_time.h"

#include <pqAnimationManager.h>
#include <pqAnimationScene.h>
#include <pqPVApplicationCore.h>
#include <pqUndoStack.h>

namespace palpate::plugin {

void set_animation_time(double time) {
  SCOPED_UNDO_EXCLUDE();
  pqAnimationScene* const scene = pqPVApplicationCore::instance()->animationManager()->getActiveScene();
  if (scene && scene->getAnimationTime() != time) scene->setAnimationTime(time);
}

}  // namespace palpate::plugin

#include "plugin/paraview/client/dock/drawn_layers.h"

#include <pqUndoStack.h>

#include <QCoreApplication>

namespace palpate::plugin {

DrawnLayers::DrawnLayers(OpenViews& views, SessionController& session, SceneModel& scene, const MarksModel& shown)
    : flow(views),
      boundaries(views),
      crosshair(views),
      marks(views, [&shown]() -> const Marks& { return shown.marks(); }),
      stylus(views, session, scene),
      session_(session),
      scene_(scene),
      watch_(views, [&session](double seconds) {
        session.note_work(QCoreApplication::translate("DrawnLayers", "drawing"), seconds);
      }) {
  // As soon as others had their turn.
  next_turn_.setSingleShot(true);
  next_turn_.setInterval(0);
  QObject::connect(&next_turn_, &QTimer::timeout, [this] { draw_stylus(); });
}

void DrawnLayers::draw_boundaries(Pace pace) {
  if (session_.expects_scan()) return boundaries.set_felt({}, {}, {}, Pace::stepped);  // they are of the one before
  const LiveSession& live = session_.live();
  boundaries.set_felt(live.felt_scan(), scene_.scene(), live.plan(), pace);
}

void DrawnLayers::forget_scan() {
  flow.set_volume({});
  boundaries.set_felt({}, {}, {}, Pace::stepped);
  memory.give_back_soon();
}

void DrawnLayers::draw_stylus() {
  if (paused_) return;
  SCOPED_UNDO_EXCLUDE();  // what the stylus moves is not what is undone
  if (stylus.show(session_.last())) next_turn_.start();
}

}  // namespace palpate::plugin

#include "plugin/paraview/client/dock/parts.h"

// First the models, then the sections, then the connections, which need all of them.

namespace palpate::plugin {

void PanelParts::build() {
  readers.follow(scans);
  column = new Column({.scans = scans,
                       .readers = readers,
                       .views = open_views,
                       .scene = model,
                       .session = session,
                       .correction = correction,
                       .marks = marks,
                       .sharing = sharing},
                      [this] { return layers.stylus.eye(); });
  dock.setWidget(column);
  strokes = std::make_unique<OutlineStrokes>(open_views, readers.views(), layers.stylus, correction,
                                             *column->structures, *column->profile);
  build_toolbar();
  connect_start();
  connect_scan();
  connect_correction();
  connect_marks();
  connect_scene();
  connect_session();
}

}  // namespace palpate::plugin

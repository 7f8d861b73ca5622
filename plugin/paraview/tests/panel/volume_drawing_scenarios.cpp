// When and how often the volume is drawn, and how fast.

#include <pqApplicationCore.h>
#include <pqCoreUtilities.h>
#include <pqRenderView.h>
#include <pqServerManagerModel.h>
#include <pqView.h>
#include <vtkCamera.h>
#include <vtkCommand.h>
#include <vtkPVRenderView.h>
#include <vtkRenderer.h>
#include <vtkSMRenderViewProxy.h>

#include <QAbstractButton>
#include <QCursor>
#include <QElapsedTimer>
#include <QImage>
#include <QObject>
#include <QPoint>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "plugin/paraview/client/views/caster.h"
#include "plugin/paraview/client/views/event_watch.h"
#include "plugin/paraview/tests/panel/panel_rig.h"
#include "plugin/paraview/tests/panel/panel_steps.h"
#include "plugin/paraview/tests/panel/volume_steps.h"

namespace {

/// How often the scan is drawn in the volume view, from the view's first picture on.
struct Drawings {
  Drawings() {
    QObject::connect(
        pqApplicationCore::instance()->getServerManagerModel(), &pqServerManagerModel::viewAdded, &lifetime,
        [this](pqView* made) {
          auto* const view = qobject_cast<pqRenderView*>(made);
          if (!view) return;
          auto* const drawn =
              vtkPVRenderView::SafeDownCast(view->getRenderViewProxy()->GetClientSideView())->GetRenderer();
          watches.push_back(std::make_unique<palpate::plugin::EventWatch>(
              drawn, vtkCommand::EndEvent, [this, drawn] { count += scan_is_drawn(*drawn) ? 1 : 0; }));
        });
  }
  int count = 0;
  std::vector<std::unique_ptr<palpate::plugin::EventWatch>> watches;
  QObject lifetime;
};

/// Without a graphics card its picture takes seconds: it is drawn once the table is cut away, and not for what only the
/// slices show.
void the_volume_is_drawn_seldom() {
  const Drawings drawings;
  drop_folder(qEnvironmentVariable("PALPATE_DROP"));
  scan_is_shown();
  wait_for("the table is found", [] { return action("palpateCutTable").isEnabled(); });
  views_rest();
  const int first = drawings.count;
  // ParaView may ask for a second picture by itself.
  expect(first == 1 || first == 2, "the scan was drawn once or twice: " + std::to_string(first));
  auto& on = find<QAbstractButton>("palpateOn0");
  on.click();
  views_rest();
  on.click();
  views_rest();
  expect(drawings.count == first, "a tissue that is switched off and on does not draw it anew");
  action("palpateCutTable").trigger();
  wait_for(
      "with the table it is drawn anew", [&] { return drawings.count > first; }, 20);
}

/// Without a graphics card a picture in full takes long: it is cast in turns, and is in the end what it is at once.
void a_picture_at_rest_comes_in_turns() {
  pqCoreUtilities::mainWidget()->setGeometry(0, 0, 800, 500);  // small: it is drawn in full nine times
  feel();
  vtkSMRenderViewProxy& volume = *render_view("Volume").getRenderViewProxy();
  for (const double turned : {0.0, 20.0, 40.0}) {
    views_rest();
    int pictures = 0;
    bool is_turned = false;
    const palpate::plugin::EventWatch drawn(&volume_renderer(), vtkCommand::EndEvent, [&] {
      ++pictures;
      if (!caster_of_the_volume().has_rows_left() || std::exchange(is_turned, true)) return;
      volume.GetActiveCamera()->Azimuth(turned);
    });
    QCursor::setPos(QCursor::pos() + QPoint(6, 0));
    // The coarse one of the move, the same once more while the rows are cast, and the one in full.
    wait_for("the picture comes in turns", [&] { return pictures > 2 && is_turned; });
    views_rest();
    const QImage in_turns = view("Volume").grab().toImage();
    volume.StillRender();
    save_screen("in-turns");
    expect(view("Volume").grab().toImage() == in_turns,
           "the one that came in turns is the one that is drawn at once, of the camera as it is then");
  }
}

/// Not a test but a measurement: how fast the volume turns, and how long it takes to be drawn in full.
void the_volume_turns() {
  drop_folder(qEnvironmentVariable("PALPATE_DROP"));
  scan_is_shown();
  wait_for("the scan is drawn", [] { return scan_is_drawn(volume_renderer()); });
  // Without a graphics card a coarse picture comes first.
  for (int n = 0; n < 5; ++n) views_rest();
  vtkSMRenderViewProxy& view = *render_view("Volume").getRenderViewProxy();
  QElapsedTimer clock;
  const auto turn_and_draw = [&](bool still) {
    view.GetActiveCamera()->Azimuth(3);
    clock.start();
    still ? view.StillRender() : view.InteractiveRender();
    return 1e-6 * static_cast<double>(clock.nsecsElapsed());
  };
  std::vector<double> moving, resting;
  for (int n = 0; n < 40; ++n) moving.push_back(turn_and_draw(false));
  for (int n = 0; n < 5; ++n) resting.push_back(turn_and_draw(true));
  std::ranges::sort(moving);
  std::ranges::sort(resting);
  std::printf(
      "the_volume_turns: moving %.0f Hz in the median (the slowest picture %.0f ms); at rest %.0f ms, median of 5\n",
      1000 / moving[moving.size() / 2], moving.back(), resting[resting.size() / 2]);
  save_screen("turned");
}

/// Without HU nobody looks for a body: the volume waits for nothing but the slices.
void a_volume_without_hu_is_drawn() {
  drop_folder(qEnvironmentVariable("PALPATE_DROP"));
  scan_is_shown();
  wait_for(
      "the scan is drawn", [] { return scan_is_drawn(volume_renderer()); }, 20);
  expect(!action("palpateCutTable").isEnabled(), "no table is cut away");
}

}  // namespace

const Scenarios& volume_drawing_scenarios() {
  static const Scenarios scenarios{{"a_picture_at_rest_comes_in_turns", a_picture_at_rest_comes_in_turns},
                                   {"the_volume_is_drawn_seldom", the_volume_is_drawn_seldom},
                                   {"the_volume_turns", the_volume_turns},
                                   {"a_volume_without_hu_is_drawn", a_volume_without_hu_is_drawn}};
  return scenarios;
}

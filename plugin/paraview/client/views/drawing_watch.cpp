#include "plugin/paraview/client/views/drawing_watch.h"

#include <pqRenderView.h>
#include <vtkCommand.h>
#include <vtkRenderWindow.h>
#include <vtkSMRenderViewProxy.h>

#include <QElapsedTimer>

#include <utility>

#include "plugin/paraview/client/views/event_watch.h"

namespace palpate::plugin {

struct DrawingWatch::One {
  One(pqRenderView& view, const std::function<void(double)>& drawn)
      : begin(view.getRenderViewProxy()->GetRenderWindow(), vtkCommand::StartEvent, [this] { clock.start(); }),
        end(view.getRenderViewProxy()->GetRenderWindow(), vtkCommand::EndEvent, [this, &drawn] {
          if (!clock.isValid()) return;
          const double seconds = 1e-9 * static_cast<double>(clock.nsecsElapsed());
          clock.invalidate();
          drawn(seconds);
        }) {}
  QElapsedTimer clock;
  EventWatch begin, end;
};

DrawingWatch::DrawingWatch(OpenViews& views, std::function<void(double seconds)> drawn)
    : drawn_(std::move(drawn)), following_(views.follow(Layer::image, [this](const auto& open) { set_views(open); })) {}
DrawingWatch::~DrawingWatch() = default;

void DrawingWatch::set_views(const std::vector<ClinicalView>& views) {
  views_.clear();
  for (const ClinicalView& view : views) {
    if (view.view) views_.push_back(std::make_unique<One>(*view.view, drawn_));
  }
}

}  // namespace palpate::plugin

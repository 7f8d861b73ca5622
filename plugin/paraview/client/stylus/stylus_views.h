#pragma once

/// The stylus in all views of a scan: drawn as it moves, and moved by the mouse.

#include <QElapsedTimer>
#include <QPointer>

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "plugin/paraview/client/model/open_views.h"
#include "plugin/paraview/client/model/session_controller.h"
#include "plugin/paraview/client/stylus/stylus_glyphs.h"
#include "plugin/paraview/client/stylus/stylus_hand.h"
#include "plugin/paraview/client/views/clinical_views.h"
#include "plugin/paraview/client/views/sight_line.h"

namespace palpate::plugin {

struct Eye;

class StylusViews {
 public:
  StylusViews(OpenViews& views, SessionController& session, const SceneModel& model);
  StylusViews(const StylusViews&) = delete;
  StylusViews& operator=(const StylusViews&) = delete;
  ~StylusViews();

  /// The opacity of the volume rendering, used to find where it hides the stylus.
  void set_opacity(std::vector<OpacityNode> opacity) { opacity_ = std::move(opacity); }
  /// Redraws the views in which something has moved, at a limited rate so that the program stays responsive. True while
  /// a full-quality picture is unfinished: the next call continues it.
  bool show(const SessionStatus& look);
  /// `pick` gets the left button in the 3D view, with the visible place under the pointer; empty: the button rotates
  /// the view again.
  void set_pick(std::function<void(Pick, const glm::dvec3&)> pick) { pick_ = std::move(pick); }
  /// Gets the left button before `pick`, with the two ends (mm) of the line under the pointer; returns whether it takes
  /// the button. Empty: not used.
  using Rays = std::function<bool(Pick, const glm::dvec3& near, const glm::dvec3& far)>;
  void set_rays(Rays rays) { rays_ = std::move(rays); }
  /// The viewpoint of the 3D view.
  Eye eye() const;
  /// Whether a place of the patient is clearly visible in every view: not at an edge, under a text or behind something.
  bool shows(const glm::dvec3& place);

 private:
  struct OneView;
  void set_views(const std::vector<ClinicalView>& views);
  void follow_scan();
  bool pick(Pick what, const glm::dvec3& near, const glm::dvec3& far);

  SessionController& session_;
  const SceneModel& model_;
  std::vector<std::unique_ptr<OneView>> views_;
  std::vector<OpacityNode> opacity_;
  std::function<void(Pick, const glm::dvec3&)> pick_;
  Rays rays_;
  glm::dvec3 picked_mm_{0};
  std::shared_ptr<const io::FieldSource> values_;  // of the scan
  std::shared_ptr<const io::Volume> values_of_;
  QElapsedTimer clock_;
  std::size_t next_ = 0;
  OpenViews::Following following_;
};

}  // namespace palpate::plugin

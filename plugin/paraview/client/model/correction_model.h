#pragma once

/// The correction that is running: of which structure, with which tool, and the stroke that is being drawn. The edits
/// themselves are the scene's, which keeps them in state files, recordings and ParaView's steps.

#include <QObject>
#include <QString>
#include <QTimer>

#include <deque>
#include <functional>
#include <optional>
#include <vector>

#include "io/structures/doubtful_places.h"
#include "io/structures/structure.h"
#include "plugin/paraview/client/model/doubtful_list.h"
#include "plugin/paraview/client/model/scene_model.h"
#include "plugin/structures/drawn_structure.h"
#include "plugin/structures/edges_beside.h"
#include "plugin/structures/study_structures.h"

namespace palpate::plugin {

class CorrectionModel : public QObject {
  Q_OBJECT

 public:
  enum class Tool { trace, add, remove };
  /// Does one step of the scene, perhaps after what it needs was read.
  using Press = std::function<void(const QString& what, SceneModel::Change change)>;
  /// Looks for the doubtful places of a structure's outline, and calls `done` on the thread that asked. Called with
  /// null: what is being looked for is not wanted any more.
  using Find = std::function<void(const io::Structure* structure, std::function<void(io::DoubtfulPlaces)> done)>;

  /// Looks for the scan's own edge beside places of a stroke, and calls `done` on the thread that asked, always: with
  /// none at a place where there is none, and with an empty list where it could not be looked for. Called with no
  /// place: what is looked for is not wanted any more.
  using Edges = std::vector<std::optional<EdgeBeside>>;
  using LookBeside =
      std::function<void(std::vector<io::Vec3> places, double within_mm, std::function<void(const Edges&)> done)>;

  explicit CorrectionModel(SceneModel& scene, QObject* parent = nullptr);
  ~CorrectionModel() override;
  void set_press(Press press) { press_ = std::move(press); }
  void set_find(Find find) { find_ = std::move(find); }
  void set_look_beside(LookBeside look) { look_beside_ = std::move(look); }
  void set_outline(DoubtfulList::Outline outline) { doubtful_.set_outline(std::move(outline)); }
  /// The outline that is felt is another one now.
  void outline_changed() { emit places_changed(); }
  /// The scan is another frame now: doubtful places are looked for there.
  void look_again();

  /// `edges`: the scan's own at its outline. From then on they are felt there.
  void begin(const io::Structure& structure, const OutlineEdges& edges);
  /// The scan's edges at its outline are known now, or are others.
  void set_edges(const OutlineEdges& edges);
  /// They are not felt any more; the edits stay. Strokes that are being looked at become edits before.
  void end();
  /// Another scan: nothing is corrected, and no step is done. What a correction adds to the scene goes.
  void forget();
  /// Null: nothing is being corrected.
  const io::Structure* structure() const { return structure_ ? &*structure_ : nullptr; }

  Tool tool() const { return tool_; }
  void set_tool(Tool tool);
  double radius_mm() const { return radius_mm_; }  ///< of what is added or removed
  void set_radius_mm(double radius_mm);
  double snap_n() const { return snap_n_; }  ///< how strongly the scan's edge holds the stylus; 0: it is not felt
  void set_snap_n(double newtons);

  /// The slice that the scene holds the stylus in beside the outline; none: it is free.
  const std::optional<HeldPlane>& held_in() const { return held_in_; }
  /// A step of the scene.
  void hold_in(const std::optional<HeldPlane>& plane);
  /// The slice that it is held in is another one now. Several soon after each other are one step.
  void follow_slice(const HeldPlane& plane);
  /// It is free while a key is held.
  bool is_freed() const { return freed_; }
  void set_freed(bool freed);

  /// A stroke of the mouse, mm, patient space: on a slice, or over the outline as the volume view shows it. It becomes
  /// an edit when the button is let go. A trace over the outline moves it to the scan's own edge beside it.
  enum class Over { slice, outline };
  void press(const glm::dvec3& place, Over over = Over::slice);
  void move(const glm::dvec3& place);
  void let_go();
  const std::vector<io::Vec3>& stroke() const { return stroke_.places; }
  Over stroke_over() const { return stroke_.over; }
  /// The same at once: a path of the stylus, or one place. The points of a trace carry the +- of the scan's edge there.
  void draw_felt(std::vector<io::Vec3> places);
  /// The edge moves to the scan's own around a place.
  void take_scan_edge(const io::Vec3& center_mm);

  /// Of the structure, as the scene has them.
  const std::vector<io::Edit>& edits() const { return edits_; }
  bool can_undo() const { return is_edited() || is_tracing(); }
  /// Contours that make the structure are no correction.
  bool is_edited() const { return structure_ && edits_.size() > making_edits(*structure_); }
  /// Whether a stroke is being looked at, and becomes an edit then.
  bool is_tracing() const { return !traces_.empty(); }
  bool can_redo() const { return !taken_back_.empty(); }
  void undo();
  void redo();

  /// The file's outline is shown instead of the corrected one, while a key is held.
  bool shows_before() const { return shows_before_; }
  void show_before(bool before);

  const DoubtfulList& doubtful() const { return doubtful_; }
  /// As DoubtfulList::leave() and go_to().
  void leave(std::size_t place);
  void go_to(std::size_t place);

 signals:
  void changed();
  void stroke_changed();
  void places_changed();
  void place_wanted(const palpate::io::DoubtfulPlace& place);
  /// A stroke has changed nothing: along all of it the scan has no edge.
  void nothing_traced();

 private:
  struct Trace {
    std::vector<io::Vec3> places;
    Over over = Over::slice;
  };

  void reset();
  void follow_scene();
  void draw(std::vector<io::Vec3> places, Over over, bool felt);
  void look_beside_next();
  void finish_trace(const Trace& trace, const Edges& edges);
  void leave();
  void snap(const QString& what);
  SceneModel::Change snapping() const;
  SceneModel::Change holding(const std::optional<HeldPlane>& plane) const;
  void add(const QString& what, const io::Edit& edit);
  void find_places();

  SceneModel& scene_;
  Press press_;
  Find find_;
  LookBeside look_beside_;
  std::optional<io::Structure> structure_;
  OutlineEdges edges_of_scan_;
  Tool tool_ = Tool::trace;
  double radius_mm_ = 3, snap_n_ = 0.8;
  std::optional<HeldPlane> held_in_;  // as the scene had it last, but while it is freed
  bool freed_ = false;
  QTimer slice_kept_;                 // once the slice stays
  Trace stroke_;                      // that is being drawn
  std::deque<Trace> traces_;          // looked at before they become edits: now the first of them
  bool ending_ = false;               // once they are edits
  std::vector<io::Edit> edits_;       // as the scene had them last
  std::vector<io::Edit> taken_back_;  // the last one first to come again
  bool shows_before_ = false;
  bool is_in_scene_ = false;
  DoubtfulList doubtful_;
};

}  // namespace palpate::plugin

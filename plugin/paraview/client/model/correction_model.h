#pragma once

/// The running correction: its structure, the tool, and the current stroke. The edits themselves belong to the scene,
/// which keeps them in state files, recordings and ParaView's undo steps.

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
  /// Makes one step of the scene, after reading the files that it needs.
  using Press = std::function<void(const QString& what, SceneModel::Change change)>;
  /// Searches the doubtful places of a structure's outline, and calls `done` on the thread that asked. Called with null
  /// to cancel a search.
  using Find = std::function<void(const io::Structure* structure, std::function<void(io::DoubtfulPlaces)> done)>;

  /// Searches the scan's own edge beside the places of a stroke, and always calls `done`, on the thread that asked. An
  /// entry is none where there is no edge; the list is empty if the search failed. Called without places to cancel a
  /// search.
  using Edges = std::vector<std::optional<EdgeBeside>>;
  using LookBeside =
      std::function<void(std::vector<io::Vec3> places, double within_mm, std::function<void(const Edges&)> done)>;

  explicit CorrectionModel(SceneModel& scene, QObject* parent = nullptr);
  ~CorrectionModel() override;
  void set_press(Press press) { press_ = std::move(press); }
  void set_find(Find find) { find_ = std::move(find); }
  void set_look_beside(LookBeside look) { look_beside_ = std::move(look); }
  void set_outline(DoubtfulList::Outline outline) { doubtful_.set_outline(std::move(outline)); }
  /// Call this when the felt outline has changed.
  void outline_changed() { emit places_changed(); }
  /// Call this when the scan's frame has changed: searches doubtful places there.
  void look_again();

  /// `edges`: the scan's edges at the outline of `structure`. From now on they are felt.
  void begin(const io::Structure& structure, const OutlineEdges& edges);
  /// The scan's edges at the structure's outline are available, or have changed.
  void set_edges(const OutlineEdges& edges);
  /// Ends the correction: its edges are not felt any more; the edits stay. Strokes that wait for their edges become
  /// edits first.
  void end();
  /// Another scan: ends the correction without a step, and removes what it added to the scene.
  void forget();
  /// The structure that is corrected; null: none.
  const io::Structure* structure() const { return structure_ ? &*structure_ : nullptr; }

  Tool tool() const { return tool_; }
  void set_tool(Tool tool);
  double radius_mm() const { return radius_mm_; }  ///< of the tools add and remove
  void set_radius_mm(double radius_mm);
  double snap_n() const { return snap_n_; }  ///< how strongly the scan's edge holds the stylus; 0: not felt
  void set_snap_n(double newtons);

  /// The slice in which the scene holds the stylus beside the outline; none: the stylus is free.
  const std::optional<HeldPlane>& held_in() const { return held_in_; }
  /// Makes a step of the scene.
  void hold_in(const std::optional<HeldPlane>& plane);
  /// The slice that holds the stylus has changed. Several changes in quick succession are one step.
  void follow_slice(const HeldPlane& plane);
  /// Whether the stylus is free because a key is held.
  bool is_freed() const { return freed_; }
  void set_freed(bool freed);

  /// A stroke of the mouse, mm, patient space: on a slice, or over the outline in the volume view. It becomes an edit
  /// when the button is released. A trace over the outline moves the outline to the scan's own edge.
  enum class Over { slice, outline };
  void press(const glm::dvec3& place, Over over = Over::slice);
  void move(const glm::dvec3& place);
  void let_go();
  const std::vector<io::Vec3>& stroke() const { return stroke_.places; }
  Over stroke_over() const { return stroke_.over; }
  /// A complete stroke: a path of the stylus, or one place. The points of a trace get the uncertainty of the scan's
  /// edge there.
  void draw_felt(std::vector<io::Vec3> places);
  /// Moves the outline to the scan's own edge around a place.
  void take_scan_edge(const io::Vec3& center_mm);

  /// The edits of the structure, as in the scene.
  const std::vector<io::Edit>& edits() const { return edits_; }
  bool can_undo() const { return is_edited() || is_tracing(); }
  /// Contours that define the structure do not count as a correction.
  bool is_edited() const { return structure_ && edits_.size() > making_edits(*structure_); }
  /// Whether a stroke waits for its edges, to become an edit.
  bool is_tracing() const { return !traces_.empty(); }
  bool can_redo() const { return !taken_back_.empty(); }
  void undo();
  void redo();

  /// Whether the file's outline is shown instead of the corrected one (while a key is held).
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
  /// A stroke has changed nothing, because the scan has no edge along it.
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
  std::optional<HeldPlane> held_in_;  // as last in the scene, except while freed
  bool freed_ = false;
  QTimer slice_kept_;                 // fires when the slice has stopped changing
  Trace stroke_;                      // the current one
  std::deque<Trace> traces_;          // waiting for their edges; the first is being searched
  bool ending_ = false;               // after they have become edits
  std::vector<io::Edit> edits_;       // as last in the scene
  std::vector<io::Edit> taken_back_;  // undone edits, the last one is redone first
  bool shows_before_ = false;
  bool is_in_scene_ = false;
  DoubtfulList doubtful_;
};

}  // namespace palpate::plugin

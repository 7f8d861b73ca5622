#include "plugin/paraview/client/model/correction_model.h"

#include <algorithm>
#include <array>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <utility>

#include "io/structures/outline_change.h"

namespace palpate::plugin {
namespace {

constexpr double least_step_mm = 0.3;  // of a stroke: nearer places add nothing
constexpr double scan_edge_radius_mm = 10, scan_edge_most_mm = 6;
constexpr double felt_within_mm = 2;     // of a felt place the scan's edge is looked for
constexpr double outline_within_mm = 6;  // of a place of the outline
constexpr int slice_stays_ms = 400;

/// The scene's edits of a structure; null: it has none of that structure.
std::vector<io::Edit>* edits_in(modes::Scene& scene, const io::Structure& structure) {
  const auto named =
      std::ranges::find_if(scene.structures, [&](const modes::SceneStructure& one) { return is_same(one, structure); });
  return named == scene.structures.end() ? nullptr : &named->edits;
}

bool begins_with(const std::vector<io::Edit>& all, const std::vector<io::Edit>& first) {
  return all.size() >= first.size() && std::equal(first.begin(), first.end(), all.begin());
}

}  // namespace

CorrectionModel::CorrectionModel(SceneModel& scene, QObject* parent)
    : QObject(parent),
      scene_(scene),
      press_([&scene](const QString& what, const SceneModel::Change& change) { scene.edit(what, change); }) {
  connect(&scene, &SceneModel::changed, this, [this](Pace pace) {
    if (pace == Pace::stepped) follow_scene();
  });
  // Undo, or a state file saved during a correction, may bring what a correction adds.
  scene.set_clean([this](modes::Scene& from_pipeline) { return !structure_ && snap_no_more(from_pipeline); });
  slice_kept_.setSingleShot(true);
  slice_kept_.setInterval(slice_stays_ms);
  connect(&slice_kept_, &QTimer::timeout, this, [this] {
    if (structure_ && !freed_) scene_.finish_drag(tr("Hold in the slice"));
  });
}

CorrectionModel::~CorrectionModel() {
  scene_.set_clean({});
}

void CorrectionModel::begin(const io::Structure& structure, const OutlineEdges& edges) {
  if (ending_) leave();
  forget();
  structure_ = structure;
  edges_of_scan_ = edges;
  follow_scene();
  snap(tr("Correct %1").arg(QString::fromStdString(structure.name)));
  emit changed();
}

/// As it is wished and known once it is done: others may be done before. The plane stays the scene's.
SceneModel::Change CorrectionModel::snapping() const {
  return [this, structure = *structure_](modes::Scene& scene) {
    const std::optional<HeldPlane> plane = held_plane(scene, structure);
    snap_to_scan(scene, structure, {.newtons = snap_n_, .edges = edges_of_scan_, .plane = plane});
  };
}

/// The same with that plane.
SceneModel::Change CorrectionModel::holding(const std::optional<HeldPlane>& plane) const {
  return [this, structure = *structure_, plane](modes::Scene& scene) {
    snap_to_scan(scene, structure, {.newtons = snap_n_, .edges = edges_of_scan_, .plane = plane});
  };
}

void CorrectionModel::snap(const QString& what) {
  press_(what, snapping());
}

void CorrectionModel::set_edges(const OutlineEdges& edges) {
  if (!structure_ || edges == edges_of_scan_) return;
  edges_of_scan_ = edges;
  snap({});  // it follows from the scan: no step
}

void CorrectionModel::hold_in(const std::optional<HeldPlane>& plane) {
  if (!structure_) return;
  if (plane != held_in_) {
    freed_ = false;
    press_(plane ? tr("Hold in the slice") : tr("Release from the slice"), holding(plane));
  }
  emit changed();  // also where it comes to nothing: whoever asked shows what is so
}

void CorrectionModel::follow_slice(const HeldPlane& plane) {
  if (!structure_ || !held_in_ || plane == *held_in_ || !is_in_scene_) return;
  if (freed_) {
    held_in_ = plane;
  } else {
    scene_.pass(holding(plane));
  }
  slice_kept_.start();
  emit changed();
}

void CorrectionModel::set_freed(bool freed) {
  if (!structure_ || !held_in_ || !is_in_scene_ || std::exchange(freed_, freed) == freed) return;
  scene_.pass(holding(freed ? std::nullopt : held_in_));
  if (!freed) scene_.finish_drag(tr("Hold in the slice"));  // a step where the slice has changed meanwhile
  emit changed();
}

void CorrectionModel::end() {
  if (!structure_) return;
  ending_ = is_tracing();
  if (!ending_) leave();
}

void CorrectionModel::leave() {
  const io::Structure structure = *structure_;
  reset();
  press_(tr("End correcting"), [structure](modes::Scene& scene) { snap_no_more(scene, structure); });
}

void CorrectionModel::forget() {
  const bool was_running = structure_.has_value();
  reset();
  if (!was_running) return;
  scene_.pass([](modes::Scene& scene) { snap_no_more(scene); });
  scene_.finish_drag({});
}

void CorrectionModel::reset() {
  if (find_) find_(nullptr, {});
  if (look_beside_) look_beside_({}, 0, {});
  structure_.reset();
  held_in_.reset();
  freed_ = false;
  slice_kept_.stop();
  stroke_ = {};
  traces_.clear();
  ending_ = false;
  edits_.clear();
  taken_back_.clear();
  shows_before_ = false;
  is_in_scene_ = false;
  doubtful_.clear();
  emit stroke_changed();
  emit places_changed();
  emit changed();
}

void CorrectionModel::look_again() {
  if (!is_in_scene_) return;
  doubtful_.clear();
  find_places();
  emit places_changed();
  emit changed();
}

void CorrectionModel::find_places() {
  if (!find_ || !structure_) return;
  find_(&*structure_, [this](io::DoubtfulPlaces found) {
    doubtful_.take(std::move(found));
    emit places_changed();
  });
}

/// An edit that was undone here or in ParaView can be redone here.
void CorrectionModel::follow_scene() {
  if (!structure_) return;
  modes::Scene scene = scene_.scene();
  const std::vector<io::Edit>* const found = edits_in(scene, *structure_);
  if (found && !std::exchange(is_in_scene_, true)) find_places();  // it is read now
  if (found && !freed_) {
    const std::optional<HeldPlane> held = held_plane(scene, *structure_);
    if (std::exchange(held_in_, held) != held) emit changed();
  }
  std::vector<io::Edit> now = found ? *found : std::vector<io::Edit>{};
  if (now == edits_) return;
  if (begins_with(edits_, now)) {
    for (std::size_t n = edits_.size(); n > now.size(); --n) taken_back_.push_back(edits_[n - 1]);
  } else if (begins_with(now, edits_) && can_redo() && now.size() == edits_.size() + 1 &&
             now.back() == taken_back_.back()) {
    taken_back_.pop_back();
  } else {
    taken_back_.clear();
  }
  edits_ = std::move(now);
  emit changed();
  emit places_changed();
}

void CorrectionModel::set_tool(Tool tool) {
  if (std::exchange(tool_, tool) != tool) emit changed();
}

void CorrectionModel::set_radius_mm(double radius_mm) {
  radius_mm = std::clamp(radius_mm, io::edit_limits::least_mm, io::edit_limits::most_mm);
  if (std::exchange(radius_mm_, radius_mm) != radius_mm) emit changed();
}

void CorrectionModel::set_snap_n(double newtons) {
  if (std::exchange(snap_n_, newtons) == newtons || !structure_) return;
  snap(tr("Snap to the scan's edge"));
}

void CorrectionModel::press(const glm::dvec3& place, Over over) {
  if (!structure_) return;
  stroke_ = {.places = {place}, .over = over};
  emit stroke_changed();
}

void CorrectionModel::move(const glm::dvec3& place) {
  if (stroke().empty() || glm::distance(stroke().back(), place) < least_step_mm) return;
  stroke_.places.push_back(place);
  emit stroke_changed();
}

/// A click alone, such as one that gives a view the keyboard focus, traces nothing.
void CorrectionModel::let_go() {
  if (stroke().empty()) return;
  Trace drawn{.places = std::exchange(stroke_.places, {}), .over = stroke_.over};
  if (tool_ != Tool::trace || drawn.places.size() > 1) draw(std::move(drawn.places), drawn.over, false);
  emit stroke_changed();
}

void CorrectionModel::draw_felt(std::vector<io::Vec3> places) {
  draw(std::move(places), Over::slice, true);
}

void CorrectionModel::draw(std::vector<io::Vec3> places, Over over, bool felt) {
  if (!structure_ || places.empty()) return;
  switch (tool_) {
    case Tool::trace:
      if ((felt || over == Over::outline) && look_beside_) {
        traces_.push_back({std::move(places), over});
        if (traces_.size() == 1) look_beside_next();
        emit changed();
        return;
      }
      return add(tr("Trace"), io::TraceEdit{.points_mm = std::move(places), .known_to_mm = {}});
    case Tool::add:
      return add(tr("Add"), io::AddEdit{{.path_mm = std::move(places), .radius_mm = radius_mm_}});
    case Tool::remove:
      return add(tr("Remove"), io::RemoveEdit{{.path_mm = std::move(places), .radius_mm = radius_mm_}});
  }
}

void CorrectionModel::look_beside_next() {
  const Trace& trace = traces_.front();
  look_beside_(trace.places, trace.over == Over::outline ? outline_within_mm : felt_within_mm,
               [this](const Edges& edges) {
                 if (traces_.empty()) return;
                 const Trace done = std::move(traces_.front());
                 traces_.pop_front();
                 finish_trace(done, edges);
                 if (is_tracing()) return look_beside_next();
                 ending_ ? leave() : emit changed();
               });
}

/// A felt stroke stays at its place. A stroke drawn over the outline moves to the scan's edge, if there is one.
void CorrectionModel::finish_trace(const Trace& trace, const Edges& edges) {
  if (trace.over == Over::slice) {
    return add(tr("Trace"), io::TraceEdit{.points_mm = trace.places, .known_to_mm = known_to_of(edges)});
  }
  io::TraceEdit edit;
  for (const auto& edge : edges) {
    if (!edge) continue;
    edit.points_mm.push_back(edge->place_mm);
    edit.known_to_mm.push_back(edge->known_to_mm);
  }
  if (!edit.points_mm.empty()) return add(tr("Trace"), edit);
  if (!edges.empty()) emit nothing_traced();
}

void CorrectionModel::take_scan_edge(const io::Vec3& center_mm) {
  add(tr("Take the scan's edge"),
      io::ScanEdgeEdit{.center_mm = center_mm, .radius_mm = scan_edge_radius_mm, .most_mm = scan_edge_most_mm});
}

void CorrectionModel::add(const QString& what, const io::Edit& edit) {
  if (!structure_) return;
  press_(what, [structure = *structure_, edit](modes::Scene& scene) {
    name_in_scene(scene, structure);
    edits_in(scene, structure)->push_back(edit);
  });
}

/// The newest first: a stroke that still waits for its edges is discarded.
void CorrectionModel::undo() {
  if (!structure_ || !can_undo()) return;
  if (is_tracing()) {
    traces_.pop_back();
    if (traces_.empty() && look_beside_) look_beside_({}, 0, {});
    if (ending_ && traces_.empty()) return leave();
    emit changed();
    return;
  }
  press_(tr("Undo a correction"), [structure = *structure_](modes::Scene& scene) {
    std::vector<io::Edit>* const edits = edits_in(scene, structure);
    if (edits && edits->size() > making_edits(structure)) edits->pop_back();
  });
}

/// The next one after the scene's edits at that time: another redo may be done before.
void CorrectionModel::redo() {
  if (!can_redo()) return;
  std::vector<io::Edit> all = edits_;
  all.insert(all.end(), taken_back_.rbegin(), taken_back_.rend());
  press_(tr("Redo a correction"), [structure = *structure_, all = std::move(all)](modes::Scene& scene) {
    name_in_scene(scene, structure);
    std::vector<io::Edit>& now = *edits_in(scene, structure);
    if (now.size() < all.size() && begins_with(all, now)) now.push_back(all[now.size()]);
  });
}

void CorrectionModel::show_before(bool before) {
  if (std::exchange(shows_before_, before) != before) emit changed();
}

void CorrectionModel::leave(std::size_t place) {
  doubtful_.leave(place);
  emit places_changed();
}

void CorrectionModel::go_to(std::size_t place) {
  if (const io::DoubtfulPlace* const one = doubtful_.go_to(place)) emit place_wanted(*one);
}

}  // namespace palpate::plugin

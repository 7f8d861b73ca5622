#include "plugin/paraview/client/model/correction_model.h"

#include <gmock/gmock.h>

#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "modes/scene/scene_json.h"
#include "plugin/paraview/client/model/testing/made_text.h"

namespace palpate::plugin {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using Fate = CorrectionModel::Fate;
using Tool = CorrectionModel::Tool;

struct Correcting : ::testing::Test {
  Correcting() {
    scene.open(modes::Scene{});
    liver.file = "/study/liver.dcm";
    liver.number = 3;
    liver.name = "liver";
    model.set_find([this](const io::Structure* structure, auto done) {
      if (!structure) ++not_wanted;
      if (structure) asked.push_back(std::move(done));
    });
    QObject::connect(&model, &CorrectionModel::place_wanted,
                     [this](const io::DoubtfulPlace& place) { gone_to.push_back(place.position_mm.x); });
  }

  void stroke(std::vector<io::Vec3> places) {
    model.press(places.front());
    for (const io::Vec3& place : places) model.move(place);
    model.let_go();
  }
  std::vector<std::string> kinds() const {
    std::vector<std::string> names;
    for (const io::Edit& edit : model.edits()) names.emplace_back(io::name_of(edit));
    return names;
  }
  /// What the pipeline keeps, read again.
  std::vector<io::Edit> kept_edits() const {
    const modes::Scene read = modes::scene_from_json(kept.text("Scene"), "scene");
    return read.structures.empty() ? std::vector<io::Edit>() : read.structures.front().edits;
  }
  const modes::Mode* snap() const {
    for (const modes::Mode& mode : scene.scene().modes) {
      if (mode.name == "Scan's edge at liver") return &mode;
    }
    return nullptr;
  }
  std::vector<modes::Mode> planes() const {
    std::vector<modes::Mode> found;
    for (const modes::Mode& mode : scene.scene().modes) {
      if (mode.type == "landmark") found.push_back(mode);
    }
    return found;
  }
  void look_beside() {
    model.set_look_beside([this](std::vector<io::Vec3> places, double within_mm, auto done) {
      if (!places.empty()) beside.push_back({std::move(places), within_mm, std::move(done)});
    });
  }
  static io::DoubtfulPlaces three() {
    io::DoubtfulPlaces found;
    for (const double x : {100.0, 200.0, 300.0}) {
      found.places.push_back({.position_mm = {x, 0, 0}, .normal = {1, 0, 0}, .area_mm2 = x});
    }
    return found;
  }

  MadeText kept;
  SceneModel scene{kept};
  io::Structure liver;
  CorrectionModel model{scene};
  std::vector<std::function<void(io::DoubtfulPlaces)>> asked;
  struct Beside {
    std::vector<io::Vec3> places;
    double within_mm;
    std::function<void(const CorrectionModel::Edges&)> done;
  };
  std::vector<Beside> beside;
  int not_wanted = 0;
  std::vector<double> gone_to;
};

TEST_F(Correcting, AStrokeIsOneEditOfTheScene) {
  model.begin(liver, {});
  stroke({{0, 0, 0}, {1, 0, 0}, {1.1, 0, 0}, {2, 1, 0}});
  EXPECT_THAT(kinds(), ElementsAre("trace"));
  const auto& trace = std::get<io::TraceEdit>(model.edits().front());
  EXPECT_THAT(trace.points_mm, ElementsAre(io::Vec3(0, 0, 0), io::Vec3(1, 0, 0), io::Vec3(2, 1, 0)));
  EXPECT_EQ(kept_edits(), model.edits()) << "what is kept is what was drawn";
  EXPECT_TRUE(model.stroke().empty());
  EXPECT_EQ(kept.steps.back().what, "Trace");
  EXPECT_EQ(scene.scene().structures.front().file, "/study/liver.dcm");

  model.set_tool(Tool::add);
  model.set_radius_mm(4.5);
  stroke({{5, 0, 0}, {6, 0, 0}});
  model.set_tool(Tool::remove);
  stroke({{7, 0, 0}});
  EXPECT_THAT(kinds(), ElementsAre("trace", "add", "remove"));
  EXPECT_EQ(std::get<io::AddEdit>(model.edits()[1]).tube, (io::Tube{{{5, 0, 0}, {6, 0, 0}}, 4.5}));
  EXPECT_EQ(std::get<io::RemoveEdit>(model.edits()[2]).tube, (io::Tube{{{7, 0, 0}}, 4.5}));
  model.draw_felt({{8, 0, 0}, {9, 0, 0}});
  EXPECT_THAT(kinds(), SizeIs(4)) << "the stylus' path";
  model.set_tool(Tool::trace);
  stroke({{0, 9, 0}});
  EXPECT_THAT(kinds(), SizeIs(4)) << "a click";
}

TEST_F(Correcting, NothingIsDrawnWhereNothingIsCorrected) {
  stroke({{0, 0, 0}, {1, 0, 0}});
  model.draw_felt({{0, 0, 0}});
  model.undo();
  model.redo();
  model.take_scan_edge({0, 0, 0});
  EXPECT_TRUE(scene.scene().structures.empty());
  EXPECT_THAT(kept.steps, IsEmpty());
}

TEST_F(Correcting, EditsAreUndoneAndRedoneOneByOne) {
  model.begin(liver, {});
  for (int n = 0; n < 3; ++n) stroke({{10.0 * n, 0, 0}, {10.0 * n, 1, 0}});
  const std::vector<io::Edit> all = model.edits();
  EXPECT_FALSE(model.can_redo());
  for (std::size_t left = 3; left-- > 0;) {
    model.undo();
    EXPECT_THAT(model.edits(), SizeIs(left));
    EXPECT_EQ(kept_edits(), model.edits());
  }
  EXPECT_FALSE(model.can_undo());
  model.undo();
  EXPECT_THAT(model.edits(), IsEmpty());
  for (std::size_t done = 1; done <= 3; ++done) {
    model.redo();
    EXPECT_EQ(model.edits(), std::vector<io::Edit>(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(done)));
  }
  EXPECT_FALSE(model.can_redo());
  model.undo();
  model.undo();
  stroke({{77, 0, 0}, {78, 0, 0}});
  EXPECT_FALSE(model.can_redo()) << "another edit has taken their place";
  EXPECT_THAT(model.edits(), SizeIs(2));
}

TEST_F(Correcting, WhatParaViewTakesBackCanBeRedoneHere) {
  model.begin(liver, {});
  stroke({{0, 0, 0}, {0, 1, 0}});
  stroke({{10, 0, 0}, {10, 1, 0}});
  const std::vector<io::Edit> all = model.edits();
  scene.undo();
  EXPECT_THAT(model.edits(), SizeIs(1));
  EXPECT_TRUE(model.can_redo());
  model.redo();
  EXPECT_EQ(model.edits(), all);
  scene.undo();  // the redo
  scene.redo();
  EXPECT_EQ(model.edits(), all);
  EXPECT_FALSE(model.can_redo());
}

TEST_F(Correcting, EditsOfARestoredSceneCanBeTakenBack) {
  modes::Scene restored;
  restored.structures.push_back({.name = "liver", .file = liver.file, .segment = "liver"});
  restored.structures.front().edits = {io::AddEdit{{.path_mm = {{1, 2, 3}}, .radius_mm = 2}}};
  scene.open(restored);
  model.begin(liver, {});
  EXPECT_THAT(kinds(), ElementsAre("add"));
  model.undo();
  EXPECT_THAT(kept_edits(), IsEmpty());
}

TEST_F(Correcting, TheScansEdgeIsFeltWhileItLasts) {
  EXPECT_EQ(snap(), nullptr);
  model.begin(liver, {.per_mm = 120});
  ASSERT_NE(snap(), nullptr);
  EXPECT_TRUE(snap()->structure.empty()) << "the scan's edge, not the outline";
  EXPECT_EQ(snap()->side, modes::Side::both);
  EXPECT_DOUBLE_EQ(snap()->strength_n(120), model.snap_n());
  EXPECT_DOUBLE_EQ(snap()->strength_n(20), 0);
  ASSERT_THAT(snap()->gates, SizeIs(1));
  EXPECT_DOUBLE_EQ(snap()->gates[0].factor(0), 1);
  EXPECT_DOUBLE_EQ(snap()->gates[0].factor(-7), 0);
  model.set_snap_n(2.2);
  EXPECT_DOUBLE_EQ(snap()->strength_n(120), 2.2);
  model.end();
  EXPECT_EQ(snap(), nullptr);
  EXPECT_EQ(model.structure(), nullptr);
}

/// Half-way of the value: entered from below where the structure is brighter, and from above where it is darker.
TEST_F(Correcting, TheScansEdgeIsFeltHalfWay) {
  for (const double rise : {200.0, -200.0}) {
    model.begin(liver, {.per_mm = 120, .rise = rise, .middle = 40});
    ASSERT_NE(snap(), nullptr);
    EXPECT_EQ(snap()->side, rise > 0 ? modes::Side::entering : modes::Side::leaving);
    ASSERT_THAT(snap()->gates, SizeIs(2));
    EXPECT_EQ(snap()->gates[1].of, modes::Datum::value);
    EXPECT_DOUBLE_EQ(snap()->gates[1].factor(40 + 0.1 * rise), 1) << "inside";
    EXPECT_DOUBLE_EQ(snap()->gates[1].factor(40 - 0.1 * rise), 0) << "outside";
    EXPECT_NEAR(snap()->gates[1].factor(40), 0.5, 1e-9);
  }
}

/// Two planes, one to each side: a step that can be undone, and nothing where no outline is near.
TEST_F(Correcting, TheStylusIsHeldInASlice) {
  const HeldPlane slice{.point_mm = {1, 2, 30}, .normal = {0, 0, 1}};
  model.hold_in(slice);
  EXPECT_FALSE(model.held_in()) << "nothing is corrected";
  model.begin(liver, {});
  EXPECT_THAT(planes(), IsEmpty());
  model.hold_in(slice);
  ASSERT_THAT(planes(), SizeIs(2));
  EXPECT_EQ(planes()[0].direction, -planes()[1].direction);
  for (const modes::Mode& plane : planes()) {
    EXPECT_EQ(plane.position_mm, slice.point_mm);
    EXPECT_EQ(plane.shape, modes::Shape::plane);
    ASSERT_THAT(plane.gates, SizeIs(1));
    EXPECT_DOUBLE_EQ(plane.gates[0].factor(0), 1);
    EXPECT_DOUBLE_EQ(plane.gates[0].factor(7), 0);
  }
  EXPECT_EQ(kept.steps.back().what, "Hold in the slice");
  model.set_snap_n(2.2);
  stroke({{0, 0, 0}, {0, 1, 0}});
  EXPECT_THAT(planes(), SizeIs(2)) << "whatever else is changed";
  scene.undo();
  scene.undo();
  EXPECT_EQ(model.held_in(), slice);
  scene.undo();
  EXPECT_FALSE(model.held_in());
  EXPECT_THAT(planes(), IsEmpty());
  scene.redo();
  EXPECT_EQ(model.held_in(), slice) << "the scene's";
  model.hold_in(std::nullopt);
  EXPECT_THAT(planes(), IsEmpty());
  model.hold_in(slice);
  model.end();
  EXPECT_THAT(planes(), IsEmpty());
  EXPECT_FALSE(model.held_in());
}

/// Left, undone, or loaded with a state: what a correction adds is felt while it runs, and not afterwards.
TEST_F(Correcting, NothingThatHoldsTheStylusIsLeftBehind) {
  const HeldPlane slice{.point_mm = {1, 2, 30}, .normal = {0, 0, 1}};
  const auto kept_modes = [&] { return modes::scene_from_json(kept.text("Scene"), "scene").modes.size(); };
  model.begin(liver, {});
  model.hold_in(slice);
  stroke({{0, 0, 0}, {0, 1, 0}});
  const std::string saved = kept.text("Scene");
  const std::size_t steps = kept.steps.size();
  EXPECT_EQ(kept_modes(), 3U);
  model.forget();  // the scan was left
  EXPECT_EQ(snap(), nullptr);
  EXPECT_THAT(planes(), IsEmpty());
  EXPECT_EQ(kept_modes(), 0U) << "a state that is saved now has none";
  EXPECT_EQ(kept.steps.size(), steps) << "which is no step";
  EXPECT_THAT(kept_edits(), SizeIs(1)) << "the edits stay";
  scene.undo();
  EXPECT_THAT(kept_edits(), IsEmpty());
  EXPECT_EQ(kept_modes(), 0U);
  EXPECT_EQ(snap(), nullptr);
  kept.put("Scene", saved);  // a state file that was saved while it ran
  EXPECT_THAT(kept_edits(), SizeIs(1));
  EXPECT_EQ(kept_modes(), 0U);
  EXPECT_EQ(snap(), nullptr);
  model.begin(liver, {});
  EXPECT_NE(snap(), nullptr) << "one can go on";
  model.end();
  EXPECT_EQ(kept_modes(), 0U);
  scene.undo();
  EXPECT_EQ(snap(), nullptr) << "there is no correction that it would belong to";
}

/// A structure that the scene's contours make: they stay, whatever is taken back.
TEST_F(Correcting, ContoursThatMakeAStructureAreNoCorrection) {
  modes::SceneStructure drawn;
  drawn.name = "drawn";
  io::ContoursEdit contours;
  for (const double z : {0.0, 2.0, 4.0}) contours.loops_mm.push_back({{0, 0, z}, {9, 0, z}, {9, 9, z}, {0, 9, z}});
  drawn.edits = {contours};
  scene.edit(QStringLiteral("Draw"), [&](modes::Scene& now) { now.structures = {drawn}; });
  model.begin(drawn_structure(drawn), {});
  EXPECT_FALSE(model.can_undo());
  model.undo();
  EXPECT_THAT(kinds(), ElementsAre("contours"));
  EXPECT_EQ(scene.scene().structures.size(), 1U);
  model.set_tool(Tool::add);
  stroke({{5, 5, 2}, {6, 5, 2}});
  EXPECT_THAT(kinds(), ElementsAre("contours", "add"));
  EXPECT_TRUE(model.can_undo());
  model.undo();
  EXPECT_THAT(kinds(), ElementsAre("contours"));
  EXPECT_FALSE(model.can_undo());
  EXPECT_TRUE(model.can_redo());
}

TEST_F(Correcting, TheStylusIsFreeWhileAKeyIsHeld) {
  const HeldPlane slice{.point_mm = {1, 2, 30}, .normal = {0, 0, 1}};
  model.begin(liver, {});
  model.set_freed(true);
  EXPECT_FALSE(model.is_freed()) << "it is free";
  model.hold_in(slice);
  const std::size_t steps = kept.steps.size();
  model.set_freed(true);
  EXPECT_THAT(planes(), IsEmpty());
  EXPECT_EQ(model.held_in(), slice) << "and will be held again";
  model.set_freed(false);
  EXPECT_THAT(planes(), SizeIs(2));
  EXPECT_EQ(kept.steps.size(), steps) << "which is no step";
  model.set_freed(true);
  stroke({{0, 0, 0}, {0, 1, 0}});
  model.set_snap_n(2.2);
  EXPECT_TRUE(model.is_freed());
  EXPECT_THAT(planes(), IsEmpty());
  model.set_freed(false);
  EXPECT_THAT(planes(), SizeIs(2)) << "also after what was drawn meanwhile";
  EXPECT_THAT(kept_edits(), SizeIs(1));
}

TEST_F(Correcting, ThePlanesFollowTheSlice) {
  HeldPlane slice{.point_mm = {1, 2, 30}, .normal = {0, 0, 1}};
  model.begin(liver, {});
  model.follow_slice(slice);
  EXPECT_THAT(planes(), IsEmpty()) << "it is free";
  model.hold_in(slice);
  const std::size_t steps = kept.steps.size();
  for (slice.point_mm.z = 31; slice.point_mm.z < 35; ++slice.point_mm.z) {
    model.follow_slice(slice);
    ASSERT_THAT(planes(), SizeIs(2));
    EXPECT_EQ(planes()[1].position_mm, slice.point_mm);
  }
  EXPECT_EQ(kept.steps.size(), steps) << "while the wheel turns";
  stroke({{0, 0, 0}, {0, 1, 0}});
  EXPECT_DOUBLE_EQ(held_plane(modes::scene_from_json(kept.text("Scene"), "scene"), liver)->point_mm.z, 34);
}

/// The points of a felt trace carry how well the scan's edge is known there, and no others do.
TEST_F(Correcting, AFeltTraceCarriesHowWellItsEdgeIsKnown) {
  look_beside();
  model.begin(liver, {});
  model.draw_felt({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
  model.draw_felt({{5, 0, 0}});
  EXPECT_THAT(kinds(), IsEmpty()) << "it is being looked for";
  ASSERT_THAT(beside, SizeIs(1));
  EXPECT_THAT(beside[0].places, SizeIs(3));
  beside[0].done({EdgeBeside{{9, 9, 9}, 0.1, 0.4}, std::nullopt, EdgeBeside{{9, 9, 9}, -1.7, 0.3}});
  ASSERT_THAT(kinds(), ElementsAre("trace"));
  const auto& trace = std::get<io::TraceEdit>(model.edits().front());
  EXPECT_EQ(trace.points_mm, (std::vector<io::Vec3>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}})) << "where it was felt";
  EXPECT_THAT(trace.known_to_mm, ElementsAre(0.4, 0, 0)) << "no edge; and one that lies elsewhere";
  ASSERT_THAT(beside, SizeIs(2)) << "the next in its turn";
  beside[1].done({std::nullopt});
  EXPECT_THAT(kinds(), ElementsAre("trace", "trace"));
  stroke({{0, 0, 5}, {0, 1, 5}});
  EXPECT_THAT(beside, SizeIs(2)) << "what is drawn on a slice is where it was drawn";
  model.set_tool(Tool::add);
  model.draw_felt({{3, 0, 0}});
  EXPECT_THAT(beside, SizeIs(2));
  EXPECT_THAT(kinds(), ElementsAre("trace", "trace", "trace", "add"));
}

TEST_F(Correcting, AStrokeOverTheOutlineGoesToTheScansEdge) {
  look_beside();
  model.begin(liver, {});
  int nothing = 0;
  QObject::connect(&model, &CorrectionModel::nothing_traced, [&] { ++nothing; });
  const auto over = [&] {
    model.press({0, 0, 0}, CorrectionModel::Over::outline);
    model.move({1, 0, 0});
    model.move({2, 0, 0});
    model.let_go();
  };
  over();
  ASSERT_THAT(beside, SizeIs(1));
  EXPECT_GT(beside[0].within_mm, 5);
  beside[0].done({EdgeBeside{{0, 3, 0}, 3, 0.2}, std::nullopt, EdgeBeside{{2, 4, 0}, 4, 0.3}});
  ASSERT_THAT(kinds(), ElementsAre("trace"));
  const auto& trace = std::get<io::TraceEdit>(model.edits().front());
  EXPECT_THAT(trace.points_mm, ElementsAre(io::Vec3(0, 3, 0), io::Vec3(2, 4, 0)));
  EXPECT_THAT(trace.known_to_mm, ElementsAre(0.2, 0.3));
  over();
  beside[1].done({std::nullopt, std::nullopt, std::nullopt});
  EXPECT_EQ(nothing, 1);
  EXPECT_THAT(kinds(), SizeIs(1));
  over();
  model.forget();
  beside[2].done({EdgeBeside{{0, 3, 0}, 3, 0.2}, std::nullopt, std::nullopt});
  EXPECT_THAT(kept_edits(), SizeIs(1)) << "another scan";
}

TEST_F(Correcting, TheEditsStayWhereItEndsAndComeBack) {
  model.begin(liver, {});
  stroke({{0, 0, 0}, {0, 1, 0}});
  model.end();
  EXPECT_THAT(model.edits(), IsEmpty());
  EXPECT_THAT(kept_edits(), SizeIs(1));
  model.begin(liver, {});
  EXPECT_THAT(kinds(), ElementsAre("trace"));
}

TEST_F(Correcting, APlaceIsGoneToLeftOrCorrected) {
  model.begin(liver, {});
  ASSERT_THAT(asked, SizeIs(1));
  EXPECT_FALSE(model.places());
  asked.back()(three());
  ASSERT_TRUE(model.places());
  model.go_to(7);
  EXPECT_FALSE(model.at());
  model.go_to(1);
  EXPECT_EQ(model.at(), 1U);
  EXPECT_THAT(gone_to, ElementsAre(200));
  model.leave(2);
  model.take_scan_edge(model.places()->places[1].position_mm);
  EXPECT_THAT(kinds(), ElementsAre("scan_edge"));
  EXPECT_THAT(asked, SizeIs(1)) << "they are looked for once";
}

TEST_F(Correcting, APlaceIsCorrectedWhereTheOutlineHasLeftIt) {
  model.begin(liver, {});
  io::DoubtfulPlaces found = three();
  found.places[1].mean_mm = -4;
  asked.back()(found);
  model.leave(2);
  std::vector<double> off_mm{0.02, -0.02, 0.01};
  model.set_outline([&](const io::Vec3& at) -> std::optional<double> {
    if (off_mm.empty()) return std::nullopt;
    return off_mm.at(static_cast<std::size_t>(at.x) / 100 - 1);
  });
  const auto fates = [&] { return std::vector{model.fate(0), model.fate(1), model.fate(2)}; };
  EXPECT_THAT(fates(), ElementsAre(Fate::doubtful, Fate::doubtful, Fate::left));
  int told = 0;
  QObject::connect(&model, &CorrectionModel::places_changed, [&] { ++told; });
  const auto outline_is = [&](std::vector<double> mm) {
    off_mm = std::move(mm);
    model.outline_changed();
  };
  // Edits reach all three, and were held back at two of them.
  for (const double x : {100.0, 200.0, 300.0}) model.take_scan_edge({x, 0, 0});
  outline_is({0.02, -0.8, 0.01});
  EXPECT_GT(told, 0);
  EXPECT_THAT(fates(), ElementsAre(Fate::doubtful, Fate::doubtful, Fate::left));
  outline_is({0.4, 2.5, -1.2});
  EXPECT_THAT(fates(), ElementsAre(Fate::corrected, Fate::corrected, Fate::corrected));
  outline_is({});
  EXPECT_THAT(fates(), ElementsAre(Fate::doubtful, Fate::doubtful, Fate::left)) << "it is read";
}

TEST_F(Correcting, AnotherScanEndsItWithoutAStep) {
  model.begin(liver, {});
  asked.back()(three());
  model.press({0, 0, 0});
  const std::size_t steps = kept.steps.size();
  const int before = not_wanted;
  model.forget();
  EXPECT_EQ(kept.steps.size(), steps);
  EXPECT_GT(not_wanted, before);
  EXPECT_FALSE(model.places());
  EXPECT_TRUE(model.stroke().empty());
  model.let_go();
  EXPECT_THAT(kept_edits(), IsEmpty());
}

/// A step waits for what it needs to be read: what was pressed meanwhile is done after it, for the same structure.
TEST_F(Correcting, WhatIsPressedWhileAStepWaitsIsDoneAfterIt) {
  std::vector<std::pair<QString, SceneModel::Change>> waiting;
  model.set_press([&](const QString& what, const SceneModel::Change& change) { waiting.emplace_back(what, change); });
  model.begin(liver, {});
  EXPECT_THAT(asked, IsEmpty()) << "its outline is not read yet";
  stroke({{0, 0, 0}, {0, 1, 0}});
  stroke({{10, 0, 0}, {10, 1, 0}});
  model.end();
  for (const auto& [what, change] : waiting) scene.edit(what, change);
  EXPECT_THAT(kept_edits(), SizeIs(2));
  EXPECT_EQ(snap(), nullptr);
}

/// As in the panel: each step is done once what it needs was read.
struct CorrectingSlowly : Correcting {
  CorrectingSlowly() {
    scene.set_read([this](const modes::Scene&, auto done) {
      if (std::exchange(is_read, false)) return false;
      reading.push_back(std::move(done));
      return true;
    });
  }
  void all_is_read() {
    while (!reading.empty()) {
      is_read = true;
      std::exchange(reading, {}).back()({});
    }
  }

  bool is_read = false;  // what the next change needs
  std::vector<std::function<void(const QString&)>> reading;
};

TEST_F(CorrectingSlowly, EachOfSeveralQuickRedosIsTheNext) {
  model.begin(liver, {});
  for (int n = 0; n < 3; ++n) stroke({{10.0 * n, 0, 0}, {10.0 * n, 1, 0}});
  all_is_read();
  const std::vector<io::Edit> all = model.edits();
  ASSERT_THAT(all, SizeIs(3));
  for (int n = 0; n < 3; ++n) model.undo();
  all_is_read();
  ASSERT_THAT(model.edits(), IsEmpty());
  model.redo();
  model.redo();
  all_is_read();
  EXPECT_EQ(model.edits(), std::vector<io::Edit>(all.begin(), all.begin() + 2));
  EXPECT_TRUE(model.can_redo()) << "the third is not lost";
  model.redo();
  model.redo();
  all_is_read();
  EXPECT_EQ(model.edits(), all) << "there is none after the last";
  model.undo();
  all_is_read();
  model.redo();
  model.end();
  all_is_read();
  EXPECT_EQ(kept_edits(), all) << "also where it ends at once";
}

/// They are known once the outline was drawn, which may be after its correction has begun.
TEST_F(CorrectingSlowly, TheScansEdgesMayBecomeKnownLater) {
  model.set_edges({.per_mm = 7});
  EXPECT_THAT(reading, IsEmpty()) << "nothing is corrected";
  model.begin(liver, {});
  model.set_edges({.per_mm = 120, .rise = 200, .middle = 40});
  all_is_read();
  ASSERT_NE(snap(), nullptr);
  EXPECT_EQ(snap()->side, modes::Side::entering);
  EXPECT_DOUBLE_EQ(snap()->strength_n(120), model.snap_n());
  EXPECT_DOUBLE_EQ(snap()->strength_n(20), 0);
  const HeldPlane slice{.point_mm = {1, 2, 30}, .normal = {0, 0, 1}};
  model.hold_in(slice);
  model.set_snap_n(2.2);
  all_is_read();
  const std::size_t steps = kept.steps.size();
  model.set_edges({.per_mm = 30, .rise = -50, .middle = 10});
  all_is_read();
  EXPECT_EQ(snap()->side, modes::Side::leaving);
  EXPECT_DOUBLE_EQ(snap()->strength_n(30), 2.2);
  EXPECT_EQ(model.held_in(), slice);
  EXPECT_EQ(kept.steps.size(), steps) << "which is no step";
  EXPECT_EQ(kept.text("Scene"), modes::to_json(scene.scene())) << "and is kept";
  model.set_edges({.per_mm = 30, .rise = -50, .middle = 10});
  EXPECT_THAT(reading, IsEmpty()) << "they are the same";
}

TEST_F(CorrectingSlowly, ItIsHeldInASliceOnceTheSceneHasIt) {
  const HeldPlane slice{.point_mm = {1, 2, 30}, .normal = {0, 0, 1}};
  model.begin(liver, {});
  all_is_read();
  int told = 0;
  QObject::connect(&model, &CorrectionModel::changed, [&] { ++told; });
  model.hold_in(slice);
  EXPECT_FALSE(model.held_in()) << "it is read for";
  model.set_snap_n(2.2);
  all_is_read();
  EXPECT_EQ(model.held_in(), slice);
  EXPECT_THAT(planes(), SizeIs(2)) << "whatever was asked for meanwhile";
  scene.set_commit([](const modes::Scene&, Pace) { throw std::runtime_error("it has too many modes"); });
  told = 0;
  model.hold_in(std::nullopt);
  all_is_read();
  EXPECT_EQ(model.held_in(), slice) << "it was refused";
  model.follow_slice({.point_mm = {1, 2, 31}, .normal = {0, 0, 1}});
  EXPECT_EQ(model.held_in(), slice);
  model.hold_in(slice);
  EXPECT_GT(told, 1) << "whoever asked for it shows what is so";
}

/// A stroke that is looked at is the newest, though it is no edit yet.
TEST_F(Correcting, UndoDropsTheStrokeThatIsStillLookedAt) {
  look_beside();
  model.begin(liver, {});
  stroke({{0, 0, 5}, {0, 1, 5}});
  model.undo();
  ASSERT_TRUE(model.can_redo());
  model.redo();
  const std::vector<io::Edit> good = model.edits();
  model.draw_felt({{0, 0, 0}, {1, 0, 0}});
  model.draw_felt({{5, 0, 0}});
  EXPECT_TRUE(model.is_tracing());
  model.undo();
  EXPECT_TRUE(model.is_tracing()) << "the first";
  EXPECT_EQ(model.edits(), good);
  model.undo();
  EXPECT_FALSE(model.is_tracing());
  EXPECT_EQ(model.edits(), good) << "the good one stays";
  beside.front().done({std::nullopt, std::nullopt});
  EXPECT_EQ(model.edits(), good) << "and the bad one does not come";
  model.undo();
  EXPECT_THAT(model.edits(), IsEmpty());
}

TEST_F(Correcting, AStrokeThatIsLookedAtIsWaitedForAtTheEnd) {
  look_beside();
  model.begin(liver, {});
  model.draw_felt({{0, 0, 0}, {1, 0, 0}});
  model.draw_felt({{5, 0, 0}});
  EXPECT_TRUE(model.can_undo());
  EXPECT_FALSE(model.is_edited());
  model.end();
  ASSERT_NE(model.structure(), nullptr);
  beside[0].done({std::nullopt, std::nullopt});
  ASSERT_NE(model.structure(), nullptr);
  ASSERT_THAT(beside, SizeIs(2));
  beside[1].done({std::nullopt});
  EXPECT_EQ(model.structure(), nullptr);
  EXPECT_EQ(snap(), nullptr);
  EXPECT_THAT(kept_edits(), SizeIs(2));

  model.begin(liver, {});
  model.draw_felt({{9, 0, 0}});
  model.end();
  model.undo();
  EXPECT_EQ(model.structure(), nullptr) << "nothing is waited for any more";
  EXPECT_THAT(kept_edits(), SizeIs(2));

  model.begin(liver, {});
  model.draw_felt({{9, 0, 0}});
  model.end();
  io::Structure spleen = liver;
  spleen.number = 4;
  spleen.name = "spleen";
  model.begin(spleen, {});
  EXPECT_EQ(snap(), nullptr) << "another is begun: nothing of the first stays";
  EXPECT_EQ(model.structure()->name, "spleen");
}

TEST_F(Correcting, WhatCouldNotBeLookedForIsNotCalledAbsent) {
  look_beside();
  model.begin(liver, {});
  int nothing = 0;
  QObject::connect(&model, &CorrectionModel::nothing_traced, [&] { ++nothing; });
  model.press({0, 0, 0}, CorrectionModel::Over::outline);
  model.move({1, 0, 0});
  model.let_go();
  beside.back().done({});
  EXPECT_EQ(nothing, 0);
  EXPECT_THAT(kinds(), IsEmpty());
  model.draw_felt({{0, 0, 0}, {1, 0, 0}});
  beside.back().done({});
  ASSERT_THAT(kinds(), ElementsAre("trace")) << "where it was felt";
  EXPECT_THAT(std::get<io::TraceEdit>(model.edits().front()).known_to_mm, IsEmpty());
}

TEST_F(Correcting, DoubtfulPlacesAreOfTheFrameThatIsShown) {
  model.look_again();
  EXPECT_THAT(asked, IsEmpty());
  model.begin(liver, {});
  asked.back()(three());
  model.leave(2);
  model.go_to(1);
  stroke({{0, 0, 0}, {0, 1, 0}});
  model.look_again();
  EXPECT_FALSE(model.places());
  EXPECT_FALSE(model.at());
  ASSERT_THAT(asked, SizeIs(2));
  asked.back()(three());
  EXPECT_EQ(model.fate(2), Fate::doubtful);
  EXPECT_THAT(kept_edits(), SizeIs(1)) << "the edits stay";
}

}  // namespace
}  // namespace palpate::plugin

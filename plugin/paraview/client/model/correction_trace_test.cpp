/// Corrections: traces that use the scan's edge, and doubtful places.

#include <gmock/gmock.h>

#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "plugin/paraview/client/model/testing/correcting.h"

namespace palpate::plugin {
namespace {

using testing::Correcting;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using Fate = DoubtfulList::Fate;
using Tool = CorrectionModel::Tool;

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

TEST_F(Correcting, APlaceIsGoneToLeftOrCorrected) {
  model.begin(liver, {});
  ASSERT_THAT(asked, SizeIs(1));
  EXPECT_FALSE(model.doubtful().places());
  asked.back()(three());
  ASSERT_TRUE(model.doubtful().places());
  model.go_to(7);
  EXPECT_FALSE(model.doubtful().at());
  model.go_to(1);
  EXPECT_EQ(model.doubtful().at(), 1U);
  EXPECT_THAT(gone_to, ElementsAre(200));
  model.leave(2);
  model.take_scan_edge(model.doubtful().places()->places[1].position_mm);
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
  const auto fates = [&] {
    return std::vector{model.doubtful().fate(0), model.doubtful().fate(1), model.doubtful().fate(2)};
  };
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

TEST_F(Correcting, DoubtfulPlacesAreOfTheFrameThatIsShown) {
  model.look_again();
  EXPECT_THAT(asked, IsEmpty());
  model.begin(liver, {});
  asked.back()(three());
  model.leave(2);
  model.go_to(1);
  stroke({{0, 0, 0}, {0, 1, 0}});
  model.look_again();
  EXPECT_FALSE(model.doubtful().places());
  EXPECT_FALSE(model.doubtful().at());
  ASSERT_THAT(asked, SizeIs(2));
  asked.back()(three());
  EXPECT_EQ(model.doubtful().fate(2), Fate::doubtful);
  EXPECT_THAT(kept_edits(), SizeIs(1)) << "the edits stay";
}

}  // namespace
}  // namespace palpate::plugin

#include "plugin/paraview/client/model/scan_model.h"

#include <gmock/gmock.h>

#include <functional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "plugin/messages/messages.h"
#include "plugin/paraview/client/model/testing/scan_rig.h"
#include "plugin/paraview/client/words.h"

namespace palpate::plugin {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST_F(ScanModelFollowed, AnOnlySeriesIsShownAtOnce) {
  EXPECT_FALSE(model.message().problem);
  model.open("/one");
  EXPECT_TRUE(std::holds_alternative<coming::Finding>(model.coming()));
  world.found_.back()(folder("/one", {series("1", "A", 1)}), {});
  ASSERT_TRUE(model.on_its_way());
  EXPECT_EQ(model.on_its_way()->name, "1") << "it is said whose scan comes before its voxels are there";
  world.loaded_.back()(voxels(), {});
  EXPECT_TRUE(std::holds_alternative<in_views::Showing>(model.in_views()));
  EXPECT_EQ(model.shown(), nullptr);
  EXPECT_EQ(model.why_not_felt(), words(say("scan-is-still-being-read")));
  world.made_.back()({});
  EXPECT_THAT(world.take_asked(), ElementsAre("find /one", "load 1", "show 1"));
  ASSERT_NE(model.shown(), nullptr);
  EXPECT_TRUE(model.why_not_felt().isEmpty());
  EXPECT_FALSE(model.on_its_way());
  EXPECT_EQ(model.message().text, QStringLiteral("notes on 1"));
  EXPECT_EQ(take_reported(), QStringList({"leaving", "shown 1"}));
}

TEST_F(ScanModelFollowed, SeveralAreChosenFromAndTheListStays) {
  model.open("/two");
  world.found_.back()(folder("/two", {series("1", "A", 1), series("2", "A", 1)}), {});
  EXPECT_THAT(world.take_asked(), ElementsAre("find /two"));
  ASSERT_NE(model.found(), nullptr);
  EXPECT_EQ(model.message().text, words(say("series-choose-one", std::size_t{2})));
  model.choose(7);
  EXPECT_THAT(world.take_asked(), IsEmpty());
  model.choose(1);
  world.loaded_.back()(voxels(), {});
  world.made_.back()({});
  EXPECT_EQ(model.shown()->of.name, "2");
  ASSERT_NE(model.found(), nullptr) << "the other may be chosen next";
  EXPECT_EQ(model.found()->count(), 2U);
}

TEST_F(ScanModelFollowed, WhatWasOvertakenIsNeverShown) {
  model.open("/one");
  model.open("/two");
  world.found_.front()(folder("/one", {series("1", "A", 1)}), {});
  EXPECT_TRUE(std::holds_alternative<coming::Finding>(model.coming())) << "of the second folder";
  world.found_.back()(folder("/two", {series("1", "A", 1), series("2", "A", 1)}), {});
  model.choose(0);
  model.choose(1);
  world.loaded_.front()(voxels(), {});
  EXPECT_TRUE(std::holds_alternative<in_views::Nothing>(model.in_views()));
  world.loaded_.back()(voxels(), {});
  model.choose(0);  // while the views of the second are made
  world.loaded_.back()(voxels(), {});
  world.made_.front()({});
  EXPECT_EQ(model.shown(), nullptr) << "those were of the scan before";
  world.made_.back()({});
  EXPECT_EQ(model.shown()->of.name, "1");
}

TEST_F(ScanModelFollowed, OfTwoChoicesTheLastIsShown) {
  model.open("/two");
  world.found_.back()(folder("/two", {series("1", "A", 1), series("2", "A", 1)}), {});
  model.choose(0);
  model.choose(1);
  world.take_asked();
  world.loaded_.front()(voxels(), {});
  world.loaded_.front()({}, "a file is missing");
  EXPECT_THAT(world.take_asked(), IsEmpty());
  EXPECT_FALSE(model.message().problem);
  ASSERT_TRUE(std::holds_alternative<coming::Loading>(model.coming()));
  world.loaded_.back()(voxels(), {});
  EXPECT_THAT(world.take_asked(), ElementsAre("show 2"));
}

TEST_F(ScanModelFollowed, TheScanBeforeIsFeltUntilAnotherIsInTheViews) {
  show("1");
  model.open("/2");
  EXPECT_EQ(model.shown()->of.name, "1");
  EXPECT_TRUE(model.why_not_felt().isEmpty());
  world.found_.back()(folder("/2", {series("2", "A", 1)}), {});
  EXPECT_EQ(model.shown()->of.name, "1") << "the same patient's";
  world.loaded_.back()({}, "a file is missing");
  EXPECT_EQ(model.shown()->of.name, "1");
  EXPECT_TRUE(model.message().problem);
  EXPECT_FALSE(model.on_its_way());
  EXPECT_EQ(take_reported(), QStringList());
}

TEST_F(ScanModelFollowed, AScanThatDoesNotComeIsTold) {
  std::size_t told = 0;
  QObject::connect(&model, &ScanModel::not_coming, &model, [&told] { ++told; });
  const auto found_nothing = [this] { world.found_.back()({}, "there is no such folder"); };
  const auto found_no_series = [this] { world.found_.back()(folder("/2", {}), {}); };
  const auto found_one = [this] { world.found_.back()(folder("/2", {series("2", "A", 1)}), {}); };
  const auto read_nothing = [this, found_one] {
    found_one();
    world.loaded_.back()({}, "a file is missing");
  };
  show("1");
  const std::vector<std::function<void()>> ends{found_nothing, found_no_series, read_nothing,
                                                [this] { model.cancel(); }};
  for (std::size_t n = 0; n < ends.size(); ++n) {
    model.open("/2");
    EXPECT_EQ(told, n) << "it may still come";
    ends[n]();
    EXPECT_EQ(told, n + 1);
  }
  model.open("/2");
  found_one();
  world.loaded_.back()(voxels(), {});
  world.made_.back()({});
  EXPECT_EQ(model.shown()->of.name, "2");
  EXPECT_EQ(told, ends.size());
}

TEST_F(ScanModelFollowed, NoPatientStaysBesideAnothersName) {
  show("1");
  model.open("/2");
  world.found_.back()(folder("/2", {series("2", "B", 1)}), {});
  EXPECT_TRUE(std::holds_alternative<in_views::Nothing>(model.in_views()));
  EXPECT_EQ(model.on_its_way()->name, "2");
  EXPECT_EQ(take_reported(), QStringList({"leaving", "out of reach "}));
  EXPECT_THAT(world.take_asked(), ElementsAre("find /2", "close", "load 2"));
}

TEST_F(ScanModelFollowed, AFolderWithoutSeriesLeavesWhatIsShown) {
  show("1");
  model.open("/junk");
  world.found_.back()(folder("/junk", {}), {});
  EXPECT_TRUE(model.message().problem);
  EXPECT_EQ(model.shown()->of.name, "1");
  EXPECT_TRUE(model.why_not_felt().isEmpty());
  model.open("/absent");
  world.found_.back()({}, "there is no such folder");
  EXPECT_EQ(model.message().text, QStringLiteral("there is no such folder"));
  EXPECT_EQ(model.shown()->of.name, "1");
  EXPECT_EQ(model.found(), nullptr);
}

TEST_F(ScanModelFollowed, CancelLeadsBackToTheList) {
  show("1");
  model.open("/two");
  model.cancel();
  EXPECT_TRUE(std::holds_alternative<coming::Nothing>(model.coming()));
  world.found_.back()(folder("/two", {series("2", "B", 1)}), {});
  EXPECT_EQ(model.shown()->of.name, "1") << "a late answer changes nothing";
  model.open("/two");
  world.found_.back()(folder("/two", {series("2", "A", 1), series("3", "A", 1)}), {});
  model.choose(0);
  model.cancel();
  EXPECT_TRUE(std::holds_alternative<coming::Choosing>(model.coming()));
  world.loaded_.back()(voxels(), {});
  EXPECT_EQ(model.shown()->of.name, "1");
}

TEST_F(ScanModelFollowed, AScanWhoseViewsFailLeavesNoReader) {
  model.open("/1");
  world.found_.back()(folder("/1", {series("1", "A", 1)}), {});
  world.loaded_.back()(voxels(), {});
  world.take_asked();
  world.made_.back()("ParaView cannot draw it");
  EXPECT_TRUE(std::holds_alternative<in_views::Lost>(model.in_views()));
  EXPECT_THAT(world.take_asked(), ElementsAre("close"));
  EXPECT_EQ(model.why_not_felt(), QStringLiteral("ParaView cannot draw it"));
  EXPECT_TRUE(model.message().problem);
}

TEST_F(ScanModelFollowed, WhatIsDeletedIsNotFelt) {
  show("1");
  model.lose();
  EXPECT_EQ(model.shown(), nullptr);
  EXPECT_EQ(model.seen(), nullptr);
  EXPECT_TRUE(model.message().text.isEmpty()) << "the notes were on the scan that is gone";
  EXPECT_EQ(model.why_not_felt(), words(say("scan-left-the-pipeline")));
  EXPECT_EQ(take_reported(), QStringList({"leaving"}));
  EXPECT_THAT(world.take_asked(), IsEmpty()) << "Undo may bring it back, with its views";
}

TEST_F(ScanModelFollowed, WhatIsDeletedWhileItsViewsAreMadeIsClosed) {
  model.open("/1");
  world.found_.back()(folder("/1", {series("1", "A", 1)}), {});
  world.loaded_.back()(voxels(), {});
  world.take_asked();
  model.lose();
  EXPECT_THAT(world.take_asked(), ElementsAre("close"));
  EXPECT_TRUE(model.message().problem);
  world.made_.back()({});
  EXPECT_TRUE(std::holds_alternative<in_views::Lost>(model.in_views()));
}

/// As where the folder of a state is gone.
TEST_F(ScanModelFollowed, WhatCannotBeFetchedIsSaidToBeOutOfReach) {
  show("1");
  model.restore(model.shown()->of, Brought::by_state);
  world.fetched_.back()({.said = QStringLiteral("the folder is gone")});
  EXPECT_EQ(take_reported().back(), QStringLiteral("out of reach the folder is gone"));
  EXPECT_EQ(model.why_not_felt(), QStringLiteral("the folder is gone"));
}

/// The session waits for a scan that was announced: it is told in each case that the scan does not come.
TEST_F(ScanModelFollowed, WhatWasBeingFetchedIsSaidToBeOutOfReachHoweverItEnds) {
  const std::vector<std::pair<std::string, std::function<void()>>> ends{
      {"it is cancelled", [this] { model.cancel(); }},
      {"another folder is opened", [this] { model.open("/2"); }},
      {"it cannot be read", [this] { world.fetched_.back()({.said = QStringLiteral("the folder is gone")}); }},
      {"its reader is deleted", [this] { model.lose(); }},
      {"its reader is deleted as it comes",
       [this] {
         world.view = {};
         world.fetched_.back()({.volume = voxels(), .of = *model.seen()});
       }},
      {"it is not taken over",
       [this] {
         world.not_adopted = "the views are gone";
         world.fetched_.back()({.volume = voxels(), .of = *model.seen()});
       }},
  };
  for (const bool remote : {false, true}) {
    for (const Brought brought : {Brought::by_state, Brought::by_undo}) {
      for (const auto& [what, end] : ends) {
        if (what == "its reader is deleted as it comes" && !remote) continue;  // there it is taken over
        if (what == "it is not taken over" && remote) continue;                // there it was taken over before
        SCOPED_TRACE(what + (remote ? ", of a server" : ""));
        show("1");
        const SeriesRef of = model.shown()->of;
        world.remote = remote;
        model.restore(of, brought);
        take_reported();
        end();
        EXPECT_EQ(model.shown(), nullptr);
        EXPECT_FALSE(model.why_not_felt().isEmpty());
        EXPECT_THAT(take_reported(), Contains(QStringLiteral("out of reach ") + model.why_not_felt()));
        world.remote = false;
        world.not_adopted.clear();
      }
    }
  }
}

TEST_F(ScanModelFollowed, WhatUndoBringsBackIsFeltAgain) {
  show("1");
  const SeriesRef of = model.shown()->of;
  model.lose();
  model.restore(of, Brought::by_undo);
  EXPECT_EQ(model.on_its_way()->name, "1");
  EXPECT_EQ(model.why_not_felt(), words(say("scan-is-still-being-read")));
  world.fetched_.back()({.volume = voxels(), .of = of});
  EXPECT_EQ(model.shown()->of.name, "1");
  EXPECT_TRUE(model.why_not_felt().isEmpty());
  EXPECT_EQ(take_reported(), QStringList({"leaving", "leaving", "restored 1"}));
  EXPECT_NE(model.found(), nullptr) << "the others of its folder may still be chosen";
  EXPECT_THAT(world.take_asked(), ElementsAre("fetch 1", "adopt"));
}

/// Whatever comes in whatever order: what is felt is shown, and what is shown is the last that was asked for.
TEST(ScanModel, NoOrderOfEventsLeavesItHalf) {
  for (unsigned seed = 1; seed <= 300; ++seed) {
    std::mt19937 random(seed);
    const auto pick = [&](std::size_t of) { return of == 0 ? 0 : random() % of; };
    MadeWorld world;
    ScanModel model(world);
    bool left = true;  // the followers have let the scan before go
    QObject::connect(&model, &ScanModel::leaving, [&] { left = true; });
    QObject::connect(&model, &ScanModel::scan_shown, [&](const ScanHandle&, Brought) {
      EXPECT_TRUE(left) << "seed " << seed << ": two scans at once";
      left = false;
    });
    for (int step = 0; step < 60; ++step) {
      const auto answer = [&](auto& all, const auto& with) {
        if (!all.empty()) all[pick(all.size())](with, {});
      };
      switch (pick(12)) {
        case 0:
          model.open("/" + std::to_string(pick(3)));
          break;
        case 1:
          answer(world.found_, folder("/x", {series("1", pick(2) ? "A" : "B", 4), series("2", "A", 1)}));
          break;
        case 2:
          model.choose(pick(3));
          break;
        case 3:
        case 4:
          answer(world.loaded_, voxels());
          break;
        case 5:
        case 6:
          if (!world.made_.empty()) world.made_[pick(world.made_.size())](pick(4) == 0 ? "failed" : "");
          break;
        case 7:
          model.cancel();
          break;
        case 8:
          model.lose();
          world.view = {};
          break;
        case 9:
          world.time = static_cast<int>(pick(5));
          model.follow_time();
          break;
        case 10:
          model.go_to_frame(static_cast<int>(pick(5)));
          answer(world.frames_, voxels());
          break;
        default:
          if (pick(3) == 0) model.restore({.path = "/x", .name = "1", .label = {}}, Brought::by_state);
          if (!world.fetched_.empty()) {
            world.fetched_[pick(world.fetched_.size())]({.volume = pick(3) ? voxels() : nullptr,
                                                         .said = QStringLiteral("said"),
                                                         .of = {.path = "/x", .name = "1", .label = {}}});
          }
      }
      const ScanHandle* const shown = model.shown();
      EXPECT_EQ(shown != nullptr, !left) << "seed " << seed << ", step " << step;
      if (shown) {
        EXPECT_NE(shown->volume, nullptr);
        EXPECT_LT(shown->frame, shown->frames);
      } else {
        EXPECT_FALSE(model.why_not_felt().isEmpty()) << "seed " << seed << ", step " << step;
      }
    }
  }
}

}  // namespace
}  // namespace palpate::plugin

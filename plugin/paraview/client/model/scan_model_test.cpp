#include "plugin/paraview/client/model/scan_model.h"

#include <gmock/gmock.h>

#include <random>
#include <string>
#include <utility>

#include "plugin/messages/messages.h"
#include "plugin/paraview/client/model/testing/scan_rig.h"
#include "plugin/paraview/client/words.h"

namespace palpate::plugin {
namespace {

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

/// The list is told of when it is another, and by nothing else.
TEST_F(ScanModelFollowed, AListIsToldOfOnce) {
  int listed = 0;
  QObject::connect(&model, &ScanModel::listed, [&listed] { ++listed; });
  const auto count = [&listed] { return std::exchange(listed, 0); };
  for (const bool remote : {false, true}) {
    SCOPED_TRACE(remote);
    world.remote = remote;
    for (const std::string path : {"/a", "/b"}) {
      model.open(path);
      EXPECT_EQ(count(), path == "/a" && !remote ? 0 : 1) << "the one before is gone";
      EXPECT_EQ(model.path(), path);
      FoundList found = folder(path, {series("1", "A", 1), series("2", "A", 1)});
      if (remote) found = {.path = path, .on_server = {{"1", "CT", true}, {"2", "CT", true}}};
      world.found_.back()(found, {});
      EXPECT_EQ(count(), 1);
      EXPECT_EQ(model.path(), path);
      model.choose(1);
      if (!remote) world.loaded_.back()(voxels(), {});
      world.made_.back()({});
      if (remote) world.fetched_.back()({.volume = voxels(), .of = *model.seen()});
      ASSERT_NE(model.shown(), nullptr);
      model.restore(model.shown()->of, Brought::by_undo);
      EXPECT_EQ(count(), 0) << "it is the same list";
      world.fetched_.back()({.volume = voxels(), .of = *model.seen()});
    }
  }
}

TEST_F(ScanModelFollowed, AllWorkBeginsAtNothingAndTellsHowFarItIs) {
  int changes = 0;
  QObject::connect(&model, &ScanModel::changed, [&changes] { ++changes; });
  const auto goes_on = [&](const auto& done_of) {
    EXPECT_EQ(done_of(), 0);
    changes = 0;
    world.progress_(QStringLiteral("some work"), 0.25);
    EXPECT_EQ(done_of(), 0.25);
    EXPECT_EQ(changes, 1);
  };
  model.open("/one");
  goes_on([&] { return std::get<coming::Finding>(model.coming()).done; });
  const auto of_the_first = world.progress_;
  model.open("/one");
  of_the_first({}, 0.5);
  EXPECT_EQ(std::get<coming::Finding>(model.coming()).done, 0) << "of a search that was overtaken";
  world.found_.back()(folder("/one", {series("1", "A", 5)}), {});
  goes_on([&] { return std::get<coming::Loading>(model.coming()).done; });
  world.loaded_.back()(voxels(), {});
  world.made_.back()({});
  const SeriesRef of = model.shown()->of;
  model.restore(of, Brought::by_state);
  goes_on([&] { return std::get<in_views::Fetching>(model.in_views()).done; });
  EXPECT_EQ(std::get<in_views::Fetching>(model.in_views()).what, QStringLiteral("some work"));
}

TEST_F(ScanModelFollowed, APictureThatCannotBeTakenOverIsNotFelt) {
  for (const bool remote : {false, true}) {
    SCOPED_TRACE(remote);
    show("1");
    const SeriesRef of = model.shown()->of;
    world.remote = remote;
    world.not_adopted = "the views are gone";
    model.restore(of, Brought::by_undo);
    if (!remote) world.fetched_.back()({.volume = voxels(), .of = of});
    EXPECT_EQ(model.shown(), nullptr);
    EXPECT_EQ(model.why_not_felt(), QStringLiteral("the views are gone"));
    EXPECT_EQ(model.message().text, QStringLiteral("the views are gone"));
    EXPECT_TRUE(model.message().problem);
    const std::vector<std::string> here{"fetch 1", "adopt"}, there{"adopt"};
    EXPECT_EQ(world.take_asked(), remote ? there : here);
    world.remote = false;
    world.not_adopted.clear();
  }
}

TEST_F(ScanModelFollowed, AServersScanOfAStateIsSeenBeforeItIsFelt) {
  world.remote = true;
  const SeriesRef of{.path = "/there", .name = "1", .label = {}};
  model.restore(of, Brought::by_state);
  EXPECT_THAT(world.take_asked(), ElementsAre("adopt", "fetch 1"));
  EXPECT_EQ(take_reported(), QStringList({"leaving", "out of reach "}));
  EXPECT_EQ(model.message().text, QStringLiteral("notes on 1"));
  world.fetched_.back()({.volume = {}, .said = QStringLiteral("no memory"), .of = {}});
  EXPECT_EQ(take_reported(), QStringList({"out of reach no memory"}));
  EXPECT_EQ(model.message().text, QStringLiteral("notes on 1\nno memory"));
  model.add_copy("/here");
  world.fetched_.back()({.volume = voxels(), .of = of});
  EXPECT_EQ(model.shown()->of.name, "1");
}

/// A frame that was given up is not taken when it comes all the same.
TEST_F(ScanModelFollowed, AServersFrameThatWasGivenUpIsNotTaken) {
  world.remote = true;
  model.open("/there");
  world.found_.back()({.path = "/there", .on_server = {{"1", "CT", true}}}, {});
  world.made_.back()({});
  world.fetched_.back()({.volume = voxels(), .of = *model.seen(), .frames = 3});
  EXPECT_EQ(model.wanted_frame(), 0);
  model.go_to_frame(2);
  model.follow_time();
  EXPECT_EQ(model.wanted_frame(), 2);
  EXPECT_EQ(std::get<in_views::Shown>(model.in_views()).coming->done, 0);
  world.progress_(QStringLiteral("some work"), 0.5);
  EXPECT_EQ(std::get<in_views::Shown>(model.in_views()).coming->done, 0.5);
  model.cancel();
  EXPECT_FALSE(std::get<in_views::Shown>(model.in_views()).coming);
  take_reported();
  world.fetched_.back()({.volume = voxels(), .of = {}, .frame = 2});
  EXPECT_EQ(model.shown()->frame, 0);
  EXPECT_EQ(take_reported(), QStringList());
  // One that cannot be had is told, and the one before stays felt.
  model.follow_time();
  world.fetched_.back()({.volume = {}, .said = QStringLiteral("no memory"), .of = {}});
  EXPECT_EQ(model.message().text, QStringLiteral("no memory"));
  EXPECT_TRUE(model.message().problem);
  EXPECT_FALSE(std::get<in_views::Shown>(model.in_views()).coming);
  EXPECT_EQ(model.shown()->frame, 0);
}

/// Its voxels are read by one program at a time, so they are let go before the next folder is looked through.
TEST_F(ScanModelFollowed, AServersScanIsNotFeltWhileAnotherFolderIsLookedThrough) {
  world.remote = true;
  model.open("/there");
  world.found_.back()({.path = "/there", .on_server = {{"1", "CT", true}}}, {});
  world.made_.back()({});
  world.fetched_.back()({.volume = voxels(), .of = *model.seen()});
  ASSERT_NE(model.shown(), nullptr);
  take_reported();
  model.open("/next");
  EXPECT_TRUE(std::holds_alternative<in_views::OutOfReach>(model.in_views()));
  EXPECT_EQ(model.why_not_felt(), words(say("scan-is-on-the-server")));
  EXPECT_EQ(take_reported(), QStringList({"out of reach "}));
}

/// Work whose answer nobody waits for is ended, and not only ignored.
TEST_F(ScanModelFollowed, WhatIsOvertakenIsStopped) {
  model.open("/one");
  int before = world.stopped;
  model.open("/two");
  EXPECT_GT(world.stopped, before);
  world.found_.back()(folder("/two", {series("2", "A", 5)}), {});
  world.loaded_.back()(voxels(), {});
  world.made_.back()({});
  model.go_to_frame(3);
  before = world.frames_stopped;
  const SeriesRef of = model.shown()->of;
  model.lose();
  EXPECT_GT(world.frames_stopped, before);
  model.restore(of, Brought::by_undo);
  before = world.fetching_stopped;
  model.lose();
  EXPECT_GT(world.fetching_stopped, before);
  model.restore(of, Brought::by_undo);
  before = world.stopped;
  const int fetching_before = world.fetching_stopped;
  model.cancel();
  EXPECT_GT(world.stopped, before);
  EXPECT_GT(world.fetching_stopped, fetching_before);
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

TEST_F(ScanModelFollowed, AStateThatCannotBeReadSaysSo) {
  show("1");
  model.restore({.path = "/gone", .name = "9", .label = {}}, Brought::by_state);
  EXPECT_EQ(model.shown(), nullptr) << "the scan before is not in the state";
  world.fetched_.back()({.volume = {}, .said = QStringLiteral("there is no such folder"), .of = {}});
  EXPECT_TRUE(std::holds_alternative<in_views::OutOfReach>(model.in_views()));
  EXPECT_EQ(model.why_not_felt(), QStringLiteral("there is no such folder"));
  EXPECT_TRUE(model.message().problem);
}

TEST_F(ScanModelFollowed, AServersScanIsSeenBeforeItIsFelt) {
  world.remote = true;
  model.open("/there");
  world.found_.back()({.path = "/there", .on_server = {{"1", "CT", true}, {"2", "report", false}}}, {});
  EXPECT_THAT(world.take_asked(), ElementsAre("find /there", "show 1")) << "the only volume of them";
  world.made_.back()({});
  EXPECT_TRUE(std::holds_alternative<in_views::Fetching>(model.in_views()));
  EXPECT_EQ(model.why_not_felt(), words(say("scan-is-still-being-read")));
  world.fetched_.back()({.volume = {}, .said = QStringLiteral("no memory"), .of = {}});
  EXPECT_EQ(model.why_not_felt(), QStringLiteral("no memory"));
  EXPECT_EQ(take_reported(), QStringList({"out of reach ", "leaving", "out of reach ", "out of reach no memory"}));
  model.add_copy("/here");
  EXPECT_THAT(world.looked_in, ElementsAre("/there", "/here"));
  world.fetched_.back()({.volume = voxels(), .said = QStringLiteral("from a copy"), .of = *model.seen(), .frames = 3});
  ASSERT_NE(model.shown(), nullptr);
  EXPECT_EQ(model.shown()->frames, 3);
  world.time = 2;
  model.follow_time();
  EXPECT_EQ(model.why_not_felt(), words(say("scan-is-still-being-read")));
  world.fetched_.back()({.volume = voxels(), .said = {}, .of = {}, .frame = 2});
  EXPECT_EQ(model.shown()->frame, 2);
  EXPECT_TRUE(model.why_not_felt().isEmpty());
  take_reported();
  model.lose_server();
  EXPECT_EQ(take_reported(), QStringList({"leaving"}));
  EXPECT_EQ(model.shown(), nullptr);
  EXPECT_EQ(model.found(), nullptr);
}

TEST_F(ScanModelFollowed, CancelLeavesAServersScanInTheViews) {
  world.remote = true;
  model.open("/there");
  world.found_.back()({.path = "/there", .on_server = {{"1", "CT", true}}}, {});
  world.made_.back()({});
  model.cancel();
  EXPECT_TRUE(std::holds_alternative<in_views::OutOfReach>(model.in_views()));
  EXPECT_EQ(take_reported().back(), QStringLiteral("out of reach ") + words(say("scan-is-on-the-server")));
  world.fetched_.back()({.volume = voxels(), .said = {}, .of = *model.seen()});
  EXPECT_EQ(model.shown(), nullptr) << "a late answer changes nothing";
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

TEST_F(ScanModelFollowed, NothingLeavesWhereTheUserDoesNotWantIt) {
  show("1");
  int asked = 0;
  bool may = false;
  model.set_may_leave([&] {
    ++asked;
    return may;
  });
  model.open("/2");
  EXPECT_THAT(world.take_asked(), IsEmpty());
  EXPECT_TRUE(take_reported().isEmpty());
  EXPECT_EQ(model.shown()->of.name, "1");
  may = true;
  model.open("/2");
  may = false;  // what was edited while the folder was looked through
  world.found_.back()(folder("/2", {series("2", "B", 1)}), {});
  EXPECT_EQ(asked, 3);
  EXPECT_EQ(model.shown()->of.name, "1") << "nor is it closed for another patient's";
  EXPECT_EQ(model.found(), nullptr);
  may = true;
  model.open("/2");
  world.found_.back()(folder("/2", {series("2", "A", 1), series("3", "A", 1)}), {});
  world.take_asked();
  may = false;
  model.choose(1);
  EXPECT_THAT(world.take_asked(), IsEmpty());
  may = true;
  model.choose(1);
  may = false;  // while it was read
  world.loaded_.back()(voxels(), {});
  EXPECT_THAT(world.take_asked(), ElementsAre("load 3"));
  EXPECT_EQ(model.shown()->of.name, "1");
  ASSERT_NE(model.found(), nullptr) << "it can be chosen again";
  EXPECT_FALSE(model.on_its_way());
  may = true;
  model.choose(0);
  world.loaded_.back()(voxels(), {});
  world.made_.back()({});
  EXPECT_EQ(model.shown()->of.name, "2");
}

// The question handles events.
TEST_F(ScanModelFollowed, WhatIsAskedWhileItIsAskedOvertakes) {
  show("1");
  bool nested = false;
  model.set_may_leave([&] {
    if (!std::exchange(nested, true)) model.open("/3");
    return true;
  });
  model.open("/two");
  EXPECT_THAT(world.take_asked(), ElementsAre("find /3", "find /two"));
  world.found_.back()(folder("/two", {series("2", "A", 1), series("3", "A", 1)}), {});
  nested = false;
  model.choose(0);
  EXPECT_THAT(world.take_asked(), ElementsAre("find /3")) << "the list is no longer that one";
}

}  // namespace
}  // namespace palpate::plugin

// Scans of a ParaView server, and of a state file: seen before their voxels are here.

#include "plugin/paraview/client/model/scan_model.h"

#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "plugin/messages/messages.h"
#include "plugin/paraview/client/model/testing/scan_rig.h"
#include "plugin/paraview/client/words.h"

namespace palpate::plugin {
namespace {

using ::testing::ElementsAre;

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

}  // namespace
}  // namespace palpate::plugin

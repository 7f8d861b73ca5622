// What the model asks and tells beside the scan itself: whether it may leave, what is listed, how far work is.

#include "plugin/paraview/client/model/scan_model.h"

#include <gmock/gmock.h>

#include <string>
#include <utility>
#include <variant>

#include "plugin/messages/messages.h"
#include "plugin/paraview/client/model/testing/scan_rig.h"
#include "plugin/paraview/client/words.h"

namespace palpate::plugin {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

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

TEST_F(ScanModelFollowed, AScanIsNotFetchedAnyMoreWhereAnotherSeriesIsRead) {
  model.open("/two");
  world.found_.back()(folder("/two", {series("1", "A", 1), series("2", "A", 1)}), {});
  model.choose(0);
  world.loaded_.back()(voxels(), {});
  world.made_.back()({});
  const SeriesRef of = model.shown()->of;
  model.lose();
  model.restore(of, Brought::by_undo);
  ASSERT_TRUE(std::holds_alternative<in_views::Fetching>(model.in_views()));
  take_reported();
  const int before = world.fetching_stopped;
  model.choose(1);
  EXPECT_GT(world.fetching_stopped, before);
  EXPECT_TRUE(std::holds_alternative<in_views::OutOfReach>(model.in_views()));
  EXPECT_EQ(take_reported(), QStringList(QStringLiteral("out of reach ") + words(say("cancelled"))));
  ASSERT_TRUE(model.on_its_way());
  EXPECT_EQ(model.on_its_way()->name, "2");
  world.loaded_.back()({}, "it is broken");
  EXPECT_FALSE(model.on_its_way()) << "nothing comes any more";
  world.fetched_.back()({.volume = voxels(), .of = of});
  EXPECT_EQ(model.shown(), nullptr) << "that one was given up";
  model.choose(0);
  world.loaded_.back()(voxels(), {});
  world.made_.back()({});
  ASSERT_NE(model.shown(), nullptr);
  EXPECT_EQ(model.shown()->of.name, "1");
}

TEST_F(ScanModelFollowed, NothingLeavesWhereTheUserDoesNotWantIt) {
  show("1");
  int asked = 0, not_coming = 0;
  bool may = false;
  model.set_may_leave([&] {
    ++asked;
    return may;
  });
  QObject::connect(&model, &ScanModel::not_coming, &model, [&not_coming] { ++not_coming; });
  model.open("/2");
  EXPECT_EQ(not_coming, 1);
  EXPECT_THAT(world.take_asked(), IsEmpty());
  EXPECT_TRUE(take_reported().isEmpty());
  EXPECT_EQ(model.shown()->of.name, "1");
  may = true;
  model.open("/2");
  may = false;  // what was edited while the folder was looked through
  world.found_.back()(folder("/2", {series("2", "B", 1)}), {});
  EXPECT_EQ(asked, 3);
  EXPECT_EQ(not_coming, 2);
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
  EXPECT_EQ(not_coming, 3);
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

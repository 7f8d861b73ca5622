#include "plugin/paraview/client/model/scan_model.h"

#include <gmock/gmock.h>

#include "plugin/messages/messages.h"
#include "plugin/paraview/client/model/testing/scan_rig.h"
#include "plugin/paraview/client/words.h"

namespace palpate::plugin {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(ScanHandleSaid, ASizeIsSlicesAndNoVoxels) {
  io::Volume volume;
  volume.modality = "CT";
  volume.geometry.dimensions = {96, 80, 64};
  volume.geometry.spacing_i = volume.geometry.spacing_j = 0.957;
  volume.geometry.step = {0, 1.5, 2};
  volume.unit = "HU";
  EXPECT_EQ(size_in_words(volume), "CT, 64 slices of 96 x 80, every 2.5 mm");
  const SeriesRef of_a_server{.path = "/there", .name = "1", .label = "one"};
  const auto held = std::make_shared<const io::Volume>(volume);
  EXPECT_EQ(handle_of(of_a_server, held, 0, 1).series, size_in_words(volume));
}

TEST(ScanHandleSaid, AFrameIsCountedFromOneAndNamedWhereItHasAName) {
  ScanHandle one;
  one.series = "CT";
  EXPECT_TRUE(one.frame_in_words().isEmpty());
  EXPECT_EQ(one.in_words(), QStringLiteral("CT"));
  ScanHandle several{.series = "DWI", .frame = 1, .frames = 3, .frame_names = {"b = 0 s/mm2", ""}};
  EXPECT_EQ(several.frame_in_words(0), QStringLiteral("b = 0 s/mm2, 1 of 3"));
  EXPECT_EQ(several.in_words(), QStringLiteral("DWI, frame 2 of 3"));
  EXPECT_EQ(several.frame_in_words(2), QStringLiteral("frame 3 of 3")) << "it has fewer names than frames";
}

TEST_F(ScanModelFollowed, TheWantedFrameIsTheOneThatComes) {
  EXPECT_EQ(model.wanted_frame(), 0);
  show("1", 5);
  world.time = 2;
  EXPECT_EQ(model.wanted_frame(), 2) << "ParaView's time";
  model.go_to_frame(4);
  EXPECT_EQ(model.wanted_frame(), 4);
}

TEST_F(ScanModelFollowed, AFrameIsHereBeforeTheViewsGoThere) {
  show("1", 5);
  model.go_to_frame(3);
  EXPECT_THAT(world.take_asked(), ElementsAre("frame 3"));
  EXPECT_EQ(model.shown()->frame, 0);
  EXPECT_TRUE(model.why_not_felt().isEmpty()) << "the views show the frame before, and it is felt";
  world.frames_.back()(voxels(), {});
  EXPECT_THAT(world.take_asked(), ElementsAre("time 3"));
  EXPECT_TRUE(model.why_not_felt().isEmpty());
  model.follow_time();
  EXPECT_EQ(model.shown()->frame, 3);
  EXPECT_EQ(take_reported(), QStringList({"frame 3"}));
  EXPECT_THAT(world.take_asked(), IsEmpty()) << "it is not read twice";
}

/// The filter of that moment: the scene may get another one between two frames.
TEST_F(ScanModelFollowed, EachFrameIsReadThroughTheFilterThatIsFelt) {
  io::Filter felt_through;
  model.set_filter([&felt_through] { return felt_through; });
  show("1", 5);
  int frame = 0;
  for (const char* const name : {"gaussian", "", "median", "bilateral"}) {
    felt_through = {.type = *name == 0 ? nullptr : io::find_filter_type(name)};
    world.filters.clear();
    frame = (frame + 1) % 5;
    model.go_to_frame(frame);  // from the panel
    EXPECT_THAT(world.filters, ElementsAre(felt_through)) << name;
    frame = (frame + 1) % 5;
    world.time = frame;  // by ParaView
    model.follow_time();
    EXPECT_THAT(world.filters, ElementsAre(felt_through, felt_through)) << name;
    world.frames_.back()(voxels(), {});
    EXPECT_EQ(model.shown()->frame, frame);
  }
}

TEST_F(ScanModelFollowed, TheLastFrameAskedForIsShown) {
  show("1", 5);
  model.go_to_frame(-1);
  model.go_to_frame(99);
  EXPECT_THAT(world.take_asked(), ElementsAre("frame 0", "frame 4"));
  world.frames_.front()(voxels(), {});
  EXPECT_THAT(world.take_asked(), IsEmpty());
  world.frames_.back()(voxels(), {});
  EXPECT_THAT(world.take_asked(), ElementsAre("time 4"));
}

TEST_F(ScanModelFollowed, ParaViewsTimeIsFollowed) {
  show("1", 5);
  const auto apart = [this](int shown) {
    const ScanHandle& scan = *model.shown();
    return words(
        say("views-show-another-scan", scan.frame_in_words(shown).toStdString(), scan.frame_in_words(0).toStdString()));
  };
  world.time = 2;
  model.follow_time();
  EXPECT_EQ(model.why_not_felt(), apart(2)) << "no force of frame 0 under the picture of frame 2";
  world.time = 4;
  model.follow_time();
  EXPECT_EQ(model.why_not_felt(), apart(4));
  world.frames_.front()(voxels(), {});
  EXPECT_EQ(model.shown()->frame, 0) << "ParaView has gone on";
  world.frames_.back()({}, {});
  EXPECT_FALSE(model.message().problem) << "it was stopped";
  model.follow_time();
  world.frames_.back()({}, "frame 4 is not whole");
  EXPECT_EQ(model.message().text, QStringLiteral("frame 4 is not whole"));
  EXPECT_TRUE(model.message().problem);
  EXPECT_EQ(model.shown()->frame, 0);
  EXPECT_EQ(model.why_not_felt(), apart(4));
  world.time = 1;
  model.follow_time();
  world.frames_.back()(voxels(), {});
  EXPECT_EQ(model.shown()->frame, 1);
  EXPECT_TRUE(model.why_not_felt().isEmpty());
}

TEST_F(ScanModelFollowed, AFrameOfTheScanBeforeIsNotTakenForTheNext) {
  show("1", 5);
  model.go_to_frame(3);
  model.open("/2");
  world.found_.back()(folder("/2", {series("2", "A", 5)}), {});
  world.loaded_.back()(voxels(), {});
  world.made_.back()({});
  world.take_asked();
  world.frames_.back()(voxels(), {});
  EXPECT_EQ(model.shown()->frame, 0);
  EXPECT_THAT(world.take_asked(), IsEmpty());
}

/// The same where a frame of the next scan is loaded, too: an answer is for what was asked, and for nothing else.
TEST_F(ScanModelFollowed, AFrameOfTheScanBeforeIsNotTakenForOneOfTheNext) {
  show("1", 5);
  model.go_to_frame(3);
  const ScanWorld::Loaded of_the_first = world.frames_.back();
  show("2", 5);
  model.go_to_frame(2);
  world.take_asked();
  of_the_first(voxels(), {});
  EXPECT_THAT(world.take_asked(), IsEmpty());
  EXPECT_EQ(model.shown()->frame, 0);
  world.frames_.back()(voxels(), {});
  EXPECT_THAT(world.take_asked(), ElementsAre("time 2"));
}

TEST_F(ScanModelFollowed, WhatTheViewsShowOtherwiseIsNotFelt) {
  show("1");
  world.view.name = "Reader1";
  world.view.other = "Reader2";
  EXPECT_EQ(model.why_not_felt(), words(say("another-scan-is-active-in-the-pipeline", "Reader2", "Reader1")));
  world.view.seen = false;
  EXPECT_EQ(model.why_not_felt(), words(say("no-view-shows-the-scan")));
  world.view.in_pipeline = false;
  EXPECT_EQ(model.why_not_felt(), words(say("scan-left-the-pipeline")));
}

}  // namespace
}  // namespace palpate::plugin

#include "plugin/paraview/client/model/open_views.h"

#include <gmock/gmock.h>

#include <string>

namespace palpate::plugin {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

struct OpenViewsFollowed : ::testing::Test {
  [[nodiscard]] OpenViews::Following follow(Layer layer, const std::string& name) {
    return views.follow(layer, [this, name](const std::vector<ClinicalView>& open) {
      called.push_back(name + " " + std::to_string(open.size()));
    });
  }

  OpenViews views;
  std::vector<std::string> called;
};

TEST_F(OpenViewsFollowed, WhatLiesBelowComesFirstAndLeavesLast) {
  const auto stylus = follow(Layer::stylus, "stylus");
  const auto image = follow(Layer::image, "image");
  const auto first = follow(Layer::paths, "first"), second = follow(Layer::paths, "second");
  EXPECT_THAT(called, IsEmpty()) << "there are no views yet";
  views.set({{.kind = ViewKind::axial}, {.kind = ViewKind::volume}});
  EXPECT_THAT(called, ElementsAre("image 2", "first 2", "second 2", "stylus 2"));
  called.clear();
  views.set({});
  EXPECT_THAT(called, ElementsAre("stylus 0", "second 0", "first 0", "image 0"));
}

TEST_F(OpenViewsFollowed, OneThatComesLateHasTheViewsToo) {
  views.set({{.kind = ViewKind::axial}});
  const auto late = follow(Layer::outlines, "late");
  EXPECT_THAT(called, ElementsAre("late 1"));
}

TEST_F(OpenViewsFollowed, OneThatIsGoneIsNotCalled) {
  { const auto gone = follow(Layer::outlines, "gone"); }
  const auto there = follow(Layer::outlines, "there");
  views.set({{.kind = ViewKind::axial}});
  EXPECT_THAT(called, ElementsAre("there 1"));
}

TEST_F(OpenViewsFollowed, AnotherSliceIsReportedToThoseThatDrawOnIt) {
  int slice = 0;
  auto& shown = reinterpret_cast<SliceView&>(slice);  // it is handed on, and never looked at
  const auto draws = views.follow(
      Layer::paths, [](const auto&) {}, [&](SliceView& seen) { called.emplace_back(&seen == &shown ? "draws" : "?"); });
  const auto image = follow(Layer::image, "image");
  views.show_slice(shown);
  EXPECT_THAT(called, ElementsAre("draws"));
}

}  // namespace
}  // namespace palpate::plugin

#include "plugin/session/felt_workspace.h"

#include <gtest/gtest.h>

namespace palpate::plugin {
namespace {

modes::Workspace at_x(double mm) {
  return {.center_mm = {mm, 0, 0}};
}

double place_of(FeltWorkspace& felt, std::uint32_t epoch, double part) {
  TickRecord tick;
  tick.scene_epoch = epoch;
  tick.change_part = part;
  return felt.at(tick).center_mm.x;
}

TEST(FeltWorkspace, IsThatOfEachTicksScene) {
  FeltWorkspace felt;
  felt.set(at_x(1));
  EXPECT_EQ(place_of(felt, 7, 1), 1) << "of a session that began with it";
  EXPECT_FALSE(felt.change_to(at_x(1), 8));
  EXPECT_TRUE(felt.change_to(at_x(11), 9));
  EXPECT_EQ(felt.now().center_mm.x, 11);
  EXPECT_EQ(place_of(felt, 7, 1), 1) << "not taken yet";
  EXPECT_EQ(place_of(felt, 9, 0), 1);
  EXPECT_EQ(place_of(felt, 9, 0.5), 6);
  // The next waits until this change is over.
  EXPECT_TRUE(felt.change_to(at_x(111), 10));
  EXPECT_EQ(place_of(felt, 9, 0.9), 10);
  EXPECT_EQ(place_of(felt, 9, 1), 11);
  EXPECT_EQ(place_of(felt, 10, 0.5), 61);
  EXPECT_EQ(place_of(felt, 10, 1), 111);
}

/// The session takes the newest: the transition is from what was felt.
TEST(FeltWorkspace, IsOfNoSceneThatWasPassedOver) {
  FeltWorkspace felt;
  felt.set(at_x(0));
  EXPECT_EQ(place_of(felt, 1, 1), 0);
  felt.change_to(at_x(50), 2);
  felt.change_to(at_x(10), 3);
  EXPECT_EQ(place_of(felt, 3, 0.5), 5);
  for (std::uint32_t epoch = 4; epoch < 100; ++epoch) felt.change_to(at_x(epoch), epoch);
  EXPECT_EQ(place_of(felt, 99, 1), 99);
}

TEST(FeltWorkspace, OfAnotherSessionForgetsTheOneBefore) {
  FeltWorkspace felt;
  felt.set(at_x(0));
  felt.change_to(at_x(5), 40);
  EXPECT_EQ(place_of(felt, 40, 1), 5);
  felt.set(at_x(5));
  EXPECT_EQ(place_of(felt, 1, 0), 5);
  felt.change_to(at_x(7), 2);
  EXPECT_EQ(place_of(felt, 2, 1), 7);
}

}  // namespace
}  // namespace palpate::plugin

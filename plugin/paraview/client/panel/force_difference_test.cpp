#include "plugin/paraview/client/panel/force_difference.h"

#include <gtest/gtest.h>

namespace palpate::plugin {
namespace {

TEST(ForceDifference, OfATenthIsFelt) {
  EXPECT_TRUE(feels_alike(2, 2));
  EXPECT_TRUE(feels_alike(2, 1.85));
  EXPECT_FALSE(feels_alike(2, 1.75));
  EXPECT_FALSE(feels_alike(2, 2.3));
}

TEST(ForceDifference, IsAPartOfTheForceWhateverItIs) {
  for (const double newtons : {0.1, 1.0, 10.0}) {
    EXPECT_TRUE(feels_alike(newtons, 1.09 * newtons));
    EXPECT_FALSE(feels_alike(newtons, 1.13 * newtons));
    EXPECT_EQ(feels_alike(newtons, 1.05 * newtons), feels_alike(1.05 * newtons, newtons));
  }
}

TEST(ForceDifference, TellsSomethingFromNothing) {
  EXPECT_FALSE(feels_alike(0, 0.1));
}

}  // namespace
}  // namespace palpate::plugin

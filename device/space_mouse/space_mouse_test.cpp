#include "device/space_mouse/space_mouse.h"

#include <gtest/gtest.h>

#include <array>
#include <glm/geometric.hpp>
#include <map>
#include <memory>

#include "device/space_mouse/space_mouse_driver.h"
#include "device/testing/fake_space_mouse.h"

namespace palpate::device {
namespace {

struct Bench {
  FakeHidBench bench;
  FakeSpaceMouse puck;
  std::unique_ptr<LinkStylus> stylus;

  explicit Bench(bool together = false) : puck(together) {
    LinkStylusOptions options;
    options.threaded = false;
    stylus = make_space_mouse_on(
        {}, [this] { return std::make_unique<FakeHidLink>(puck, bench); }, options);
    stylus->open();
  }
  Reading run(double seconds) {
    const double end = bench.time + seconds;
    while (bench.time < end) stylus->service(1e-3);
    return stylus->read();
  }
};

TEST(SpaceMouse, FullDeflectionMovesAtFullSpeedAlongTheRightAxis) {
  const struct {
    Vec3 counts, direction;
  } pushes[] = {{{350, 0, 0}, {1, 0, 0}}, {{0, 350, 0}, {0, 0, 1}}, {{0, 0, 350}, {0, -1, 0}}};
  for (const bool together : {false, true}) {
    for (const auto& push : pushes) {
      Bench bench(together);
      bench.puck.deflect(push.counts);
      const Vec3 moved = bench.run(0.3).position;
      EXPECT_LT(glm::length(moved - 0.03 * push.direction), 0.6e-3);
    }
  }
}

TEST(SpaceMouse, StaysWhereItIsWhenLetGo) {
  Bench bench;
  bench.puck.deflect(Vec3(-200, 50, 100));
  bench.run(0.2);
  bench.puck.deflect(Vec3(0));
  const Vec3 there = bench.run(0.05).position;
  const Reading later = bench.run(2);
  EXPECT_EQ(later.position, there);
  EXPECT_EQ(bench.stylus->state(), State::idle) << "silence is rest";
  EXPECT_TRUE(later.fresh);
}

TEST(SpaceMouse, DoesNotDriftWhenTheReportOfItsRestIsLost) {
  Bench bench;
  bench.puck.deflect(Vec3(350, 0, 0));
  bench.run(0.2);
  bench.puck.loses_zero = true;
  bench.puck.deflect(Vec3(0));
  const Vec3 there = bench.run(0.2).position;
  EXPECT_LT(there.x, 0.04);
  EXPECT_EQ(bench.run(1).position, there);
}

TEST(SpaceMouse, ADeadZoneHidesASmallDeflection) {
  Bench bench;
  bench.puck.deflect(Vec3(27, -27, 27));
  EXPECT_EQ(bench.run(1).position, Vec3(0));
  bench.puck.deflect(Vec3(40, 0, 0));
  EXPECT_GT(bench.run(1).position.x, 0);
}

TEST(SpaceMouse, StaysInItsWorkspaceAndItsSpeed) {
  Bench bench;
  bench.puck.deflect(Vec3(32767, -32768, 0));
  EXPECT_NEAR(bench.run(0.1).position.x, 0.01, 1e-3) << "no faster than its full speed";
  EXPECT_EQ(bench.run(5).position, Vec3(0.08, 0, -0.06));
}

TEST(SpaceMouse, ReadsUpTo32Buttons) {
  Bench bench;
  bench.puck.press(0x80000005U);
  EXPECT_EQ(bench.run(0.01).buttons, 0x80000005U);
  bench.puck.press(0);
  EXPECT_EQ(bench.run(0.01).buttons, 0U);
}

TEST(SpaceMouse, OddReportsAreIgnored) {
  SpaceMouseProtocol protocol{SpaceMouseSettings{}};
  const std::array<std::uint8_t, 13> bytes{1, 0x55, 0x55, 0x55, 0x55, 0x55, 0x55};
  protocol.receive({}, 0);
  for (const std::size_t size : {1U, 2U, 6U}) protocol.receive(std::span(bytes).first(size), 0);
  std::array<std::uint8_t, 13> rotation = bytes;
  rotation[0] = 2;
  protocol.receive(std::span(rotation).first(7), 0);
  rotation[0] = 0x17;
  protocol.receive(std::span(rotation).first(2), 0);
  protocol.step(Vec3(0), 0.04, {});
  EXPECT_EQ(protocol.status().position, Vec3(0));
  protocol.receive(std::span(bytes).first(7), 0);
  protocol.step(Vec3(0), 0.08, {});
  EXPECT_NE(protocol.status().position, Vec3(0));
}

TEST(SpaceMouse, UnpluggedIsAFault) {
  Bench bench;
  bench.bench.unplugged = true;
  bench.run(0.01);
  EXPECT_EQ(bench.stylus->fault(), LinkFault::unplugged);
}

TEST(SpaceMouse, KnowsPucksFromTheMakersOtherDevices) {
  EXPECT_TRUE(is_space_mouse(0x046d, 0xc626));
  EXPECT_TRUE(is_space_mouse(0x256f, 0xc635));
  EXPECT_FALSE(is_space_mouse(0x256f, 0xc650)) << "a keyboard pad";
  EXPECT_FALSE(is_space_mouse(0x046d, 0xc52b)) << "a mouse";
}

/// By the makers' names, as lists of USB ids have them; every other product of both is none.
TEST(SpaceMouse, EveryPuckIsFoundAndNothingElse) {
  const std::map<unsigned, const char*> logitech{
      {0xc603, "SpaceMouse Plus XT"}, {0xc605, "CADman"},         {0xc606, "SpaceMouse Classic"},
      {0xc621, "SpaceBall 5000"},     {0xc623, "SpaceTraveler"},  {0xc625, "SpacePilot"},
      {0xc626, "SpaceNavigator"},     {0xc627, "SpaceExplorer"},  {0xc628, "SpaceNavigator for Notebooks"},
      {0xc629, "SpacePilot Pro"},     {0xc62b, "SpaceMouse Pro"}, {0xc640, "nulooq"}};
  const std::map<unsigned, const char*> connexion{{0xc62e, "SpaceMouse Wireless, cable"},
                                                  {0xc62f, "SpaceMouse Wireless, receiver"},
                                                  {0xc631, "SpaceMouse Pro Wireless, cable"},
                                                  {0xc632, "SpaceMouse Pro Wireless, receiver"},
                                                  {0xc633, "SpaceMouse Enterprise"},
                                                  {0xc635, "SpaceMouse Compact"},
                                                  {0xc636, "SpaceMouse Module"},
                                                  {0xc638, "SpaceMouse Pro Wireless, Bluetooth"},
                                                  {0xc63a, "SpaceMouse Wireless, Bluetooth"},
                                                  {0xc652, "Universal Receiver"}};
  for (unsigned product = 0; product < 0x10000; ++product) {
    ASSERT_EQ(is_space_mouse(0x046d, product), logitech.contains(product)) << std::hex << product;
    ASSERT_EQ(is_space_mouse(0x256f, product), connexion.contains(product)) << std::hex << product;
    ASSERT_FALSE(is_space_mouse(0x1234, product));
  }
}

/// Deflection, place and buttons are told anew; how many poses there have been is counted on.
TEST(SpaceMouse, ConnectedAgainItIsAtRest) {
  FakeHidBench bench;
  FakeSpaceMouse puck(false);
  FakeHidLink link(puck, bench);
  SpaceMouseProtocol protocol{SpaceMouseSettings{}};
  protocol.connect(link);
  const std::array<std::uint8_t, 7> right{1, 0x5e, 0x01}, button{3, 1};
  protocol.receive(right, bench.time);
  protocol.receive(std::span(button).first(3), bench.time);
  protocol.step(Vec3(0), 0.02, {});
  ASSERT_GT(protocol.status().position.x, 0);
  const std::uint64_t before = protocol.status().news;
  protocol.connect(link);
  EXPECT_EQ(protocol.status().news, before);
  protocol.step(Vec3(0), bench.time + 0.02, {});
  EXPECT_EQ(protocol.status().position, Vec3(0));
  EXPECT_EQ(protocol.status().buttons, 0U);
  EXPECT_EQ(protocol.status().news, before + 1);
}

}  // namespace
}  // namespace palpate::device

#include "device/check/axis_check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "device/falcon/falcon_driver.h"
#include "device/testing/fake_falcon_link.h"
#include "device/testing/fake_rigs.h"

namespace palpate::device {
namespace {

/// The time of a rig, in whole milliseconds of the session's.
std::function<double()> pace_of(const FakeRig& rig) {
  return [&rig] {
    const double until = rig.now() + 1e-3;
    while (rig.now() < until - 1e-9) rig.exchange();
    return rig.now();
  };
}

struct Asked {
  std::vector<int> axes;
  AxisHand hand() {
    return {.ready =
                [this](const AxisPush& push) {
                  axes.push_back(push.axis);
                  return true;
                },
            .felt = [](const AxisPush& push) { return felt_by_pose(push); },
            .home = [] {}};
  }
};

/// On every device with motors the hand goes where it was said, no force is larger than 0.2 N, and none stays.
TEST(AxisCheck, PushesEachAxisOfEachDeviceWhereItSays) {
  for (const char* const kind : rig_kinds()) {
    const FakeRig rig = make_rig(kind);
    if (!rig.type->has_force) continue;
    rig.stylus->open();
    double strongest = 0;
    const auto pace = pace_of(rig);
    const std::function<double()> watched = [&] {
      const double now = pace();
      strongest = std::max(strongest, glm::length(rig.force()));
      return now;
    };
    Asked asked;
    const AxisCheck check = check_axes(*rig.stylus, asked.hand(), watched);
    EXPECT_TRUE(check.is_right()) << kind << ": " << check.moved[0] << " " << check.moved[1] << " " << check.moved[2];
    EXPECT_EQ(asked.axes, (std::vector<int>{0, 1, 2})) << kind;
    EXPECT_GT(strongest, 0.18) << kind;
    EXPECT_LT(strongest, 0.22) << kind;
    for (int i = 0; i < 5; ++i) pace();
    EXPECT_EQ(rig.force(), Vec3(0)) << kind;
    EXPECT_EQ(rig.torques(), 0) << kind;
  }
}

/// The check of a Falcon whose driver has these signs. What the hand feels is what the fake exerts.
AxisCheck check_falcon(const AxisSigns& signs) {
  FakeFalconBench bench;
  LinkStylusOptions options;
  options.threaded = false;
  options.signs = signs;
  const auto stylus = make_falcon_on(
      {}, [&] { return std::make_unique<FakeFalconLink>(bench); }, options);
  stylus->open();
  Vec3 most(0);  // N: the strongest since the push began
  const std::function<double()> next = [&] {
    const double until = bench.time + 1e-3;
    while (bench.time < until - 1e-9) stylus->service(0.2e-3);
    if (glm::length(bench.falcon.force()) > glm::length(most)) most = bench.falcon.force();
    return bench.time;
  };
  const AxisHand hand{
      .ready =
          [&](const AxisPush&) {
            most = Vec3(0);
            return true;
          },
      .felt = [&](const AxisPush& push) { return most[push.axis] > 0 ? Felt::as_said : Felt::opposite; },
      .home = [] {}};
  return check_axes(*stylus, hand, next);
}

/// A driver that has some axes the other way round; the check finds them, and with its answer all is right.
TEST(AxisCheck, FindsAxesThatRunTheOtherWay) {
  const AxisSigns wrong_drivers[] = {{.position = Vec3(1), .force = {1, -1, 1}},
                                     {.position = {-1, 1, 1}, .force = Vec3(1)},
                                     {.position = {1, 1, -1}, .force = {1, 1, -1}}};
  for (const AxisSigns& wrong : wrong_drivers) {
    const AxisCheck found = check_falcon(wrong);
    EXPECT_FALSE(found.is_right());
    EXPECT_EQ(found.signs.force, wrong.force);
    EXPECT_EQ(found.signs.position, wrong.position);
    EXPECT_TRUE(
        check_falcon({.position = wrong.position * found.signs.position, .force = wrong.force * found.signs.force})
            .is_right());
  }
}

TEST(AxisCheck, EndsWhereTheUserSaysSoAndWhereTheStylusGoes) {
  for (const bool unplugged : {false, true}) {
    const FakeRig rig = make_rig("haply");
    rig.stylus->open();
    int pushes = 0;
    const AxisHand hand{.ready =
                            [&](const AxisPush&) {
                              if (unplugged && pushes == 1) rig.unplug();
                              return true;
                            },
                        .felt = [&](const AxisPush&) { return ++pushes == 2 ? Felt::stop : Felt::as_said; },
                        .home = [] {}};
    const AxisCheck check = check_axes(*rig.stylus, hand, pace_of(rig));
    EXPECT_FALSE(check.is_right());
    EXPECT_EQ(check.ended, !unplugged);
    EXPECT_EQ(check.fault, unplugged ? Fault::device_lost : Fault::none);
    EXPECT_EQ(pushes, unplugged ? 1 : 2);
    const std::array<Felt, 3> felt{Felt::as_said, unplugged ? Felt::nothing : Felt::stop, Felt::nothing};
    EXPECT_EQ(check.felt, felt) << "what was not pushed was not felt";
    EXPECT_EQ(rig.force(), Vec3(0));
  }
}

/// A stylus that stays in one state, and keeps the largest force that it was given.
class StayingStylus : public Stylus {
 public:
  explicit StayingStylus(State state) : state_(state) {}
  Specification specification() const override {
    return {.name = "one that stays", .maximum_force = 3, .continuous_force = 3};
  }
  void open() override {}
  void close() noexcept override {}
  Reading read() noexcept override { return {.time = time += 1e-3, .fresh = true}; }
  void write_force(const Vec3& force) noexcept override { strongest = std::max(strongest, glm::length(force)); }
  State state() const noexcept override { return state_; }

  double time = 0, strongest = 0;

 private:
  State state_;
};

TEST(AxisCheck, PushesOnlyWhatCanBePushed) {
  for (const State state :
       {State::disconnected, State::idle, State::homing, State::ramping, State::active, State::fault}) {
    StayingStylus stylus(state);
    Asked asked;
    const AxisCheck check = check_axes(stylus, asked.hand(), [&] { return stylus.time; });
    const bool can = state == State::idle || state == State::ramping || state == State::active;
    EXPECT_EQ(check.ended, !can) << name_of(state);
    EXPECT_EQ(!asked.axes.empty(), can) << name_of(state);
    if (!can) {
      const std::array<Felt, 3> nothing{Felt::nothing, Felt::nothing, Felt::nothing};
      EXPECT_EQ(check.felt, nothing) << name_of(state);
    }
    EXPECT_EQ(stylus.strongest > 0, can) << name_of(state);
  }
}

/// A rest, the push and the fall, of which the hand feels the last half of the push at its full force.
TEST(AxisCheck, EachPushLastsAsLongAsItSays) {
  StayingStylus stylus(State::idle);
  double begun = 0;
  std::vector<double> lasted;
  const AxisHand hand{.ready =
                          [&](const AxisPush&) {
                            begun = stylus.time;
                            return true;
                          },
                      .felt =
                          [&](const AxisPush&) {
                            lasted.push_back(stylus.time - begun);
                            return Felt::nothing;
                          },
                      .home = [] {}};
  check_axes(stylus, hand, [&] { return stylus.time; });
  ASSERT_EQ(lasted.size(), 3U);
  for (const double s : lasted) EXPECT_NEAR(s, 0.2 + 1.2 + 0.1, 0.01);
}

}  // namespace
}  // namespace palpate::device

/// Devices whose answers are late while the hand moves: on the fakes, which know where the hand is.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>

#include "device/falcon/falcon_driver.h"
#include "device/link/link_stylus.h"
#include "device/testing/fake_rigs.h"
#include "device/testing/falcon_bench.h"
#include "device/testing/random_faults.h"

namespace palpate::device {
namespace {

constexpr double late_ms = 1e-3;

/// Of each kind that answers packets one for one.
constexpr std::array lock_step_kinds{"falcon", "wooden_haptics", "haply", "minverse"};

/// An answer that is older than 20 ms tells nothing of now: no force is given on it, and the link tells that the device
/// is silent. From shorter delays no force is taken away for good, as long as there are enough answers.
TEST(LateAnswers, ADelayThatStaysTakesTheForceAway) {
  for (const char* const kind : lock_step_kinds) {
    for (const double delay : {22 * late_ms, 25 * late_ms, 33 * late_ms, 49 * late_ms, 80 * late_ms}) {
      FakeRig rig = make_rig(kind);
      auto& link = dynamic_cast<LinkStylus&>(*rig.stylus);
      rig.stylus->open();
      const auto push = [&](double seconds) {
        double most = 0, next = rig.now();
        for (const double end = rig.now() + seconds; rig.now() < end;) {
          rig.exchange();
          if (rig.now() < next) continue;
          next += late_ms;
          rig.stylus->write_force(Vec3(0, 2.5, 0));
          most = std::max(most, glm::length(rig.force()));
        }
        return most;
      };
      push(1.6);
      ASSERT_GT(glm::length(rig.force()), 2) << kind;
      rig.delay(delay);
      push(0.025);
      EXPECT_EQ(push(0.06), 0) << kind << ", " << delay << " s: it is asked again with a zero";
      EXPECT_EQ(push(0.5), 0) << kind << ", " << delay << " s";
      EXPECT_EQ(link.fault(), LinkFault::silent) << kind << ", " << delay << " s: " << name_of(link.fault());
    }
  }
}

/// A Falcon's reading that counts as new, and so each force, is of where its grip was less than 20 ms ago.
TEST(LateAnswers, AFalconsPoseIsOfNow) {
  int readings = 0;
  for (const double delay : {15 * late_ms, 21 * late_ms, 25 * late_ms, 30 * late_ms, 45 * late_ms, 70 * late_ms}) {
    FalconBench bench;
    bench.home();
    bench.run(0.5, Vec3(0, 2.5, 0));
    constexpr double speed = 0.6;  // m/s
    for (int n = 0; n < 40; ++n) {
      bench.fake.falcon.hand().fling(Vec3(n % 2 == 0 ? speed : -speed, 0, 0));
      bench.fake.falcon.faults.reply_delay = n % 5 == 4 ? delay : 0;
      Vec3 before = bench.fake.falcon.force();
      bench.run(0.04, [&](const Reading& reading) {
        const Vec3 grip = bench.fake.falcon.hand().body().position;
        if (reading.fresh) {
          ++readings;
          EXPECT_LT(glm::distance(reading.position, grip), speed * 21 * late_ms) << delay;
        }
        const Vec3 force = bench.fake.falcon.force();
        const double step = force == Vec3(0) ? 0 : glm::distance(force, before);
        EXPECT_LE(step, 1.05 * ceiling::slew_n_per_s * ceiling::slew_time_s) << delay;
        before = force;
        return Vec3(0, 2.5, 0);
      });
      if (bench.stylus->state() != State::fault) continue;
      bench.fake.falcon.faults.reply_delay = 0;
      bench.stylus->close();
      bench.stylus->open();
      bench.run(0.5, Vec3(0, 2.5, 0));
    }
  }
  EXPECT_GT(readings, 2000);
}

/// The sequence in which a late reply was taken for a new pose: 2.64 N at once.
TEST(LateAnswers, TheSequenceThatShowedThem) {
  EXPECT_EQ(play_random_faults(100271), "");
}

/// Replies that a Falcon still owes from the bringing up are not taken for those to what comes after.
TEST(LateAnswers, AFalconThatIsBroughtUpOwesNothing) {
  for (double delay = 5 * late_ms; delay < 48 * late_ms; delay += 1.3 * late_ms) {
    FalconBench bench;
    bench.fake.falcon.faults.reply_delay = delay;
    bench.stylus->open();
    std::array<std::uint8_t, 64> packet{};
    FakeFalconLink link(bench.fake);
    EXPECT_EQ(link.receive(packet, 0.1), 0U) << delay;
  }
}

}  // namespace
}  // namespace palpate::device

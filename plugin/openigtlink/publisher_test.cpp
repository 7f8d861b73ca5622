// Frames while the mapping between hand and patient changes.

#include "plugin/openigtlink/publisher.h"

#include <gtest/gtest.h>

#include <cmath>

#include "plugin/openigtlink/names.h"
#include "plugin/openigtlink/testing/stepped_server.h"

namespace palpate::plugin::igtl {
namespace {

modes::Workspace at_x(double mm) {
  return {.center_mm = {mm, 0, 0}};
}

/// A client of a publisher, which sends the newest tick of a ring again and again.
struct Published {
  std::shared_ptr<TickRing> ring = std::make_shared<TickRing>();
  Server server{{.port = 0}};
  testing::TestClient client{server.port()};
  std::unique_ptr<Publisher> publisher = [this] {
    write(0, 1);
    return std::make_unique<Publisher>(server, ring);
  }();

  TickRecord write(std::uint32_t epoch, double part) {
    TickRecord tick;
    tick.index = ring->written();
    tick.time_s = static_cast<double>(tick.index);
    tick.scene_epoch = epoch;
    tick.change_part = part;
    ring->push(tick, {});
    return tick;
  }
  /// The patient's x, mm, in the frames of such a tick; none: none came in that time.
  std::optional<double> x_of(std::uint32_t epoch, double part, int milliseconds = 10000) {
    const double stamp = publisher->stamp_of(write(epoch, part));
    while (const auto frame = client.next("TRANSFORM", stylus_name, milliseconds)) {
      if (std::abs(frame->time_s - stamp) < 0.01) return -transform_of(frame->content).translation.x;
    }
    return std::nullopt;
  }
  bool sends(std::uint32_t epoch, double part) { return x_of(epoch, part, 200).has_value(); }
};

TEST(Publisher, SendsThePlaceOfEachTicksScene) {
  Published published;
  EXPECT_FALSE(published.sends(3, 1)) << "its mapping is not known";
  published.publisher->set_workspace(4, at_x(1));
  EXPECT_FALSE(published.sends(3, 1)) << "of a scene before";
  EXPECT_EQ(published.x_of(4, 0.5), 1);
  published.publisher->set_workspace(5, at_x(11));
  EXPECT_EQ(published.x_of(4, 1), 1);
  EXPECT_EQ(published.x_of(5, 0.5), 6);
  EXPECT_FALSE(published.sends(6, 0.5)) << "its mapping comes next";
}

/// The session takes the newest scene: the transition is from what was felt.
TEST(Publisher, SendsNoPlaceOfASceneThatWasPassedOver) {
  Published published;
  published.publisher->set_workspace(0, at_x(0));
  EXPECT_EQ(published.x_of(0, 1), 0);
  published.publisher->set_workspace(1, at_x(50));
  published.publisher->set_workspace(2, at_x(10));
  EXPECT_EQ(published.x_of(2, 0.5), 5);
  published.publisher->set_ticks(published.ring);
  EXPECT_FALSE(published.sends(2, 1)) << "of a session before";
}

}  // namespace
}  // namespace palpate::plugin::igtl

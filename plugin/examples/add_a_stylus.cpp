// A stylus of one's own: six functions. It is read, a wall's force is computed, and the safety filter alone writes.
//
// In the tree a stylus is a folder of device/ that has its driver, and a fake of it for the tests.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "device/safety/safety_filter.h"
#include "device/stylus.h"

namespace {

namespace device = palpate::device;

/// Moves down into a wall at y = 0 by 3 mm and stays there; keeps the force that it was fed.
class Plunger : public device::Stylus {
 public:
  device::Specification specification() const override {
    return {.name = "plunger", .workspace_half_extent = {0.05, 0.05, 0.05}, .maximum_force = 2, .rate = 1000};
  }
  void open() override { state_ = device::State::idle; }
  void close() noexcept override {
    force = {};
    state_ = device::State::disconnected;
  }
  device::Reading read() noexcept override {
    time_ += 0.001;
    const double y = std::max(0.005 - 0.02 * time_, -0.003);
    return {.time = time_, .position = {0, y, 0}, .fresh = true};
  }
  void write_force(const device::Vec3& newtons) noexcept override { force = newtons; }
  device::State state() const noexcept override { return state_; }

  device::Vec3 force{0};

 private:
  double time_ = 0;
  device::State state_ = device::State::disconnected;
};

}  // namespace

int main() {
  Plunger stylus;
  stylus.open();
  device::SafetyLimits limits;
  limits.force = 1.0;  // N: the wall asks for up to 1.5
  device::SafetyState safety;
  device::arm(safety);
  double largest = 0;
  for (int tick = 0; tick < 2000; ++tick) {
    const device::Reading reading = stylus.read();
    const device::Vec3 wanted{0, 500 * std::max(0.0, -reading.position.y), 0};
    const device::SafetyResult result = device::filter_force(limits,
                                                             {.time = reading.time,
                                                              .reading = reading,
                                                              .device = stylus.state(),
                                                              .force = wanted,
                                                              .force_time = reading.time,
                                                              .heartbeat_time = reading.time},
                                                             safety);
    stylus.write_force(result.force);
    largest = std::max(largest, stylus.force.y);
  }
  std::printf("largest force %.3f N, limit %.3f N\n", largest, limits.force);
  stylus.close();
  return std::abs(largest - limits.force) < 1e-9 && stylus.force.y == 0 ? 0 : 1;
}

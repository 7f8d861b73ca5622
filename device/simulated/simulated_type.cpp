#include "device/device_type.h"
#include "device/simulated/simulated_stylus.h"

namespace palpate::device {

namespace {

std::shared_ptr<Stylus> make(const DeviceChoice& choice) {
  SimulatedDevice model;
  model.hand.tremor_seed = choice.seed;
  model.rate = choice.rate_hz;
  return std::make_shared<SimulatedStylus>(model);
}

}  // namespace

extern const DeviceType simulated_type;
const DeviceType simulated_type{
    .kind = "simulated",
    .name = "simulated stylus",
    .can = "3 axes sensed, 3 with force; simulated in software, no hardware",
    .sold = "always there",
    .tested = "every study and test",
    .watchdog = "not needed: it pushes nobody",
    .is_simulated = true,
    .make = &make,
};

}  // namespace palpate::device

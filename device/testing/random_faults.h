#pragma once

/// Random sequences of events, played on the whole chain (filter, link, fake device, the guardian's watch) in the
/// fake's own time. After every exchange the laws are checked at the device.

#include <cstdint>
#include <string>

namespace palpate::device {

/// Empty if every law holds for this seed; otherwise the violated law, and how. The seed also selects the device.
std::string play_random_faults(std::uint64_t seed);

}  // namespace palpate::device

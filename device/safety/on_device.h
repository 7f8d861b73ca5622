#pragma once

/// The force on a device, as far as it is known. The link of a stylus keeps it (link/given_force.h), and the guardian
/// reads it.

#include <cstdint>

namespace palpate::device {

enum class OnDevice : std::uint32_t {
  zero_taken,  ///< the device took a zero, and nothing else was given to it since
  pushing,     ///< a force was given, or a zero that the device has not taken yet
  unknown      ///< lost, silent or refused before it took a zero: it may still push
};

}  // namespace palpate::device

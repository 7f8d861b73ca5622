#pragma once

/// The messages sent sixty times a second: the newest tick as transforms, RAS.

#include <glm/gtc/quaternion.hpp>
#include <optional>

#include "modes/scene/workspace.h"
#include "plugin/openigtlink/contents.h"
#include "plugin/session/tick_record.h"

namespace palpate::plugin::igtl {

struct Frame {
  Transform stylus;    ///< with the rotation of the stylus, if it measures that
  Transform proxy;     ///< translation only, here and below
  Transform force;     ///< N: on the stylus
  Transform velocity;  ///< of the stylus, mm/s in the patient
  Transform buttons;   ///< the first column: 1 for each pressed one of the first three
};

/// `before`: an earlier tick, for the velocity.
Frame frame_of(const TickRecord& tick, const std::optional<TickRecord>& before, const modes::Workspace& workspace,
               const std::optional<glm::dquat>& orientation);

/// The five messages, one after the other.
Bytes wire_of(const Frame& frame, double time_s);

}  // namespace palpate::plugin::igtl

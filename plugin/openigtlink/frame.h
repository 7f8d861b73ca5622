#pragma once

/// What is sent sixty times a second: the newest tick as transforms, RAS.

#include <glm/gtc/quaternion.hpp>
#include <optional>

#include "modes/scene/workspace.h"
#include "plugin/openigtlink/contents.h"
#include "plugin/session/tick_record.h"

namespace palpate::plugin::igtl {

struct Frame {
  Transform stylus;    ///< turned as the stylus, if it senses that
  Transform proxy;     ///< translation alone, here and below
  Transform force;     ///< N: what the stylus was fed
  Transform velocity;  ///< mm/s of the patient, of the stylus
  Transform buttons;   ///< the first column: 1 for each of the first three that is pressed
};

/// `before`: an earlier tick, for the velocity.
Frame frame_of(const TickRecord& tick, const std::optional<TickRecord>& before, const modes::Workspace& workspace,
               const std::optional<glm::dquat>& orientation);

/// The five messages, one after the other.
Bytes wire_of(const Frame& frame, double time_s);

}  // namespace palpate::plugin::igtl

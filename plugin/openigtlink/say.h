#pragma once

/// The messages of this folder. A separate header, so that a new message recompiles only this folder.

#include "plugin/messages/messages_of_openigtlink.h"

namespace palpate::plugin::igtl {

/// plugin::say() with the messages of OpenIGTLink.
template <typename... Values>
Text say(std::type_identity_t<ChosenMessage<sizeof...(Values), messages::openigtlink>> message,
         const Values&... values) {
  return message.filled(values...);
}

}  // namespace palpate::plugin::igtl

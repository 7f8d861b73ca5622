#pragma once

/// What this folder says to a user. A header of its own, so that a new message of it does not compile all of plugin.

#include "plugin/messages/messages_of_openigtlink.h"

namespace palpate::plugin::igtl {

/// As plugin::say(), of the table of OpenIGTLink.
template <typename... Values>
Text say(std::type_identity_t<ChosenMessage<sizeof...(Values), messages::openigtlink>> message,
         const Values&... values) {
  return message.filled(values...);
}

}  // namespace palpate::plugin::igtl

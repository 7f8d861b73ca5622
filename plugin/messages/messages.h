#pragma once

/// The messages of plugin to the user.

#include "plugin/messages/messages_of_balances.h"
#include "plugin/messages/messages_of_choices.h"
#include "plugin/messages/messages_of_kept_archives.h"
#include "plugin/messages/messages_of_paraview.h"
#include "plugin/messages/messages_of_scene_structures.h"
#include "plugin/messages/messages_of_sessions.h"
#include "solver/text/message.h"

namespace palpate::plugin {

/// The message with this id, with these values in place of its {}.
template <typename... Values>
Text say(std::type_identity_t<
             ChosenMessage<sizeof...(Values), messages::kept_archives, messages::balances, messages::paraview,
                           messages::choices, messages::sessions, messages::scene_structures>>
             message,
         const Values&... values) {
  return message.filled(values...);
}

}  // namespace palpate::plugin

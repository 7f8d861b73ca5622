#pragma once

/// The messages of io to the user.

#include "io/archive/messages_of_archives.h"
#include "io/dicom/messages_of_series.h"
#include "io/structures/messages_of_structures.h"
#include "solver/text/message.h"

namespace palpate::io {

/// The message with this id, with these values in place of its {}.
template <typename... Values>
Text say(
    std::type_identity_t<ChosenMessage<sizeof...(Values), messages::archives, messages::series, messages::structures>>
        message,
    const Values&... values) {
  return message.filled(values...);
}

}  // namespace palpate::io

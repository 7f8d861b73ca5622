#pragma once

/// Off - Ready - Feeling - Stopped: what the stylus does, in one line.

#include <QString>

namespace palpate::plugin {

struct SessionStatus;

enum class SessionState {
  off,      ///< no stylus is connected
  ready,    ///< connected, without a force until *Feel*
  feeling,  ///< forces are on, or coming up
  stopped   ///< the force was taken away, and is kept away: the words say why, and what to do
};

struct StateLine {
  SessionState state = SessionState::off;
  QString words;               ///< begins with the state's name
  bool fault_latched = false;  ///< which the user's hand has to clear
  bool lost = false;           ///< the stylus has to be opened again
};

StateLine state_line_of(const SessionStatus& look);

}  // namespace palpate::plugin

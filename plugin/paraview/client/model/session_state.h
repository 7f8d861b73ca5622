#pragma once

/// The state of the stylus: Off, Ready, Feeling or Stopped, in one line.

#include <QString>

namespace palpate::plugin {

struct SessionStatus;
struct TickRecord;

enum class SessionState {
  off,      ///< no stylus is connected
  ready,    ///< connected, without a force until *Feel*
  feeling,  ///< forces are on, or being ramped up
  stopped   ///< the force was removed and stays off: the words give the reason and the remedy
};

struct StateLine {
  SessionState state = SessionState::off;
  QString words;               ///< begins with the state's name
  bool fault_latched = false;  ///< a fault that the user has to clear
  bool lost = false;           ///< the stylus has to be opened again

  bool needs_clearing() const { return fault_latched || lost; }  ///< before a force can be felt
};

StateLine state_line_of(const SessionStatus& look);

/// Whether the stylus gives no pose and takes no force in this tick: it has to be opened again.
bool is_lost(const TickRecord& tick);

}  // namespace palpate::plugin

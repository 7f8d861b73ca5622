#pragma once

/// The mapping between hand and patient, including its transition after a change.

#include <utility>

#include "modes/scene/workspace.h"

namespace palpate::plugin {

class FeltWorkspace {
 public:
  /// Without a transition.
  void set(const modes::Workspace& workspace) { before_ = now_ = workspace; }
  /// Starts the transition to another workspace; returns whether it differs.
  bool change_to(const modes::Workspace& workspace) {
    before_ = std::exchange(now_, workspace);
    return before_ != now_;
  }
  /// Ends the transition.
  void skip_change() { before_ = now_; }
  const modes::Workspace& now() const { return now_; }
  /// During the transition. `part`: TickRecord::change_part.
  modes::Workspace at(double part) const { return modes::between(before_, now_, part); }

 private:
  modes::Workspace before_, now_;
};

}  // namespace palpate::plugin

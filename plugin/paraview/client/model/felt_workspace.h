#pragma once

/// Where hand and patient lie to each other: as the scene has it, and on the way there from the one before.

#include <utility>

#include "modes/scene/workspace.h"

namespace palpate::plugin {

class FeltWorkspace {
 public:
  /// At once.
  void set(const modes::Workspace& workspace) { before_ = now_ = workspace; }
  /// On the way from the present one; whether it is another.
  bool change_to(const modes::Workspace& workspace) {
    before_ = std::exchange(now_, workspace);
    return before_ != now_;
  }
  /// Nothing is shown on its way.
  void skip_change() { before_ = now_; }
  const modes::Workspace& now() const { return now_; }
  /// `part`: TickRecord::change_part.
  modes::Workspace at(double part) const { return modes::between(before_, now_, part); }

 private:
  modes::Workspace before_, now_;
};

}  // namespace palpate::plugin

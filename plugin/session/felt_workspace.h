#pragma once

/// The mapping between hand and patient of each tick, including the transition after a change.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <utility>

#include "modes/scene/workspace.h"
#include "plugin/session/tick_record.h"

namespace palpate::plugin {

class FeltWorkspace {
 public:
  /// Of a session that begins, or where there is none.
  void set(const modes::Workspace& workspace) {
    kept_ = {{0, workspace}};
    before_ = felt_ = workspace;
    epoch_ = 0;
  }
  /// Another one, for ticks from this epoch on; returns whether it differs.
  bool change_to(const modes::Workspace& workspace, std::uint32_t epoch) {
    const bool differs = now() != workspace;
    kept_.emplace_back(epoch, workspace);
    if (kept_.size() > most_kept) kept_.pop_front();
    return differs;
  }
  /// The newest one.
  const modes::Workspace& now() const { return kept_.back().second; }
  /// That of a tick. To be called in the order of the ticks.
  modes::Workspace at(const TickRecord& tick) {
    if (tick.scene_epoch != epoch_) {
      epoch_ = tick.scene_epoch;
      before_ = std::exchange(felt_, of_epoch(epoch_));
    }
    return modes::between(before_, felt_, tick.change_part);
  }

 private:
  static constexpr std::size_t most_kept = 8;

  const modes::Workspace& of_epoch(std::uint32_t epoch) const {
    std::size_t n = kept_.size() - 1;
    while (n > 0 && kept_[n].first > epoch) --n;
    return kept_[n].second;
  }

  std::deque<std::pair<std::uint32_t, modes::Workspace>> kept_{{0, {}}};
  modes::Workspace before_, felt_;
  std::uint32_t epoch_ = 0;
};

}  // namespace palpate::plugin

#pragma once

/// A mode as a control shows it. A change may wait for files that are read, and the scene may be another one when its
/// turn comes.

#include <algorithm>
#include <cstddef>
#include <tuple>

#include "modes/scene/scene.h"
#include "plugin/messages/messages.h"

namespace palpate::plugin {

class ShownMode {
 public:
  /// `n`: a mode of the scene.
  ShownMode(const modes::Scene& scene, std::size_t n) : n_(n), mode_(scene.modes.at(n)) {}

  /// Its number in a later scene. Throws Refusal if the scene has it no longer, or more than once at other places.
  std::size_t in(const modes::Scene& scene) const {
    const auto& modes = scene.modes;
    if (n_ < modes.size() && is_it(modes[n_])) return n_;
    const auto same = [this](const modes::Mode& mode) { return is_it(mode); };
    if (std::ranges::count_if(modes, same) != 1) {
      throw Refusal(say("boundary-is-another-one", mode_.name.empty() ? mode_.type : mode_.name));
    }
    return static_cast<std::size_t>(std::ranges::find_if(modes, same) - modes.begin());
  }

 private:
  bool is_it(const modes::Mode& mode) const {
    const auto of = [](const modes::Mode& m) { return std::tie(m.type, m.name, m.structure, m.from, m.to); };
    return of(mode) == of(mode_);
  }

  std::size_t n_;
  modes::Mode mode_;
};

}  // namespace palpate::plugin

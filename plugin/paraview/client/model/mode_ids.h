#pragma once

/// A number for each mode of a scene, which the mode keeps while the scene is edited.

#include <cstddef>
#include <optional>
#include <vector>

#include "modes/scene/scene.h"

namespace palpate::plugin {

class ModeIds {
 public:
  /// The scene was replaced by another one. If the name of the scene and the count of its modes are unchanged, the
  /// modes at the same places keep their numbers. Otherwise modes are matched by their contents, and a mode that cannot
  /// be distinguished from another one gets a new number.
  void follow(const modes::Scene& before, const modes::Scene& after);
  unsigned at(std::size_t mode) const { return ids_.at(mode); }
  /// None: the scene has it no longer.
  std::optional<std::size_t> place_of(unsigned id) const;

 private:
  std::vector<unsigned> ids_;
  unsigned next_ = 0;
};

}  // namespace palpate::plugin

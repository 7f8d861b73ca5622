#include "plugin/paraview/client/model/mode_ids.h"

#include <algorithm>
#include <string>
#include <tuple>

#include "modes/scene/scene_json.h"

namespace palpate::plugin {
namespace {

auto what_is(const modes::Mode& mode) {
  return std::tie(mode.type, mode.name, mode.structure, mode.from, mode.to);
}

/// With all its values. What has neither a name nor a place of its own is told from others by these.
std::string text_of(const modes::Mode& mode) {
  modes::Scene scene;
  scene.modes = {mode};
  return modes::to_json(scene);
}

using Modes = std::vector<modes::Mode>;

/// The place before of the only mode after that `is_it`; none if there are several, before or after.
template <typename Is>
std::optional<std::size_t> only(const Modes& before, const Modes& after, const Is& is_it) {
  if (std::ranges::count_if(before, is_it) != 1 || std::ranges::count_if(after, is_it) != 1) return std::nullopt;
  return static_cast<std::size_t>(std::ranges::find_if(before, is_it) - before.begin());
}

/// The place of after[n] before; none if it is new, or cannot be told from another one.
std::optional<std::size_t> place_before(const Modes& before, const Modes& after, std::size_t n) {
  const auto same = [&](const modes::Mode& mode) { return what_is(mode) == what_is(after[n]); };
  if (const auto place = only(before, after, same)) return place;
  return only(before, after, [text = text_of(after[n])](const modes::Mode& mode) { return text_of(mode) == text; });
}

}  // namespace

void ModeIds::follow(const modes::Scene& before, const modes::Scene& after) {
  if (before.modes.size() == after.modes.size() && before.name == after.name) return;
  std::vector<unsigned> ids;
  for (std::size_t n = 0; n < after.modes.size(); ++n) {
    const auto was = place_before(before.modes, after.modes, n);
    ids.push_back(was ? ids_[*was] : next_++);
  }
  ids_ = ids;
}

std::optional<std::size_t> ModeIds::place_of(unsigned id) const {
  const auto found = std::ranges::find(ids_, id);
  return found == ids_.end() ? std::nullopt : std::optional(static_cast<std::size_t>(found - ids_.begin()));
}

}  // namespace palpate::plugin

#pragma once

/// The starting scenes: the files of modes/scene/starting as text, by name.

#include <span>
#include <string_view>
#include <utility>

namespace palpate::modes {

std::span<const std::pair<std::string_view, std::string_view>> embedded_scenes();

}  // namespace palpate::modes

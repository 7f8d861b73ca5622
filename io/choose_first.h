#pragma once

/// Which of many series to feel first.

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "io/series.h"

namespace palpate::io {

struct FirstChoice {
  std::size_t index = 0;
  std::string why;  ///< "slices of 1.00 mm, soft kernel B30f, 512 slices"
};

/// The volume with most to feel. First CT and MR as acquired, before computed or lossy images; then thin slices; then a
/// kernel for soft tissue, because the noise of a sharp one is felt as roughness; then most slices. Nothing if no
/// series is usable.
std::optional<FirstChoice> choose_first(std::span<const Series> series);

/// Whether a reconstruction kernel sharpens, by the makers' names: Siemens' numbers from 60 on, Canon's FC 30, 50 and
/// 80 and on, words such as BONE and LUNG.
bool is_sharp(const std::string& kernel);

}  // namespace palpate::io

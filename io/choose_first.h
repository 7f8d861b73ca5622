#pragma once

/// Chooses the series to feel first.

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

/// The most suitable volume, or nothing if no series is usable. The order is: CT and MR as acquired, before computed or
/// lossy images; then thin slices; then a soft-tissue kernel, because the noise of a sharp one is felt as roughness;
/// then the number of slices.
std::optional<FirstChoice> choose_first(std::span<const Series> series);

/// Whether a reconstruction kernel sharpens, by the manufacturers' names: Siemens' numbers from 60 on, Canon's FC 30,
/// FC 50 and from FC 80 on, and words such as BONE and LUNG.
bool is_sharp(const std::string& kernel);

}  // namespace palpate::io

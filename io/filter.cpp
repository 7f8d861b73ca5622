#include "io/filter.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "io/messages.h"

namespace palpate::io {

// The list of filters comes from io/CMakeLists.txt: FILTER(gaussian) FILTER(median) ...
#define FILTER(name) extern const FilterType name##_filter;
PALPATE_FILTERS
#undef FILTER

std::span<const FilterType* const> filter_types() {
#define FILTER(name) &name##_filter,
  static constexpr std::array types{PALPATE_FILTERS};
#undef FILTER
  return types;
}

const FilterType* find_filter_type(std::string_view name) {
  const auto types = filter_types();
  const auto found = std::ranges::find(types, name, &FilterType::name);
  return found == types.end() ? nullptr : *found;
}

bool Filter::operator==(const Filter& other) const noexcept {
  if (type != other.type || type == nullptr) return type == other.type;
  return (!type->reads_sigma_mm || sigma_mm == other.sigma_mm) && (!type->reads_width || width == other.width) &&
         (!type->reads_sigma_value || sigma_value == other.sigma_value);
}

std::string in_words(const Filter& filter) {
  return filter.type == nullptr ? "no filter" : filter.type->in_words(filter);
}

void validate(const Filter& filter) {
  constexpr double least_sigma_mm = 0.1, most_sigma_mm = 10;
  if (filter.type == nullptr) return;
  if (filter.type->reads_sigma_mm && !(filter.sigma_mm >= least_sigma_mm && filter.sigma_mm <= most_sigma_mm)) {
    throw InvalidInput(say("filter-width-in-mm", fmt::format("{}", filter.sigma_mm), fmt::format("{}", least_sigma_mm),
                           fmt::format("{}", most_sigma_mm)));
  }
  if (filter.type->reads_sigma_value && !(filter.sigma_value > 0 && filter.sigma_value <= 1e5)) {
    throw InvalidInput(say("filter-difference-of-values", fmt::format("{}", filter.sigma_value)));
  }
  if (filter.type->reads_width && filter.width != 3 && filter.width != 5) {
    throw InvalidInput(say("filter-width-in-voxels", filter.width));
  }
}

}  // namespace palpate::io

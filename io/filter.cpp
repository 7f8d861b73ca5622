#include "io/filter.h"

#include <fmt/format.h>

#include <stdexcept>

#include "io/messages.h"

namespace palpate::io {
namespace {

constexpr double least_sigma_mm = 0.1, most_sigma_mm = 10;

}  // namespace

bool Filter::operator==(const Filter& other) const noexcept {
  return type == other.type && (!reads_sigma_mm(type) || sigma_mm == other.sigma_mm) &&
         (!reads_sigma_value(type) || sigma_value == other.sigma_value) &&
         (type != FilterType::median || width == other.width);
}

std::string in_words(const Filter& filter) {
  switch (filter.type) {
    case FilterType::gaussian:
      return fmt::format("Gaussian filter of {:.3g} mm", filter.sigma_mm);
    case FilterType::median:
      return fmt::format("median filter of {0} x {0} voxels", filter.width);
    case FilterType::bilateral:
      return fmt::format("bilateral filter of {:.3g} mm and {:.3g}", filter.sigma_mm, filter.sigma_value);
    case FilterType::non_local_means:
      return fmt::format("non-local means filter of {:.3g}", filter.sigma_value);
    case FilterType::none:
      break;
  }
  return "no filter";
}

void validate(const Filter& filter) {
  if (reads_sigma_mm(filter.type) && !(filter.sigma_mm >= least_sigma_mm && filter.sigma_mm <= most_sigma_mm)) {
    throw InvalidInput(say("filter-width-in-mm", fmt::format("{}", filter.sigma_mm), fmt::format("{}", least_sigma_mm),
                           fmt::format("{}", most_sigma_mm)));
  }
  if (reads_sigma_value(filter.type) && !(filter.sigma_value > 0 && filter.sigma_value <= 1e5)) {
    throw InvalidInput(say("filter-difference-of-values", fmt::format("{}", filter.sigma_value)));
  }
  if (filter.type == FilterType::median && filter.width != 3 && filter.width != 5) {
    throw InvalidInput(say("filter-width-in-voxels", filter.width));
  }
}

}  // namespace palpate::io

#include "modes/scene/felt_strength.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <variant>

#include "io/for_processor.h"

namespace palpate::modes {
namespace {

/// Few voxels at a time stay in the nearest cache, and are often all of one tissue.
struct Row {
  std::array<double, Strength::most_at_once> values, magnitudes, sums;
};

void read_values(const io::Volume& volume, std::size_t offset, std::span<double> values) {
  const double slope = volume.slope, intercept = volume.intercept;
  const auto read = [&](const auto& voxels) {
    const auto* const stored = voxels.data() + offset;
    for (std::size_t n = 0; n < values.size(); ++n) {
      values[n] = slope * static_cast<double>(stored[n]) + intercept;
    }
  };
  std::visit(read, volume.voxels);
}

/// As glm::length() of a vector of doubles.
PALPATE_FOR_PROCESSOR
void measure(const glm::vec3* gradients, std::size_t count, double* magnitudes) {
  PALPATE_INDEPENDENT
  for (std::size_t n = 0; n < count; ++n) {
    const double x = gradients[n].x, y = gradients[n].y, z = gradients[n].z;
    magnitudes[n] = std::sqrt(x * x + y * y + z * z);
  }
}

PALPATE_FOR_PROCESSOR
void store(const double* sums, std::size_t count, float* felt) {
  PALPATE_INDEPENDENT
  for (std::size_t n = 0; n < count; ++n) felt[n] = static_cast<float>(sums[n]);
}

}  // namespace

std::vector<const ActiveMode*> holding_modes(const Plan& plan) {
  std::vector<const ActiveMode*> holding;
  for (const ActiveMode& mode : plan.modes) {
    if (mode.holds && mode.structure < 0) holding.push_back(&mode);
  }
  return holding;
}

void FeltStrength::at_row(const glm::ivec3& first, std::span<const glm::vec3> gradients, std::span<float> felt) const {
  Row row;
  for (std::size_t begin = 0; begin < gradients.size(); begin += Strength::most_at_once) {
    const std::size_t count = std::min(Strength::most_at_once, gradients.size() - begin);
    const std::span values = std::span(row.values).first(count);
    const std::span magnitudes = std::span(row.magnitudes).first(count);
    const std::span sums = std::span(row.sums).first(count);
    const int i = first.x + static_cast<int>(begin);
    read_values(volume_, volume_.offset(i, first.y, first.z), values);
    measure(gradients.data() + begin, count, magnitudes.data());
    std::ranges::fill(sums, 0.0);
    for (const ActiveMode* mode : modes_) mode->strength.add_to(values, magnitudes, sums);
    store(sums.data(), count, felt.data() + begin);
    for (std::size_t n = 0; volume_.padding && n < count; ++n) {
      if (volume_.is_padding(i + static_cast<int>(n), first.y, first.z)) felt[begin + n] = 0;
    }
  }
}

}  // namespace palpate::modes

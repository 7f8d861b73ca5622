#include "modes/scene/felt_strength.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <variant>

#include "io/for_processor.h"

namespace palpate::modes {
namespace {

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

bool reads_low_high(const ActiveMode* mode) {
  return io::contains(mode->strength.reads(), io::FieldSet::low_high);
}

}  // namespace

std::vector<const ActiveMode*> holding_modes(const Plan& plan) {
  std::vector<const ActiveMode*> holding;
  for (const ActiveMode& mode : plan.modes) {
    if (mode.holds && mode.structure < 0) holding.push_back(&mode);
  }
  return holding;
}

/// Few voxels at a time stay in the nearest cache, and are often all of one tissue.
struct FeltStrength::Row {
  std::size_t count = 0;
  std::array<double, Strength::most_at_once> values, magnitudes, sums;

  std::span<double> of(std::array<double, Strength::most_at_once>& all) const { return std::span(all).first(count); }
};

FeltStrength::FeltStrength(const io::Volume& volume, std::span<const ActiveMode* const> modes, io::ValueMethod value,
                           double scale_mm)
    : volume_(volume),
      modes_(modes),
      reads_low_high_(std::ranges::any_of(modes, reads_low_high)),
      voxels_(volume, value, scale_mm) {}

void FeltStrength::at_row(const glm::ivec3& first, std::span<const glm::vec3> gradients, std::span<float> felt) const {
  Row row;
  for (std::size_t begin = 0; begin < gradients.size(); begin += Strength::most_at_once) {
    row.count = std::min(Strength::most_at_once, gradients.size() - begin);
    const glm::ivec3 here(first.x + static_cast<int>(begin), first.y, first.z);
    measure(gradients.data() + begin, row.count, row.magnitudes.data());
    std::ranges::fill(row.of(row.sums), 0.0);
    if (reads_low_high_) {
      sample_and_add_up(here, gradients.subspan(begin, row.count), row);
    } else {
      add_up(here, row);
    }
    store(row.sums.data(), row.count, felt.data() + begin);
  }
}

void FeltStrength::add_up(const glm::ivec3& first, Row& row) const {
  read_values(volume_, volume_.offset(first.x, first.y, first.z), row.of(row.values));
  for (const ActiveMode* mode : modes_) {
    mode->strength.add_to(row.of(row.values), row.of(row.magnitudes), row.of(row.sums));
  }
  for (std::size_t n = 0; volume_.padding && n < row.count; ++n) {
    if (volume_.is_padding(first.x + static_cast<int>(n), first.y, first.z)) row.sums[n] = 0;
  }
}

/// Those of the wanted voxels that have a value.
FeltStrength::Bits FeltStrength::sample_values(const glm::ivec3& first, Bits wanted, Row& row) const {
  Bits inside = 0;
  for (Bits left = wanted; left != 0; left &= left - 1) {
    const int n = std::countr_zero(left);
    if (const auto value = voxels_.value(first + glm::ivec3(n, 0, 0))) {
      row.values[static_cast<std::size_t>(n)] = *value;
      inside |= Bits{1} << n;
    }
  }
  return inside;
}

void FeltStrength::sample_and_add_up(const glm::ivec3& first, std::span<const glm::vec3> gradients, Row& row) const {
  const Bits all = ~Bits{0} >> (Strength::most_at_once - row.count);
  Bits steep = 0;
  for (const ActiveMode* mode : modes_) {
    steep |= mode->strength.not_zero(Datum::gradient_magnitude, row.of(row.magnitudes), all & ~steep);
  }
  const Bits inside = sample_values(first, steep, row);
  Bits felt = 0, between_tissues = 0;
  for (const ActiveMode* mode : modes_) {
    const Bits of_mode = mode->strength.not_zero(Datum::gradient_magnitude, row.of(row.magnitudes),
                                                 mode->strength.not_zero(Datum::value, row.of(row.values), inside));
    felt |= of_mode;
    if (reads_low_high(mode)) between_tissues |= of_mode;
  }
  for (Bits left = felt; left != 0; left &= left - 1) {
    const int n = std::countr_zero(left);
    const auto at = static_cast<std::size_t>(n);
    io::Sample sample;
    sample.value = row.values[at];
    sample.gradient = gradients[at];
    if ((between_tissues >> n & 1) != 0) {
      const io::LowHigh sides = voxels_.low_high(first + glm::ivec3(n, 0, 0), gradients[at]);
      sample.low = sides.low;
      sample.high = sides.high;
    }
    for (const ActiveMode* mode : modes_) row.sums[at] += mode->strength(sample);
  }
}

}  // namespace palpate::modes

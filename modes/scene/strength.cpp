#include "modes/scene/strength.h"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>

namespace palpate::modes {

double datum_of(const io::Sample& sample, Datum datum, std::size_t structure) noexcept {
  switch (datum) {
    case Datum::value:
      return sample.value;
    case Datum::gradient_magnitude:
      return glm::length(sample.gradient);
    case Datum::vector_magnitude:
      return glm::length(sample.vector);
    case Datum::low:
      return sample.low;
    case Datum::high:
      return sample.high;
    case Datum::distance:
      return sample.distance[structure].mm;
  }
  return 0.0;
}

io::FieldSet field_of(Datum datum) noexcept {
  switch (datum) {
    case Datum::value:
      return io::FieldSet::value;
    case Datum::gradient_magnitude:
      return io::FieldSet::gradient;
    case Datum::vector_magnitude:
      return io::FieldSet::vector;
    case Datum::low:
    case Datum::high:
      return io::FieldSet::low_high;
    case Datum::distance:
      return io::FieldSet::distance;
  }
  return io::FieldSet::none;
}

void Strength::add(Datum of, std::size_t structure, const TransferFunction& function) {
  // A constant needs no datum: the field is not sampled for it.
  const bool constant = function.nodes().size() <= 1 || function.minimum() == function.maximum();
  factors_.push_back({of, structure, StrengthTable(function), constant ? io::FieldSet::none : field_of(of)});
  most_n_ *= function.maximum();
}

Strength::Strength(Datum of, const TransferFunction& newtons, const std::vector<Gate>& gates) : most_n_(1) {
  add(of, 0, newtons);
  for (const Gate& gate : gates) {
    add(gate.of, 0, gate.factor);
  }
}

Strength::Strength(const Mode& mode, const std::function<std::size_t(const std::string&)>& index_of) : most_n_(1) {
  const auto index = [&](Datum of, const std::string& name) {
    return of == Datum::distance ? index_of(name) : std::size_t{0};
  };
  add(mode.strength_of, index(mode.strength_of, mode.strength_structure), mode.strength_n);
  for (const Gate& gate : mode.gates) {
    add(gate.of, index(gate.of, gate.structure), gate.factor);
  }
}

double Strength::operator()(const io::Sample& sample) const noexcept {
  if (factors_.empty()) {
    return 0.0;
  }
  double product = 1.0;
  for (const Factor& factor : factors_) {
    product *= factor.table(datum_of(sample, factor.of, factor.structure));
  }
  return product;
}

void Strength::add_to(std::span<const double> values, std::span<const double> magnitudes,
                      std::span<double> sums) const noexcept {
  if (factors_.empty()) return;
  std::array<double, most_at_once> all;
  const std::span products = std::span(all).first(sums.size());
  std::ranges::fill(products, 1.0);
  for (const Factor& factor : factors_) {
    // Most voxels are no boundary: what is zero stays zero.
    if (!factor.table.multiply(factor.of == Datum::value ? values : magnitudes, products)) return;
  }
  for (std::size_t n = 0; n < sums.size(); ++n) sums[n] += products[n];
}

std::uint64_t Strength::not_zero(Datum of, std::span<const double> data, std::uint64_t bits) const noexcept {
  for (const Factor& factor : factors_) {
    if (factor.of == of) bits = factor.table.not_zero(data, bits);
  }
  return factors_.empty() ? 0 : bits;
}

io::FieldSet Strength::reads() const noexcept {
  io::FieldSet fields = io::FieldSet::none;
  for (const Factor& factor : factors_) {
    fields = fields | factor.reads;
  }
  return fields;
}

}  // namespace palpate::modes

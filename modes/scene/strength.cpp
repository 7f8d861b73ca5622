#include "modes/scene/strength.h"

#include <glm/geometric.hpp>

namespace palpate::modes {

double datum_of(const io::Sample& sample, Datum datum) noexcept {
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
  }
  return io::FieldSet::none;
}

Strength::Strength(Datum of, const TransferFunction& newtons, const std::vector<Gate>& gates) {
  const auto add = [this](Datum datum, const TransferFunction& function) {
    // A constant needs no datum: the field is not sampled for it.
    const bool constant = function.nodes().size() <= 1 || function.minimum() == function.maximum();
    factors_.push_back({datum, StrengthTable(function), constant ? io::FieldSet::none : field_of(datum)});
  };
  add(of, newtons);
  most_n_ = newtons.maximum();
  for (const Gate& gate : gates) {
    add(gate.of, gate.factor);
    most_n_ *= gate.factor.maximum();
  }
}

double Strength::operator()(const io::Sample& sample) const noexcept {
  if (factors_.empty()) {
    return 0.0;
  }
  double product = 1.0;
  for (const Factor& factor : factors_) {
    product *= factor.table(datum_of(sample, factor.of));
  }
  return product;
}

io::FieldSet Strength::reads() const noexcept {
  io::FieldSet fields = io::FieldSet::none;
  for (const Factor& factor : factors_) {
    fields = fields | factor.reads;
  }
  return fields;
}

}  // namespace palpate::modes

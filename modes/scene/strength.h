#pragma once

/// A mode's strength in the form for the tick: the product of a transfer function and its gates, looked up in tables.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "io/fields/field_source.h"
#include "modes/scene/scene.h"
#include "modes/scene/strength_table.h"

namespace palpate::modes {

/// The datum of a sample; for a distance, that of `structure`. In the tick.
double datum_of(const io::Sample& sample, Datum datum, std::size_t structure) noexcept;
/// The field that a datum is part of.
io::FieldSet field_of(Datum datum) noexcept;

class Strength {
 public:
  Strength() = default;
  Strength(Datum of, const TransferFunction& newtons, const std::vector<Gate>& gates);
  /// For modes that read distances: `index_of` gives a structure's index in Sample::distance by its name.
  Strength(const Mode& mode, const std::function<std::size_t(const std::string&)>& index_of);

  /// N, >= 0. In the tick.
  double operator()(const io::Sample& sample) const noexcept;
  static constexpr std::size_t most_at_once = 64;
  /// Adds the strengths of many samples, at most most_at_once, with the same bits. It must read only value and
  /// gradient.
  void add_to(std::span<const double> values, std::span<const double> magnitudes,
              std::span<double> sums) const noexcept;
  /// Returns `bits` without those of the samples at which a factor of that datum is zero. The lowest bit is the first
  /// sample's. `data`: the datum of each sample; at most most_at_once of them.
  std::uint64_t not_zero(Datum of, std::span<const double> data, std::uint64_t bits) const noexcept;
  /// The fields that operator() reads.
  io::FieldSet reads() const noexcept;
  /// N: the strength is never above this.
  double most_n() const noexcept { return most_n_; }

 private:
  struct Factor {
    Datum of = Datum::value;
    std::size_t structure = 0;
    StrengthTable table;
    io::FieldSet reads = io::FieldSet::none;
  };
  void add(Datum of, std::size_t structure, const TransferFunction& function);

  std::vector<Factor> factors_;
  double most_n_ = 0;
};

}  // namespace palpate::modes

#pragma once

/// Numbers in messages and names: "-2", "0.25", "nan".

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>

namespace palpate::modes {

inline std::string number_text(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

/// The nearest multiple of 10^exponent. Correctly rounded, so that it is written with no more digits than that.
inline double rounded_to(double value, int exponent) {
  const double power = std::pow(10.0, std::abs(exponent));
  return (exponent < 0 ? std::round(value * power) / power : std::round(value / power) * power) + 0.0;
}

/// A value among others that span `range`: whole, or rounded to a hundredth of the range if that is less than 1.
inline std::string number_text(double value, double range) {
  return number_text(rounded_to(value, std::min(0, static_cast<int>(std::floor(std::log10(range))) - 2)));
}

}  // namespace palpate::modes

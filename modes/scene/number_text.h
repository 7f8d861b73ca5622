#pragma once

/// Numbers in messages: "-2", "0.25", "nan".

#include <array>
#include <charconv>
#include <string>

namespace palpate::modes {

inline std::string number_text(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

}  // namespace palpate::modes

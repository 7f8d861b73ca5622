#include "io/fields/padded_rows.h"

#include <bit>

#include "io/for_processor.h"

namespace palpate::io::internal {
namespace {

template <typename Stored>
[[gnu::always_inline]] inline void all_to_floats(const Stored* __restrict stored, int count, float* __restrict values) {
  PALPATE_INDEPENDENT
  for (int n = 0; n < count; ++n) values[n] = static_cast<float>(stored[n]);
}

/// write(n, stored, is_padding) for each; whether any is padding.
template <typename Stored, typename Out, typename Of>
[[gnu::always_inline]] inline bool each_stored(const Stored* __restrict stored, int count,
                                               const StoredPadding<Stored>& given, Out* __restrict out, const Of& of) {
  const StoredPadding<Stored> padding = given;
  std::uint32_t any = 0;
  PALPATE_INDEPENDENT
  for (int n = 0; n < count; ++n) {
    const std::uint32_t is_padding = padding(stored[n]);
    any |= is_padding;
    out[n] = of(stored[n], is_padding);
  }
  return any != 0;
}

/// By bits: 0 times what is not a number would not be 0.
constexpr auto value_of = [](auto stored, std::uint32_t is_padding) __attribute__((always_inline)) {
  return std::bit_cast<float>(std::bit_cast<std::uint32_t>(static_cast<float>(stored)) & (is_padding - 1));
};
constexpr auto weight_of = [](auto, std::uint32_t is_padding) __attribute__((always_inline)) {
  return static_cast<float>(static_cast<std::int32_t>(1 - is_padding));
};
constexpr auto mark_of = [](auto, std::uint32_t is_padding) __attribute__((always_inline)) {
  return static_cast<std::uint8_t>(is_padding);
};

}  // namespace

PALPATE_FOR_PROCESSOR
void to_floats(const std::int16_t* stored, int count, float* values) {
  all_to_floats(stored, count, values);
}

PALPATE_FOR_PROCESSOR
void to_floats(const std::uint16_t* stored, int count, float* values) {
  all_to_floats(stored, count, values);
}

PALPATE_FOR_PROCESSOR
bool to_floats(const std::int16_t* stored, int count, const StoredPadding<std::int16_t>& padding, float* values) {
  return each_stored(stored, count, padding, values, value_of);
}

PALPATE_FOR_PROCESSOR
bool to_floats(const std::uint16_t* stored, int count, const StoredPadding<std::uint16_t>& padding, float* values) {
  return each_stored(stored, count, padding, values, value_of);
}

PALPATE_FOR_PROCESSOR
bool to_floats(const float* stored, int count, const StoredPadding<float>& padding, float* values) {
  return each_stored(stored, count, padding, values, value_of);
}

PALPATE_FOR_PROCESSOR
bool to_weights(const std::int16_t* stored, int count, const StoredPadding<std::int16_t>& padding, float* weights) {
  return each_stored(stored, count, padding, weights, weight_of);
}

PALPATE_FOR_PROCESSOR
bool to_weights(const std::uint16_t* stored, int count, const StoredPadding<std::uint16_t>& padding, float* weights) {
  return each_stored(stored, count, padding, weights, weight_of);
}

PALPATE_FOR_PROCESSOR
bool to_weights(const float* stored, int count, const StoredPadding<float>& padding, float* weights) {
  return each_stored(stored, count, padding, weights, weight_of);
}

PALPATE_FOR_PROCESSOR
bool mark_padding(const std::int16_t* stored, int count, const StoredPadding<std::int16_t>& padding,
                  std::uint8_t* marks) {
  return each_stored(stored, count, padding, marks, mark_of);
}

PALPATE_FOR_PROCESSOR
bool mark_padding(const std::uint16_t* stored, int count, const StoredPadding<std::uint16_t>& padding,
                  std::uint8_t* marks) {
  return each_stored(stored, count, padding, marks, mark_of);
}

PALPATE_FOR_PROCESSOR
bool mark_padding(const float* stored, int count, const StoredPadding<float>& padding, std::uint8_t* marks) {
  return each_stored(stored, count, padding, marks, mark_of);
}

}  // namespace palpate::io::internal

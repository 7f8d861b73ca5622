#include "io/fields/padded_rows.h"

#include <bit>
#include <type_traits>

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

/// Whether any marks differ from the padding. In lanes no wider than the stored type, since twice as many are then
/// tested at once.
template <typename Stored, typename Mark>
[[gnu::always_inline]] inline bool any_differs(const Stored* __restrict stored, int count,
                                               const StoredPadding<Stored>& padding, const Mark& mark) {
  using Lane = std::conditional_t<std::is_floating_point_v<Stored>, std::uint32_t, std::uint16_t>;
  const Stored low = padding.low(), high = padding.high();
  Lane other = 0;
  if (std::is_integral_v<Stored> || padding.has_range()) {
    PALPATE_INDEPENDENT
    for (int n = 0; n < count; ++n) {
      auto is_padding = static_cast<Lane>(static_cast<Lane>(stored[n] >= low) & static_cast<Lane>(stored[n] <= high));
      if constexpr (std::is_floating_point_v<Stored>) is_padding |= static_cast<Lane>(is_infinite(stored[n]));
      other = static_cast<Lane>(other | (is_padding ^ static_cast<Lane>(mark(n))));
    }
  } else if constexpr (std::is_floating_point_v<Stored>) {
    PALPATE_INDEPENDENT
    for (int n = 0; n < count; ++n) other |= is_infinite(stored[n]) ^ static_cast<Lane>(mark(n));
  }
  return other != 0;
}

template <typename Stored>
[[gnu::always_inline]] inline bool have_marks(const Stored* stored, int count, const StoredPadding<Stored>& padding,
                                              const std::uint8_t* __restrict marks) {
  return !any_differs(
      stored, count, padding, [marks](int n) __attribute__((always_inline)) { return marks[n]; });
}

template <typename Stored>
[[gnu::always_inline]] inline bool have_any(const Stored* stored, int count, const StoredPadding<Stored>& padding) {
  return any_differs(
      stored, count, padding, [](int) __attribute__((always_inline)) { return 0; });
}

template <typename Stored>
[[gnu::always_inline]] inline bool are_all(const Stored* stored, int count, const StoredPadding<Stored>& padding) {
  return !any_differs(
      stored, count, padding, [](int) __attribute__((always_inline)) { return 1; });
}

/// With bit operations: 0 times NaN would not be 0.
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

PALPATE_FOR_PROCESSOR
bool all_padding(const std::int16_t* stored, int count, const StoredPadding<std::int16_t>& padding) {
  return are_all(stored, count, padding);
}

PALPATE_FOR_PROCESSOR
bool all_padding(const std::uint16_t* stored, int count, const StoredPadding<std::uint16_t>& padding) {
  return are_all(stored, count, padding);
}

PALPATE_FOR_PROCESSOR
bool all_padding(const float* stored, int count, const StoredPadding<float>& padding) {
  return are_all(stored, count, padding);
}

PALPATE_FOR_PROCESSOR
bool has_marks(const std::int16_t* stored, int count, const StoredPadding<std::int16_t>& padding,
               const std::uint8_t* marks) {
  return have_marks(stored, count, padding, marks);
}

PALPATE_FOR_PROCESSOR
bool has_marks(const std::uint16_t* stored, int count, const StoredPadding<std::uint16_t>& padding,
               const std::uint8_t* marks) {
  return have_marks(stored, count, padding, marks);
}

PALPATE_FOR_PROCESSOR
bool has_marks(const float* stored, int count, const StoredPadding<float>& padding, const std::uint8_t* marks) {
  return have_marks(stored, count, padding, marks);
}

PALPATE_FOR_PROCESSOR
bool any_padding(const std::int16_t* stored, int count, const StoredPadding<std::int16_t>& padding) {
  return have_any(stored, count, padding);
}

PALPATE_FOR_PROCESSOR
bool any_padding(const std::uint16_t* stored, int count, const StoredPadding<std::uint16_t>& padding) {
  return have_any(stored, count, padding);
}

PALPATE_FOR_PROCESSOR
bool any_padding(const float* stored, int count, const StoredPadding<float>& padding) {
  return have_any(stored, count, padding);
}

}  // namespace palpate::io::internal

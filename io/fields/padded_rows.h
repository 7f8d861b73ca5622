#pragma once

/// Prepares rows of stored values, with possible padding, for the gradient's kernel: plain loops that the compiler
/// vectorizes.

#include <cstdint>

#include "io/padding.h"

namespace palpate::io::internal {

/// Stored values as floats.
void to_floats(const std::int16_t* stored, int count, float* values);
void to_floats(const std::uint16_t* stored, int count, float* values);

/// The same, and 0 in padding. Returns whether there is any.
bool to_floats(const std::int16_t* stored, int count, const StoredPadding<std::int16_t>& padding, float* values);
bool to_floats(const std::uint16_t* stored, int count, const StoredPadding<std::uint16_t>& padding, float* values);
bool to_floats(const float* stored, int count, const StoredPadding<float>& padding, float* values);

/// 1 where there is a value, 0 in padding. Returns whether there is any padding.
bool to_weights(const std::int16_t* stored, int count, const StoredPadding<std::int16_t>& padding, float* weights);
bool to_weights(const std::uint16_t* stored, int count, const StoredPadding<std::uint16_t>& padding, float* weights);
bool to_weights(const float* stored, int count, const StoredPadding<float>& padding, float* weights);

/// 1 in padding, 0 if there is a value. Returns whether there is any padding.
bool mark_padding(const std::int16_t* stored, int count, const StoredPadding<std::int16_t>& padding,
                  std::uint8_t* marks);
bool mark_padding(const std::uint16_t* stored, int count, const StoredPadding<std::uint16_t>& padding,
                  std::uint8_t* marks);
bool mark_padding(const float* stored, int count, const StoredPadding<float>& padding, std::uint8_t* marks);

/// Whether there is any padding.
bool any_padding(const std::int16_t* stored, int count, const StoredPadding<std::int16_t>& padding);
bool any_padding(const std::uint16_t* stored, int count, const StoredPadding<std::uint16_t>& padding);
bool any_padding(const float* stored, int count, const StoredPadding<float>& padding);

/// Whether all is padding.
bool all_padding(const std::int16_t* stored, int count, const StoredPadding<std::int16_t>& padding);
bool all_padding(const std::uint16_t* stored, int count, const StoredPadding<std::uint16_t>& padding);
bool all_padding(const float* stored, int count, const StoredPadding<float>& padding);

/// Whether mark_padding() would write exactly these marks.
bool has_marks(const std::int16_t* stored, int count, const StoredPadding<std::int16_t>& padding,
               const std::uint8_t* marks);
bool has_marks(const std::uint16_t* stored, int count, const StoredPadding<std::uint16_t>& padding,
               const std::uint8_t* marks);
bool has_marks(const float* stored, int count, const StoredPadding<float>& padding, const std::uint8_t* marks);

}  // namespace palpate::io::internal

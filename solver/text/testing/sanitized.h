#pragma once

/// Builds with sanitizers are ten to thirty times slower. Tests that repeat a thing for its statistics repeat it less
/// often there: other builds check the numbers, and a memory error shows at the first repetition.

namespace palpate {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool is_sanitized = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
inline constexpr bool is_sanitized = true;
#else
inline constexpr bool is_sanitized = false;
#endif
#else
inline constexpr bool is_sanitized = false;
#endif

/// The number of repetitions: `many`, or under sanitizers `few`.
constexpr int repeats(int many, int few) {
  return is_sanitized ? few : many;
}

}  // namespace palpate

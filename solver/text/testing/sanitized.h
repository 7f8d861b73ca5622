#pragma once

/// Builds with sanitizers are ten to thirty times slower. Tests that repeat a thing for the sake of its numbers repeat
/// it less often there: the numbers are those of every other build, and a slip of memory shows at the first time.

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

/// How often: `many` times, or under sanitizers `few`.
constexpr int repeats(int many, int few) {
  return is_sanitized ? few : many;
}

}  // namespace palpate

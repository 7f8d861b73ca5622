#pragma once

/// PALPATE_SIDE_BY_SIDE before a function compiles it twice. The version with 256-bit vectors runs if the processor has
/// them, and gives the same bits. io/for_processor.h has a similar macro, which the solver cannot include, and says why
/// sanitizers are left out.

#if defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define PALPATE_SIDE_BY_SIDE __attribute__((target_clones("avx2", "default")))
#else
#define PALPATE_SIDE_BY_SIDE
#endif
#ifdef __has_feature
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#undef PALPATE_SIDE_BY_SIDE
#define PALPATE_SIDE_BY_SIDE
#endif
#endif

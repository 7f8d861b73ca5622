#pragma once

/// PALPATE_FOR_PROCESSOR before a function: the function is compiled twice. The version with 256-bit vectors runs if
/// the processor has them. The results are the same to the last bit: every lane does what the plain code does, and the
/// project is compiled without fused operations. (Sanitizers cannot follow the choice, which is made before they are
/// set up.)

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define PALPATE_FOR_PROCESSOR
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer) || \
    !defined(__x86_64__)
#define PALPATE_FOR_PROCESSOR
#endif
#endif
#ifndef PALPATE_FOR_PROCESSOR
#ifdef __x86_64__
#define PALPATE_FOR_PROCESSOR __attribute__((target_clones("avx2", "default")))
#else
#define PALPATE_FOR_PROCESSOR
#endif
#endif

/// Before a loop whose iterations are independent: none reads what another one writes. (clang detects that itself, and
/// would warn if a sanitizer prevents the optimization.)
#ifdef __clang__
#define PALPATE_INDEPENDENT
#else
#define PALPATE_INDEPENDENT _Pragma("GCC ivdep")
#endif

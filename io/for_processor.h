#pragma once

/// PALPATE_FOR_PROCESSOR before a function: compiled twice, and the one with 256-bit vectors is taken where the
/// processor has them. The results are the same to the last bit: every lane does what the plain code does, and the
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

/// Before a loop whose turns do not depend on each other: what it writes, it does not read elsewhere. (clang finds out
/// by itself, and would complain where a sanitizer keeps it from making use of it.)
#ifdef __clang__
#define PALPATE_INDEPENDENT
#else
#define PALPATE_INDEPENDENT _Pragma("GCC ivdep")
#endif

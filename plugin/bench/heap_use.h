#pragma once

/// The memory of the process, from the C library and the kernel.

#include <cstdint>

namespace palpate::plugin {

/// Allocated bytes that are not freed, in all arenas and outside them; 0 if the C library does not tell. Freed memory
/// that threads keep in their caches counts as allocated.
std::uint64_t live_heap_bytes();
/// After the C library has returned its free memory.
std::uint64_t resident_bytes();

}  // namespace palpate::plugin

#pragma once

/// How much memory the process holds, from the C library and the kernel.

#include <cstdint>

namespace palpate::plugin {

/// Bytes that are allocated and not freed, in all arenas and beyond them; 0 if the C library does not tell. What
/// threads keep for themselves after a free counts as allocated.
std::uint64_t live_heap_bytes();
/// After the C library has given back what it keeps free.
std::uint64_t resident_bytes();

}  // namespace palpate::plugin

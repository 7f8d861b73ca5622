#pragma once

#include <cstddef>

namespace palpate::io::internal {

/// Asks the kernel for large pages where this memory is not in use yet. Only a hint, as is the other.
void prefer_large_pages(void* memory, std::size_t bytes);

/// Has the kernel hand out the pages of fresh memory, large ones where it can, on `threads` threads (0: all cores), so
/// that nobody need wait for them one by one.
void hand_out_pages(void* memory, std::size_t bytes, int threads);

}  // namespace palpate::io::internal

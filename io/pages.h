#pragma once

#include <cstddef>

namespace palpate::io::internal {

/// Asks the kernel for large pages for memory that is not in use yet. Both functions are only hints.
void prefer_large_pages(void* memory, std::size_t bytes);

/// Has the kernel allocate the pages of fresh memory at once, large ones if possible, on `threads` threads (0: all
/// cores). Otherwise each first access to a page would wait for it.
void hand_out_pages(void* memory, std::size_t bytes, int threads);

}  // namespace palpate::io::internal

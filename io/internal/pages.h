#pragma once

#include <cstddef>

namespace palpate::io::internal {

/// Has the kernel hand out the pages of fresh memory, large ones where it can, on `threads` threads (0: all cores), so
/// that nobody need wait for them one by one. Only a hint: where it fails, nothing is lost but time.
void hand_out_pages(void* memory, std::size_t bytes, int threads);

}  // namespace palpate::io::internal

#include "palpate/io/internal/pages.h"

#include <sys/mman.h>

#include <algorithm>
#include <cstdint>

#include "palpate/io/internal/parallel.h"

namespace palpate::io::internal {

void hand_out_pages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t bytes, [[maybe_unused]] int threads) {
#if defined(MADV_POPULATE_WRITE) && defined(MADV_HUGEPAGE)
  constexpr std::uintptr_t page = 4096;
  constexpr std::uintptr_t large = 512 * page;
  const auto begin = (reinterpret_cast<std::uintptr_t>(memory) + page - 1) / page * page;
  const auto end = (reinterpret_cast<std::uintptr_t>(memory) + bytes) / page * page;
  if (end < begin + 4 * large) return;
  const auto at = [](std::uintptr_t address) { return reinterpret_cast<void*>(address); };  // NOLINT
  ::madvise(at(begin), end - begin, MADV_HUGEPAGE);
  const std::uintptr_t first = begin / large * large;  // so that no large page is two threads'
  const auto populate = [&](std::size_t n) {
    const std::uintptr_t from = std::max(begin, first + n * large);
    ::madvise(at(from), std::min(end, first + (n + 1) * large) - from, MADV_POPULATE_WRITE);
  };
  parallel_for((end - first + large - 1) / large, populate, {}, threads);
#endif
}

}  // namespace palpate::io::internal

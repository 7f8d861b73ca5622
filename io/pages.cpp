#include "io/pages.h"

#include <sys/mman.h>

#include <algorithm>
#include <cstdint>

#include "io/parallel.h"

namespace palpate::io::internal {
namespace {

constexpr std::uintptr_t page = 4096;
constexpr std::uintptr_t large = 512 * page;

struct Pages {
  std::uintptr_t begin;
  std::uintptr_t end;
};

Pages whole_pages(const void* memory, std::size_t bytes) {
  const auto begin = reinterpret_cast<std::uintptr_t>(memory);
  return {(begin + page - 1) / page * page, (begin + bytes) / page * page};
}

void advise(std::uintptr_t begin, std::uintptr_t end, int advice) {
  ::madvise(reinterpret_cast<void*>(begin), end - begin, advice);  // NOLINT(performance-no-int-to-ptr): of whole pages
}

}  // namespace

void prefer_large_pages(void* memory, std::size_t bytes) {
  const Pages pages = whole_pages(memory, bytes);
  if (pages.end > pages.begin + large) advise(pages.begin, pages.end, MADV_HUGEPAGE);
}

void hand_out_pages(void* memory, std::size_t bytes, int threads) {
  const Pages pages = whole_pages(memory, bytes);
  if (pages.end < pages.begin + 4 * large) return;
  prefer_large_pages(memory, bytes);
  const std::uintptr_t first = pages.begin / large * large;  // so that no large page is two threads'
  const auto populate = [&](std::size_t n) {
    advise(std::max(pages.begin, first + n * large), std::min(pages.end, first + (n + 1) * large), MADV_POPULATE_WRITE);
  };
  parallel_for((pages.end - first + large - 1) / large, populate, {}, threads);
}

}  // namespace palpate::io::internal

#include "plugin/bench/heap_use.h"

#include <malloc.h>
#include <unistd.h>

#include <array>
#include <charconv>
#include <cstdio>
#include <fstream>
#include <string>
#include <string_view>

namespace palpate::plugin {
namespace {

/// The number in `name="..."` of the last element of malloc_info's text that begins as named.
std::uint64_t last_number(std::string_view text, std::string_view element, std::string_view name) {
  const auto at = text.rfind(element);
  const auto key = at == std::string_view::npos ? at : text.find(name, at + element.size());
  std::uint64_t number = 0;
  if (key != std::string_view::npos) {
    const std::string_view digits = text.substr(key + name.size());
    std::from_chars(digits.data(), digits.data() + digits.size(), number);
  }
  return number;
}

}  // namespace

std::uint64_t live_heap_bytes() {
  // mallinfo2() covers only the main arena. Into a buffer of our own, so that the report does not change what it
  // reports.
  static std::array<char, 1U << 18U> buffer;
  FILE* stream = fmemopen(buffer.data(), buffer.size() - 1, "w");
  if (stream == nullptr || malloc_info(0, stream) != 0) {
    return 0;
  }
  std::fflush(stream);
  const auto size = static_cast<std::size_t>(std::ftell(stream));
  std::fclose(stream);
  const std::string_view text(buffer.data(), size);
  const std::uint64_t system = last_number(text, "<system type=\"current\"", "size=\"");
  const std::uint64_t mapped = last_number(text, "<total type=\"mmap\"", "size=\"");
  const std::uint64_t fast = last_number(text, "<total type=\"fast\"", "size=\"");
  const std::uint64_t rest = last_number(text, "<total type=\"rest\"", "size=\"");
  return system + mapped - fast - rest;
}

std::uint64_t resident_bytes() {
  malloc_trim(0);
  std::ifstream statm("/proc/self/statm");
  std::uint64_t total = 0, resident = 0;
  statm >> total >> resident;
  return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

}  // namespace palpate::plugin

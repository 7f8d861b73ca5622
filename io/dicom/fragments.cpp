#include "io/dicom/fragments.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>

#include "io/errors.h"
#include "io/messages.h"

namespace palpate::io::internal {
namespace {

std::uint32_t little_endian(std::span<const std::byte> bytes) {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;) value = value << 8 | std::to_integer<std::uint32_t>(bytes[i]);
  return value;
}

constexpr std::uint32_t item_tag = 0xE000FFFE;
constexpr std::uint32_t end_tag = 0xE0DDFFFE;

struct Items {
  std::vector<std::uint32_t> offset_table;
  std::vector<Fragment> fragments;
  std::uint64_t first_item_at = 0;  // the offset table counts from here
  bool has_end = true;
};

Items read_items(const InputFile& file, std::uint64_t at) {
  Items items;
  for (bool first = true;; first = false) {
    // Some writers leave out the item that ends the sequence; the fragments are complete.
    if (!first && (at > file.size() || file.size() - at < 8)) {
      items.has_end = false;
      return items;
    }
    std::array<std::byte, 8> head{};
    file.read(at, head);
    const std::uint32_t tag = little_endian(head);
    const std::uint32_t length = little_endian(std::span(head).subspan(4));
    at += head.size();
    if (tag == end_tag) return items;
    if (tag != item_tag) throw DicomError(say("compressed-pixels-are-not-items"));
    if (at > file.size() || length > file.size() - at)
      throw DicomError(say("truncated-its-compressed-pixels-end-early"));
    if (first) {
      std::vector<std::byte> table(length);
      file.read(at, table);
      for (std::size_t i = 0; i + 4 <= table.size(); i += 4) {
        items.offset_table.push_back(little_endian(std::span(table).subspan(i)));
      }
      items.first_item_at = at + length;
    } else {
      items.fragments.push_back({at, length});
    }
    at += length;
  }
}

// Where each frame starts among the fragments, by the offset table; nothing if that is not consistent.
std::optional<std::vector<std::size_t>> starts_by_table(const Items& items, std::size_t frames) {
  if (items.offset_table.size() != frames) return std::nullopt;
  std::vector<std::size_t> starts;
  for (const std::uint32_t offset : items.offset_table) {
    const std::uint64_t at = items.first_item_at + offset + 8;
    const auto found = std::lower_bound(items.fragments.begin(), items.fragments.end(), at,
                                        [](const Fragment& f, std::uint64_t wanted) { return f.at < wanted; });
    if (found == items.fragments.end() || found->at != at) return std::nullopt;
    starts.push_back(static_cast<std::size_t>(found - items.fragments.begin()));
    if (starts.size() > 1 && starts.back() <= starts[starts.size() - 2]) return std::nullopt;
  }
  return starts.front() == 0 ? std::optional(starts) : std::nullopt;
}

// JPEG and JPEG-LS begin with FF D8 FF, JPEG 2000 with FF 4F FF 51 or the box signature 00 00 00 0C 6A 50.
bool starts_a_stream(const InputFile& file, const Fragment& fragment) {
  if (fragment.length < 6) return false;
  std::array<std::byte, 6> head{};
  file.read(fragment.at, head);
  const auto is = [&](std::initializer_list<int> bytes) {
    return std::equal(bytes.begin(), bytes.end(), head.begin(),
                      [](int a, std::byte b) { return a == std::to_integer<int>(b); });
  };
  return is({0xFF, 0xD8, 0xFF}) || is({0xFF, 0x4F, 0xFF, 0x51}) || is({0, 0, 0, 0x0C, 0x6A, 0x50});
}

std::vector<std::size_t> starts_of(const InputFile& file, const Items& items, std::size_t frames) {
  std::vector<std::size_t> starts;
  if (frames == 1) return {0};
  if (items.fragments.size() == frames) {
    for (std::size_t f = 0; f < frames; ++f) starts.push_back(f);
    return starts;
  }
  if (auto by_table = starts_by_table(items, frames)) return *by_table;
  for (std::size_t i = 0; i < items.fragments.size(); ++i) {
    if (starts_a_stream(file, items.fragments[i])) starts.push_back(i);
  }
  if (starts.size() != frames || starts.front() != 0) starts.clear();
  return starts;
}

}  // namespace

Encapsulated find_fragments(const InputFile& file, std::uint64_t pixels_at, std::size_t frames) {
  const Items items = read_items(file, pixels_at);
  if (items.fragments.empty() || frames == 0) throw DicomError(say("no-pixels-in-it"));
  auto starts = starts_of(file, items, frames);
  if (starts.empty()) {
    throw DicomError(say("compressed-fragments-do-not-make-up", items.fragments.size(), frames));
  }
  starts.push_back(items.fragments.size());
  Encapsulated result{std::vector<std::vector<Fragment>>(frames), items.has_end};
  for (std::size_t f = 0; f < frames; ++f) {
    result.frames[f].assign(items.fragments.begin() + static_cast<std::ptrdiff_t>(starts[f]),
                            items.fragments.begin() + static_cast<std::ptrdiff_t>(starts[f + 1]));
  }
  return result;
}

std::vector<std::byte> read_fragments(const InputFile& file, const std::vector<Fragment>& fragments) {
  std::size_t total = 0;
  for (const Fragment& fragment : fragments) total += fragment.length;
  std::vector<std::byte> bytes(total);
  std::size_t at = 0;
  for (const Fragment& fragment : fragments) {
    file.read(fragment.at, std::span(bytes).subspan(at, fragment.length));
    at += fragment.length;
  }
  return bytes;
}

}  // namespace palpate::io::internal

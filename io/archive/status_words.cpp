#include "io/archive/status_words.h"

#include <algorithm>
#include <array>
#include <cstdio>

namespace palpate::io {
namespace {

struct Words {
  std::uint16_t low, high;  // the statuses that it is for
  const char* text;
};

constexpr Words statuses[] = {
    {0x0000, 0x0000, "success"},
    {0x0105, 0x0105, "it knows no such attribute"},
    {0x0106, 0x0106, "a value was not accepted"},
    {0x0110, 0x0110, "it failed while processing"},
    {0x0111, 0x0111, "it holds this already"},
    {0x0117, 0x0117, "a UID was not accepted"},
    {0x0118, 0x0118, "it does not know this kind of object"},
    {0x0122, 0x0122, "it does not support this kind of request"},
    {0x0124, 0x0124, "we are not authorized there"},
    {0x0211, 0x0211, "it does not know this request"},
    {0x0212, 0x0212, "it finds the request malformed"},
    {0x0213, 0x0213, "it is out of resources"},
    {0xA700, 0xA700, "it is out of resources"},
    {0xA701, 0xA701, "it cannot count the matches: out of resources"},
    {0xA702, 0xA702, "it cannot send the images: out of resources"},
    {0xA703, 0xA7FF, "it is out of resources"},
    {0xA801, 0xA801, "it does not know where to send to"},
    {0xA900, 0xA9FF, "it finds that the data do not fit the request"},
    {0xB000, 0xB000, "done, with failures or changes"},
    {0xB006, 0xB006, "it left elements out"},
    {0xB007, 0xB007, "it finds that the data do not fit their kind of object"},
    {0xC000, 0xCFFF, "it cannot process the request"},
    {0xFE00, 0xFE00, "canceled"},
};

}  // namespace

std::string status_words(std::uint16_t status) {
  const auto* const found = std::find_if(std::begin(statuses), std::end(statuses), [&](const Words& words) {
    return words.low <= status && status <= words.high;
  });
  std::array<char, 24> code{};
  std::snprintf(code.data(), code.size(), " (status %04X)", static_cast<unsigned>(status));
  return (found == std::end(statuses) ? std::string("a status of its own") : std::string(found->text)) + code.data();
}

std::string printable(std::string_view text) {
  std::string result(text.substr(0, 64));
  std::replace_if(
      result.begin(), result.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return result;
}

}  // namespace palpate::io

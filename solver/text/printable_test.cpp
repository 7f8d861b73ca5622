#include "solver/text/printable.h"

#include <gtest/gtest.h>
#include <iconv.h>

#include <array>
#include <cstdio>
#include <string>
#include <vector>

namespace palpate {
namespace {

std::string utf8_of_latin1(unsigned value) {
  if (value < 0x80) return {static_cast<char>(value)};
  return {static_cast<char>(0xC0 | (value >> 6)), static_cast<char>(0x80 | (value & 0x3F))};
}

// Of the first 256 characters those of control are shown by their numbers, the others as they are.
TEST(Printable, ShowsControlCharactersByTheirNumbers) {
  for (unsigned value = 0; value < 0x100; ++value) {
    const std::string character = utf8_of_latin1(value);
    char number[8];
    std::snprintf(number, sizeof number, "%02x", value);
    const bool is_ascii_control = value < 0x20 || value == 0x7F, is_c1 = value >= 0x80 && value < 0xA0;
    const std::string text = "a" + character + "b";
    EXPECT_EQ(printable(text),
              (is_ascii_control && value != '\n') || is_c1 ? "a\\x" + std::string(number) + "b" : text);
    EXPECT_EQ(printable_json(text), value == 0x7F || is_c1 ? "a\\u00" + std::string(number) + "b" : text);
  }
  EXPECT_EQ(printable("\xC2"), "\\xc2");  // cut off
}

/// Whether the C library reads it as UTF-8.
bool is_utf8(std::string text) {
  static const iconv_t converter = iconv_open("UTF-32LE", "UTF-8");
  iconv(converter, nullptr, nullptr, nullptr, nullptr);  // begins anew
  std::array<char, 256> out{};
  char *from = text.data(), *to = out.data();
  std::size_t left = text.size(), room = out.size();
  return iconv(converter, &from, &left, &to, &room) != static_cast<std::size_t>(-1);
}

// Whatever bytes there are, what is shown is UTF-8; what is UTF-8 without control characters is shown as it is.
/// A byte that is no UTF-8 takes nothing of what follows with it.
TEST(Printable, ShowsWhatFollowsAByteThatIsNone) {
  for (const std::string rest : {"a", "ab", "\xC3\xA9", "\x1b[0m", "\xFF", ""}) {
    EXPECT_EQ(printable("\xFE" + rest), "\\xfe" + printable(rest));
    EXPECT_EQ(printable("\xC3"
                        "a" +
                        rest),
              "\\xc3"
              "a" +
                  printable(rest));
  }
}

TEST(Printable, IsUtf8WhateverTheBytes) {
  constexpr unsigned char bytes[] = {'a',  0x80, 0x8F, 0x90, 0x9F, 0xA0, 0xBF, 0xC1,
                                     0xC2, 0xDF, 0xE0, 0xED, 0xEF, 0xF0, 0xF4, 0xF5};
  std::vector<std::string> all{""};
  for (std::size_t first = 0, length = 0; length < 4; ++length) {
    const std::size_t end = all.size();
    for (; first < end; ++first) {
      for (const unsigned char byte : bytes) all.push_back(all[first] + static_cast<char>(byte));
    }
  }
  std::size_t sound = 0;
  for (const std::string& text : all) {
    const std::string shown = printable(text);
    // Of control characters those of C1 begin with C2.
    ASSERT_EQ(shown == text || text.find('\xC2') != std::string::npos,
              is_utf8(text) || text.find('\xC2') != std::string::npos);
    ASSERT_TRUE(is_utf8(shown));
    ASSERT_TRUE(is_utf8(printable_json(text)));
    sound += shown == text;
  }
  EXPECT_GT(sound, 100U);
}

}  // namespace
}  // namespace palpate

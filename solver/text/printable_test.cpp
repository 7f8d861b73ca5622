#include "solver/text/printable.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <string>

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
  EXPECT_EQ(printable("\xC2"), "\xC2");  // cut off
}

}  // namespace
}  // namespace palpate

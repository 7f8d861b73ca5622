// Texts of headers as UTF-8: by the bytes of Unicode's chapter 3.9 and the examples of PS3.5 annexes H to K.
#include "io/dicom/character_set.h"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace palpate::io::internal {
namespace {

std::string latin1_by_hand(const std::string& text) {
  std::string all;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x80) all += static_cast<char>(byte >= 0xC0 ? 0xC3 : 0xC2);
    all += static_cast<char>(byte >= 0xC0 ? byte - 0x40 : byte);
  }
  return all;
}

// Whatever is said of it: text that is UTF-8 stays, and any other without a known set is Latin-1.
TEST(CharacterSets, WithoutOneTextIsUtf8OrLatin1) {
  const std::vector<std::pair<std::string, bool>> texts{{"plain", true},
                                                        {"\xC2\x80", true},
                                                        {"\xDF\xBF", true},
                                                        {"\xE0\xA0\x80", true},
                                                        {"\xED\x9F\xBF", true},
                                                        {"\xEE\x80\x80", true},
                                                        {"\xEF\xBF\xBF", true},
                                                        {"\xF0\x90\x80\x80", true},
                                                        {"\xF4\x8F\xBF\xBF", true},
                                                        {"a\xC3\xBC"
                                                         "b\xE2\x82\xAC"
                                                         "c\xF0\x9F\x98\x80",
                                                         true},
                                                        {"\x80", false},  // goes on with nothing before it
                                                        {"\xBF", false},
                                                        {"\xC0\x80", false},  // longer than needed
                                                        {"\xC1\xBF", false},
                                                        {"\xE0\x9F\xBF", false},
                                                        {"\xF0\x8F\xBF\xBF", false},
                                                        {"\xED\xA0\x80", false},  // a surrogate
                                                        {"\xED\xBF\xBF", false},
                                                        {"\xF4\x90\x80\x80", false},  // beyond the last
                                                        {"\xF5\x80\x80\x80", false},
                                                        {"\xFF", false},
                                                        {"\xC3", false},  // ends early
                                                        {"\xE2\x82", false},
                                                        {"\xF0\x9F\x98", false},
                                                        {"\xC3(", false},  // does not go on
                                                        {"\xE2\x82(", false},
                                                        {"\xE2(\xAC", false},
                                                        {"\xF0\x9F\x98(", false},
                                                        {"a\xFC"
                                                         "b",
                                                         false}};
  for (const auto& [text, is_utf8] : texts) {
    const std::string expected = is_utf8 ? text : latin1_by_hand(text);
    EXPECT_EQ(utf8_of(text, ""), expected) << text;
    EXPECT_EQ(utf8_of(text, "NO SUCH SET"), expected) << text;
  }
}

/// One letter of each set of a byte, and the examples of the standard.
TEST(CharacterSets, OfTheStandardAreConverted) {
  for (const auto& [set, text, expected] : std::vector<std::array<std::string, 3>>{
           {"ISO_IR 100", "\xC4", "\xC3\x84"},
           {"ISO_IR 101", "\xA1", "\xC4\x84"},
           {"ISO_IR 109", "\xA1", "\xC4\xA6"},
           {"ISO_IR 110", "\xA1", "\xC4\x84"},
           {"ISO_IR 144", "\xBB\xEE\xDA", "\xD0\x9B\xD1\x8E\xD0\xBA"},
           {"ISO_IR 126", "\xC4", "\xCE\x94"},
           {"ISO_IR 138", "\xF9", "\xD7\xA9"},
           {"ISO_IR 148", "\xDD", "\xC4\xB0"},
           {"ISO_IR 192", "\xC3\x84", "\xC3\x84"},
           {"GB18030", "\xCD\xF5", "\xE7\x8E\x8B"},
           {"\\ISO 2022 IR 149", "\x1B$)C\xB1\xE8", "\xEA\xB9\x80"},
           {"\\ISO 2022 IR 87", "\x1B$B;3\x1B(B", "\xE5\xB1\xB1"},
           {"\\ISO 2022 IR 159", "\x1B$B;3\x1B(B", "\xE5\xB1\xB1"},
           {"ISO 2022 IR 13\\ISO 2022 IR 87", "\xA1", "\xEF\xBD\xA1"},
           {"ISO 2022 IR 13\\ISO 2022 IR 87", "\xD4\x1B)I\xDF", "\xEF\xBE\x94\xEF\xBE\x9F"},
           {"ISO 2022 IR 13\\ISO 2022 IR 87",
            "a\xBF"
            "b",
            "a\xEF\xBD\xBF"
            "b"},
           {"ISO 2022 IR 13\\ISO 2022 IR 87", "\xC0", "\xEF\xBE\x80"}}) {
    EXPECT_EQ(utf8_of(text, set), expected) << set;
  }
}

/// JIS X 0201: half-width katakana are 63 bytes from A1 on, U+FF61 to U+FF9F.
TEST(CharacterSets, HalfWidthKatakanaAreInTheirOrder) {
  for (int byte = 0xA1; byte <= 0xDF; ++byte) {
    const int point = 0xFF61 + byte - 0xA1;
    std::string expected{static_cast<char>(0xEF), static_cast<char>(0x80 | (point >> 6 & 0x3F)),
                         static_cast<char>(0x80 | (point & 0x3F))};
    EXPECT_EQ(utf8_of(std::string(1, static_cast<char>(byte)), "ISO 2022 IR 13\\ISO 2022 IR 87"), expected) << byte;
  }
}

TEST(CharacterSets, ThatDoNotFitTheirTextAreLeft) {
  EXPECT_EQ(utf8_of("\x1B$B;", "\\ISO 2022 IR 87"), "\x1B$B;") << "an escape that ends early";
  EXPECT_EQ(utf8_of("\xE0", "\\ISO 2022 IR 87"), "\xC3\xA0") << "no katakana";
  for (const char* set : {"ISO_IR 100", "ISO_IR 13", "ISO 2022 IR 13\\ISO 2022 IR 87", "GB18030"}) {
    EXPECT_EQ(utf8_of("plain ^ text=~", set), "plain ^ text=~") << set;
  }
}

}  // namespace
}  // namespace palpate::io::internal

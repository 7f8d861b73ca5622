// Statuses in words, by the standard's tables, at both ends of each range; and which characters of a peer's text are
// shown.
#include "io/archive/status_words.h"

#include <gtest/gtest.h>

#include <string>
#include <tuple>

namespace palpate::io {
namespace {

/// DICOM PS3.7 annex C, PS3.4 tables B.2-1 (storage), C.4-1 (find), C.4-2 (move) and C.4-3 (get).
TEST(StatusWords, AreThoseOfTheStandardsTables) {
  const std::string own = "a status of its own";
  for (const auto& [status, code, words] : {
           std::tuple{0x0000, "0000", std::string("success")},
           {0x0001, "0001", own},
           {0x0105, "0105", "it knows no such attribute"},
           {0x0106, "0106", "a value was not accepted"},
           {0x0107, "0107", own},
           {0x0110, "0110", "it failed while processing"},
           {0x0111, "0111", "it holds this already"},
           {0x0117, "0117", "a UID was not accepted"},
           {0x0118, "0118", "it does not know this kind of object"},
           {0x0122, "0122", "it does not support this kind of request"},
           {0x0124, "0124", "we are not authorized there"},
           {0x0210, "0210", own},
           {0x0211, "0211", "it does not know this request"},
           {0x0212, "0212", "it finds the request malformed"},
           {0x0213, "0213", "it is out of resources"},
           {0xA6FF, "A6FF", own},
           {0xA700, "A700", "it is out of resources"},
           {0xA701, "A701", "it cannot count the matches: out of resources"},
           {0xA702, "A702", "it cannot send the images: out of resources"},
           {0xA703, "A703", "it is out of resources"},
           {0xA7FF, "A7FF", "it is out of resources"},
           {0xA800, "A800", own},
           {0xA801, "A801", "it does not know where to send to"},
           {0xA802, "A802", own},
           {0xA900, "A900", "it finds that the data do not fit the request"},
           {0xA9FF, "A9FF", "it finds that the data do not fit the request"},
           {0xAA00, "AA00", own},
           {0xB000, "B000", "done, with failures or changes"},
           {0xB001, "B001", own},
           {0xB005, "B005", own},
           {0xB006, "B006", "it left elements out"},
           {0xB007, "B007", "it finds that the data do not fit their kind of object"},
           {0xB008, "B008", own},
           {0xBFFF, "BFFF", own},
           {0xC000, "C000", "it cannot process the request"},
           {0xCFFF, "CFFF", "it cannot process the request"},
           {0xD000, "D000", own},
           {0xFE00, "FE00", "canceled"},
           {0xFF00, "FF00", own},
       }) {
    EXPECT_EQ(status_words(static_cast<std::uint16_t>(status)), words + " (status " + code + ")");
  }
}

TEST(Printable, IsAsciiAndNotLong) {
  for (int c = 0; c < 256; ++c) {
    const char letter = static_cast<char>(c);
    EXPECT_EQ(printable(std::string(1, letter)), std::string(1, c >= 32 && c <= 126 ? letter : '?')) << c;
  }
  EXPECT_EQ(printable(std::string(64, 'a')), std::string(64, 'a'));
  EXPECT_EQ(printable(std::string(65, 'a')), std::string(64, 'a'));
  EXPECT_EQ(printable(""), "");
}

}  // namespace
}  // namespace palpate::io

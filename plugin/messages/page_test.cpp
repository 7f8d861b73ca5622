// The page against the tables that it is made of, and the tables against the sources that say what stands in them.

#include "plugin/messages/page.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <string>

namespace palpate::plugin {
namespace {

const std::filesystem::path sources = PALPATE_SOURCES;

std::string content_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

TEST(MessagePage, IsMadeOfTheTables) {
  EXPECT_EQ(content_of(sources / "plugin/docs/messages.md"), message_page())
      << "write it anew: ninja -C build messages_page";
}

TEST(MessagePage, EveryMessageSaysWhyItComesAndWhatToDo) {
  for (const MessageSection& section : message_sections()) {
    for (const auto& table : section.tables) {
      for (const MessageRow& row : table) {
        EXPECT_FALSE(row.why.empty() || row.what_to_do.empty()) << row.messages[0].text;
        EXPECT_FALSE(row.messages[0].text.empty()) << row.why;
        EXPECT_EQ(row.why.find('|'), std::string_view::npos) << "it would end its cell: " << row.why;
      }
    }
  }
}

}  // namespace
}  // namespace palpate::plugin

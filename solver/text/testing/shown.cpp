#include "solver/text/testing/shown.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>

namespace palpate::testing {
namespace {

/// What the tests quote: their texts, with the literals joined that stand behind each other.
std::string all_tests(const std::filesystem::path& sources) {
  std::string all;
  for (const char* const folder : {"io", "modes", "solver", "device", "plugin"}) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(sources / folder)) {
      const std::string file = entry.path().string();
      const bool is_test = file.ends_with("_test.cpp") || file.find("/tests/") != std::string::npos;
      if (!is_test || !entry.is_regular_file() || entry.path().filename() == "messages_test.cpp") continue;
      std::ifstream stream(file, std::ios::binary);
      all.append(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()).append("\n");
    }
  }
  return std::regex_replace(std::regex_replace(all, std::regex("\"\\s*\n\\s*R?\""), ""), std::regex("\\\\\""), "\"");
}

std::vector<std::string> pieces_of(std::string_view message) {
  std::vector<std::string> pieces;
  for (std::size_t at = 0; at <= message.size();) {
    const std::size_t end = std::min(message.find("{}", at), message.size());
    std::string_view piece = message.substr(at, end - at);
    piece.remove_prefix(std::min(piece.find_first_not_of(' '), piece.size()));
    piece = piece.substr(0, piece.find_last_not_of(' ') + 1);
    if (!piece.empty()) pieces.emplace_back(piece);
    at = end + 2;
  }
  return pieces;
}

}  // namespace

std::string said_when(const std::function<void()>& run) {
  try {
    run();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "nothing";
}

std::string output_of(const std::string& command) {
  FILE* pipe = popen(("{ " + command + "; } 2>&1").c_str(), "r");  // NOLINT: the tests' own arguments
  std::string output;
  std::array<char, 4096> buffer{};
  while (const std::size_t count = fread(buffer.data(), 1, buffer.size(), pipe)) output.append(buffer.data(), count);
  pclose(pipe);
  return output;
}

bool fits(std::string_view message, std::string_view text) {
  std::size_t at = 0;
  for (const std::string& piece : pieces_of(message)) {
    at = text.find(piece, at);
    if (at == std::string_view::npos) return false;
    at += piece.size();
  }
  return true;
}

void expect_all_shown(const std::vector<std::span<const MessageRow>>& tables, std::span<const Provoked> provoked,
                      std::span<const NotShown> not_shown, const char* sources) {
  const std::string tests = all_tests(sources);
  std::size_t known = 0;
  const auto look_at = [&](const Message& message) {
    bool is_provoked = false;
    for (const Provoked& one : provoked) {
      if (one.id != message.id) continue;
      is_provoked = true;
      ++known;
      EXPECT_TRUE(fits(message.text, one.said)) << "wanted: " << message.text << "\nsaid: " << one.said;
    }
    const bool is_excused = std::ranges::count(not_shown, message.id, &NotShown::id) > 0;
    EXPECT_FALSE(is_excused && is_provoked) << "it can be shown: " << message.id;
    if (is_provoked || is_excused) return;
    const std::vector<std::string> pieces = pieces_of(message.text);
    EXPECT_TRUE(std::ranges::all_of(pieces, [&](const auto& piece) { return tests.find(piece) != std::string::npos; }))
        << "no test shows \"" << message.text << "\": provoke " << message.id
        << " here, quote it in the test that meets it, or say here why it cannot be had";
  };
  for (const auto& table : tables) {
    for (const MessageRow& row : table) {
      for (const Message& message : row.messages) {
        if (!message.id.empty()) look_at(message);
      }
    }
  }
  EXPECT_EQ(known, provoked.size()) << "something was provoked that these tables do not hold";
}

}  // namespace palpate::testing

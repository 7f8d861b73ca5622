#pragma once

#include <gtest/gtest.h>

#include <string>
#include <string_view>

namespace palpate::io::testing {

/// Whether a text contains a message of the table of messages, in which {} stands for any text.
inline ::testing::AssertionResult says(std::string_view text, std::string_view message) {
  std::size_t at = 0;
  while (!message.empty()) {
    const std::size_t end = message.find("{}");
    const std::string_view piece = message.substr(0, end);
    at = text.find(piece, at);
    if (at == std::string_view::npos) return ::testing::AssertionFailure() << "said: " << text << "\nnot: " << piece;
    at += piece.size();
    message = end == std::string_view::npos ? std::string_view() : message.substr(end + 2);
  }
  return ::testing::AssertionSuccess();
}

}  // namespace palpate::io::testing

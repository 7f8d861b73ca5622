#pragma once

/// Generates plugin/docs/messages.md from the tables.

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "solver/text/message.h"

namespace palpate::plugin {

/// The tables of all folders, as sections of the page.
struct MessageSection {
  std::string_view title;
  std::string_view introduction;
  std::vector<std::span<const MessageRow>> tables;
};
const std::vector<MessageSection>& message_sections();

std::string message_page();

}  // namespace palpate::plugin

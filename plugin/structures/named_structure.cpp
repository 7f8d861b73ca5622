#include "plugin/structures/named_structure.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <functional>
#include <system_error>
#include <vector>

#include "plugin/messages/messages.h"

namespace palpate::plugin {

AskedStructure asked_structure(const std::string& text) {
  AskedStructure asked{.number = std::nullopt, .name = text};
  int number = 0;
  const char* const end = text.data() + text.size();
  if (const auto [stop, error] = std::from_chars(text.data(), end, number); error == std::errc() && stop == end) {
    asked.number = number;
  }
  return asked;
}

std::string listed(std::span<const io::Structure> structures) {
  const bool is_one_file =
      std::ranges::all_of(structures, [&](const io::Structure& one) { return one.file == structures.front().file; });
  std::string all;
  for (const io::Structure& one : structures) {
    all += fmt::format("{}{} {}", all.empty() ? "" : ", ", one.number, one.name);
    if (!is_one_file) all += fmt::format(" ({})", one.file.filename().string());
  }
  return all;
}

FoundStructure find_named(std::span<const io::Structure> structures, const AskedStructure& asked,
                          const std::filesystem::path& file) {
  std::vector<const io::Structure*> matches;
  const auto collect = [&](const std::function<bool(const io::Structure&)>& is_it) {
    for (const io::Structure& one : structures) {
      if (is_it(one)) matches.push_back(&one);
    }
  };
  if (asked.number) collect([&](const io::Structure& one) { return one.number == *asked.number; });
  if (asked.name && matches.empty()) collect([&](const io::Structure& one) { return one.name == *asked.name; });
  if (matches.size() == 1) return {.structure = matches.front(), .why_not = {}};
  const std::string name = file.filename().string();
  const std::string words = asked.name ? *asked.name : fmt::format("{}", asked.number.value_or(0));
  if (matches.empty()) {
    return {.structure = nullptr, .why_not = say("file-has-no-such-structure", name, words, listed(structures))};
  }
  std::vector<io::Structure> several;
  for (const io::Structure* one : matches) several.push_back(*one);
  return {.structure = nullptr, .why_not = say("file-holds-several-of-that-name", name, words, listed(several))};
}

}  // namespace palpate::plugin

#include "plugin/messages/message_table.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <iterator>
#include <optional>
#include <regex>

namespace palpate::plugin::testing {
namespace {

namespace fs = std::filesystem;

std::string content_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

std::string trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \n\r");
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(" \n\r") - first + 1));
}

/// The code spans of a line of Markdown.
std::vector<std::string> code_spans(std::string_view line) {
  std::vector<std::string> spans;
  for (std::size_t at = line.find('`'); at != std::string_view::npos; at = line.find('`', at)) {
    const std::size_t inside = std::min(line.find_first_not_of('`', at), line.size());
    const std::string fence(inside - at, '`');
    const std::size_t end = line.find(fence, inside);
    if (end == std::string_view::npos) break;
    spans.push_back(trimmed(line.substr(inside, end - inside)));
    at = end + fence.size();
  }
  return spans;
}

std::vector<fs::path> sources_in(const fs::path& root) {
  static const std::regex not_told(
      "_test\\.|_benchmark\\.|/tests/|/testing/|/peers/|/fuzz/|message_table|plugin/messages");
  std::vector<fs::path> files;
  for (const char* const folder : {"io", "modes", "solver", "plugin"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      const fs::path& file = entry.path();
      if (file.extension() != ".cpp" && file.extension() != ".h") continue;
      if (!std::regex_search(fs::relative(file, root).string(), not_told)) files.push_back(file);
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// Without comments; lines stay where they are.
std::string without_comments(std::string text) {
  bool quoted = false;
  for (std::size_t n = 0; n + 1 < text.size(); ++n) {
    if (quoted && text[n] == '\\') {
      ++n;
    } else if (text[n] == '\'' && text[n + 1] == '"') {
      ++n;
    } else if (text[n] == '"') {
      quoted = !quoted;
    } else if (!quoted && text[n] == '/' && text[n + 1] == '/') {
      while (n < text.size() && text[n] != '\n') text[n++] = ' ';
    }
  }
  return text;
}

/// The literal that begins at `at`, with those that follow it directly; `at` is moved behind them.
std::string literal_at(std::string_view code, std::size_t& at) {
  std::string text;
  while (at < code.size() && code[at] == '"') {
    for (++at; at < code.size() && code[at] != '"'; ++at) {
      if (code[at] == '\\' && at + 1 < code.size()) {
        ++at;
        text += code[at] == 'n' || code[at] == 'r' ? '\n' : code[at];
      } else {
        text += code[at];
      }
    }
    ++at;
    const std::size_t next = code.find_first_not_of(" \n", at);
    if (next != std::string_view::npos && code[next] == '"') at = next;
  }
  return text;
}

void append_literals(const std::string& code, std::string& all) {
  for (std::size_t at = code.find('"'); at != std::string::npos; at = code.find('"', at)) {
    all += literal_at(code, at) + "\n";
  }
}

constexpr std::array openers = {"DicomError(",
                                "ArchiveError(",
                                "runtime_error(",
                                "invalid_argument(",
                                "InputRefused(",
                                "WrongUsage(",
                                " Refused(",
                                "refuse(",
                                "refuse_choice(",
                                "require(",
                                "warnings.push_back(",
                                "defect = ",
                                "unfit = ",
                                "skipped.push_back(",
                                "emit told(",
                                "refused(",
                                " tell(tr(",
                                "notes << tr(",
                                "print(stderr",
                                "fprintf(stderr",
                                "fputs(",
                                "warn(",
                                "stop(fmt::format("};

}  // namespace

std::vector<std::string> messages_of_table(const fs::path& markdown) {
  std::ifstream stream(markdown);
  std::vector<std::string> messages;
  for (std::string line; std::getline(stream, line);) {
    if (!line.starts_with("| `")) continue;
    // A message may hold a bar, but none does: the first cell ends at " | ".
    for (const std::string& span : code_spans(std::string_view(line).substr(0, line.find(" | ", 2)))) {
      messages.push_back(span);
    }
    // What a message goes on with may stand in the last cell.
    const auto last = line.rfind(" | ", line.size() - 3);
    for (const std::string& span : code_spans(std::string_view(line).substr(last))) {
      if (span.find("{}") != std::string::npos) messages.push_back(span);
    }
  }
  return messages;
}

std::vector<std::string> fixed_pieces(std::string_view text) {
  static const std::regex differs(R"(\{[^}]*\}|%[-+.0-9]*[a-zA-Z]+|%[0-9]|\n)");
  std::vector<std::string> pieces;
  const std::string whole(text);
  for (std::sregex_token_iterator piece(whole.begin(), whole.end(), differs, -1), end; piece != end; ++piece) {
    if (std::string words = trimmed(piece->str()); !words.empty()) pieces.push_back(std::move(words));
  }
  return pieces;
}

bool fits(std::string_view message, std::string_view text) {
  std::size_t at = 0;
  for (const std::string& piece : fixed_pieces(message)) {
    at = text.find(piece, at);
    if (at == std::string_view::npos) return false;
    at += piece.size();
  }
  return true;
}

bool is_a_phrase(std::string_view piece) {
  int words = 0, letters = 0;
  for (const char c : piece) {
    letters = std::isalpha(static_cast<unsigned char>(c)) ? letters + 1 : 0;
    if (letters == 2) ++words;
  }
  return words >= 2;
}

std::vector<Literal> literals_that_tell(const fs::path& sources) {
  std::vector<Literal> literals;
  for (const fs::path& file : sources_in(sources)) {
    const std::string code = without_comments(content_of(file));
    for (const char* const opener : openers) {
      for (std::size_t at = code.find(opener); at != std::string::npos; at = code.find(opener, at)) {
        const auto line = 1 + std::count(code.begin(), code.begin() + static_cast<std::ptrdiff_t>(at), '\n');
        const std::string where = fs::relative(file, sources).string() + ":" + std::to_string(line);
        while (at < code.size() && code[at] != ';') {
          if (code[at] == '"') {
            literals.push_back({literal_at(code, at), where});
          } else {
            ++at;
          }
        }
      }
    }
  }
  return literals;
}

std::string all_literals(const fs::path& sources) {
  std::string all;
  for (const fs::path& file : sources_in(sources)) append_literals(without_comments(content_of(file)), all);
  return all;
}

std::string all_literals_of_tests(const fs::path& sources) {
  static const std::regex meets("_test\\.cpp$|/tests/.*\\.(py|cpp)$");
  std::string all;
  for (const char* const folder : {"io", "modes", "solver", "device", "plugin"}) {
    for (const auto& entry : fs::recursive_directory_iterator(sources / folder)) {
      const std::string name = entry.path().string();
      if (!std::regex_search(name, meets) || entry.path().filename() == "messages_test.cpp") continue;
      const std::string text = content_of(entry.path());
      append_literals(name.ends_with(".py") ? text : without_comments(text), all);
    }
  }
  return all;
}

}  // namespace palpate::plugin::testing

#pragma once

/// The messages to a user. Every message stands in a table, the messages.h of its module, with its reason and what to
/// do. Only a table can make a Text, and only a Text can make a refusal. A message that is in no table does not
/// compile.

#include <initializer_list>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>

namespace palpate {

struct Message {
  std::string_view id;
  std::string_view text;  ///< {} stands for a value
};

/// Messages with the same reason. A row of a table has room for 12.
struct MessageRow {
  std::string_view why;         ///< empty: the message itself says why
  std::string_view what_to_do;  ///< empty: the message itself says what to do
  Message messages[12];
};

/// A message with its values filled in. Empty: no message.
class Text : public std::string {
 public:
  Text() = default;

 private:
  explicit Text(std::string text) : std::string(std::move(text)) {}
  friend Text fill_message(std::string_view message, std::initializer_list<std::string> values);
  friend Text at_place(std::string_view place, const Text& text, std::string_view between);
  template <typename Error>
  friend class Saying;
};

/// An error with a Text.
template <typename Error>
class Saying : public Error {
 public:
  explicit Saying(const Text& text) : Error(text) {}
  Text text() const { return Text(this->what()); }
};
using Refusal = Saying<std::runtime_error>;          ///< of a file, a series, a device
using InvalidInput = Saying<std::invalid_argument>;  ///< of an impossible value

/// "place: text", where the place is a line, a key or an entry of a list.
inline Text at_place(std::string_view place, const Text& text, std::string_view between = ": ") {
  return Text(std::string(place).append(between).append(text));
}

inline Text fill_message(std::string_view message, std::initializer_list<std::string> values) {
  std::string text;
  for (const std::string& value : values) {
    const std::size_t place = message.find("{}");
    text.append(message.substr(0, place)).append(value);
    message.remove_prefix(place + 2);
  }
  return Text(text.append(message));
}

/// The message of an id, found in a module's tables by the compiler. An unknown id or a wrong number of values does not
/// compile.
template <std::size_t places, const auto&... tables>
class ChosenMessage {
 public:
  // NOLINTNEXTLINE(google-explicit-constructor): a call names the id alone.
  consteval ChosenMessage(const char* id) {
    (look_up(tables, id), ...);
    if (text_.empty()) throw "the module's messages.h has no message of this id";
    if (places_of(text_) != places) throw "the message has more or fewer {} than values are given";
  }
  template <typename... Values>
  Text filled(const Values&... values) const {
    return fill_message(text_, {in_words(values)...});
  }

 private:
  consteval void look_up(const auto& table, std::string_view id) {
    for (const MessageRow& row : table) {
      for (const Message& message : row.messages) {
        if (message.id == id) text_ = message.text;
      }
    }
  }
  static consteval std::size_t places_of(std::string_view text) {
    std::size_t count = 0;
    for (std::size_t at = text.find("{}"); at != std::string_view::npos; at = text.find("{}", at + 2)) ++count;
    return count;
  }
  template <typename Value>
  static std::string in_words(const Value& value) {
    if constexpr (std::is_convertible_v<const Value&, std::string_view>) {
      return std::string(std::string_view(value));
    } else {
      static_assert(std::is_integral_v<Value> && sizeof(Value) > 1, "a text or a count: other numbers need a format");
      return std::to_string(value);
    }
  }
  std::string_view text_;
};

}  // namespace palpate

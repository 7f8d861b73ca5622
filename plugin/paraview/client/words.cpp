#include "plugin/paraview/client/words.h"

#include <QCoreApplication>

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "device/messages.h"
#include "io/messages.h"
#include "plugin/messages/messages.h"

namespace palpate::plugin {
namespace {

/// What stands in a text for the {} of a message; nothing if it is not that message.
std::optional<std::vector<std::string_view>> values_in(std::string_view text, std::string_view message) {
  std::vector<std::string_view> values;
  std::size_t place = message.find("{}");
  if (place == std::string_view::npos) return text == message ? std::optional(values) : std::nullopt;
  if (!text.starts_with(message.substr(0, place))) return std::nullopt;
  text.remove_prefix(place);
  while (place != std::string_view::npos) {
    message.remove_prefix(place + 2);
    place = message.find("{}");
    const std::string_view between = message.substr(0, place);
    const std::size_t end = place == std::string_view::npos
                                ? (text.ends_with(between) ? text.size() - between.size() : std::string_view::npos)
                                : text.find(between);
    if (end == std::string_view::npos) return std::nullopt;
    values.push_back(text.substr(0, end));
    text.remove_prefix(end + between.size());
  }
  return values;
}

QString filled(QString message, const std::vector<std::string_view>& values) {
  int from = 0;
  for (const std::string_view value : values) {
    const QString in_full = QString::fromUtf8(value.data(), static_cast<int>(value.size()));
    const int place = static_cast<int>(message.indexOf(QLatin1String("{}"), from));
    if (place < 0) break;
    message.replace(place, 2, in_full);
    from = place + static_cast<int>(in_full.size());
  }
  return message;
}

}  // namespace

QString words(const Text& text) {
  using Table = std::span<const MessageRow>;
  for (const Table table :
       {Table(device::messages::styluses), Table(io::messages::series), Table(messages::paraview)}) {
    for (const MessageRow& row : table) {
      for (const Message& message : row.messages) {
        if (message.text.empty()) break;
        const auto values = values_in(text, message.text);
        if (!values) continue;
        const std::string english(message.text);
        const QString said = QCoreApplication::translate("Messages", english.c_str());
        if (said != QString::fromStdString(english)) return filled(said, *values);
      }
    }
  }
  return QString::fromStdString(text);
}

QString tissue_in_words(const std::string& name) {
  return QCoreApplication::translate("Tissues", name.c_str());
}

}  // namespace palpate::plugin

#include "io/archive/testing/telling.h"

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <set>

#include "io/archive/testing/upper_layer.h"

namespace palpate::io::testing {
namespace {

/// Without what pads it to its length.
std::string unpadded(std::string text) {
  while (!text.empty() && (text.back() == ' ' || text.back() == '\0')) text.pop_back();
  return text;
}

/// The classes that the caller wants to be sent to it (PS3.7 D.3.3.4).
std::set<std::string> received_by(const std::string& request) {
  std::set<std::string> classes;
  for (const auto& [type, content] : items(request, 68)) {
    if (type != 0x50) continue;
    for (const auto& [kind, part] : items(content, 0)) {
      if (kind != 0x54) continue;
      const std::size_t length = number(part, 0, 2, true);
      if (part.at(2 + length + 1) == 1) classes.insert(part.substr(2, length));
    }
  }
  return classes;
}

}  // namespace

void tell_association(const std::string& request) {
  std::printf("%s calls %s\n", unpadded(request.substr(20, 16)).c_str(), unpadded(request.substr(4, 16)).c_str());
  const std::set<std::string> received = received_by(request);
  for (const auto& [type, content] : items(request, 68)) {
    if (type != 0x20) continue;
    std::string abstract, transfer;
    for (const auto& [kind, part] : items(content, 4)) {
      if (kind == 0x30) abstract = unpadded(part);
      if (kind == 0x40) transfer.append(1, ' ').append(unpadded(part));
    }
    std::printf("context %d %s%s%s\n", static_cast<unsigned char>(content[0]), abstract.c_str(),
                received.contains(abstract) ? " receives" : "", transfer.c_str());
  }
  std::fflush(stdout);
}

void tell_command(const Elements& command, const Elements& keys) {
  const auto named = [](const char* name, const std::string& value) {
    std::string words(1, ' ');
    words.append(name).append(1, ' ').append(value);
    return words;
  };
  const auto text = [&](std::uint32_t tag, const char* name) {
    return command.contains(tag) ? named(name, unpadded(command.at(tag))) : std::string();
  };
  const auto value = [&](std::uint32_t tag, const char* name) {
    if (!command.contains(tag)) return std::string();
    return named(name, std::to_string(number(command.at(tag), 0, 2, false)));
  };
  std::printf("command %04X%s%s%s%s%s%s%s\n", static_cast<unsigned>(number(command.at(0x00000100), 0, 2, false)),
              value(0x00000110, "id").c_str(), value(0x00000120, "to").c_str(), value(0x00000700, "priority").c_str(),
              value(0x00000900, "status").c_str(), text(0x00000002, "class").c_str(),
              text(0x00001000, "object").c_str(), text(0x00000600, "destination").c_str());
  for (const auto& [tag, key] : keys) {
    if ((tag & 0xFFFFU) == 0) continue;  // a group's length
    std::printf("key %08X %s\n", static_cast<unsigned>(tag), unpadded(key).c_str());
  }
  std::fflush(stdout);
}

}  // namespace palpate::io::testing

#include "io/archive/testing/upper_layer.h"

#include <sys/socket.h>

#include <thread>

namespace palpate::io::testing {

std::string big(std::uint32_t value, int bytes) {
  std::string text;
  for (int n = bytes - 1; n >= 0; --n) text += static_cast<char>(value >> (8 * n) & 0xFFU);
  return text;
}

std::string little(std::uint32_t value, int bytes) {
  const std::string text = big(value, bytes);
  return {text.rbegin(), text.rend()};
}

std::uint32_t number(const std::string& text, std::size_t at, int bytes, bool is_big) {
  std::uint32_t value = 0;
  for (int n = 0; n < bytes; ++n) {
    const auto byte = static_cast<unsigned char>(text.at(at + static_cast<std::size_t>(is_big ? n : bytes - 1 - n)));
    value = value << 8U | byte;
  }
  return value;
}

std::string even(std::string text, char pad) {
  if (text.size() % 2 != 0) text += pad;
  return text;
}

void write_all(int socket, const std::string& bytes) {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t n = send(socket, bytes.data() + done, bytes.size() - done, MSG_NOSIGNAL);
    if (n <= 0) throw Gone();
    done += static_cast<std::size_t>(n);
  }
}

std::string read_all(int socket, std::size_t count) {
  std::string bytes(count, '\0');
  for (std::size_t done = 0; done < count;) {
    const ssize_t n = recv(socket, bytes.data() + done, count - done, 0);
    if (n <= 0) throw Gone();
    done += static_cast<std::size_t>(n);
  }
  return bytes;
}

Pdu read_pdu(int socket) {
  const std::string head = read_all(socket, 6);
  return {head[0], read_all(socket, number(head, 2, 4, true))};
}

void write_pdu(int socket, int type, const std::string& body) {
  write_all(socket,
            std::string(1, static_cast<char>(type)) + '\0' + big(static_cast<std::uint32_t>(body.size()), 4) + body);
}

std::string item(int type, const std::string& body) {
  return std::string(1, static_cast<char>(type)) + '\0' + big(static_cast<std::uint32_t>(body.size()), 2) + body;
}

std::vector<std::pair<int, std::string>> items(const std::string& body, std::size_t at) {
  std::vector<std::pair<int, std::string>> result;
  while (at + 4 <= body.size()) {
    const std::size_t length = number(body, at + 2, 2, true);
    result.emplace_back(static_cast<unsigned char>(body[at]), body.substr(at + 4, length));
    at += 4 + length;
  }
  return result;
}

std::map<int, std::string> accept(int socket, const std::string& request, bool agrees) {
  std::map<int, std::string> contexts;
  std::string answer = request.substr(0, 68);
  std::string user = item(0x51, big(16384, 4)) + item(0x52, "1.2.3.4");
  for (const auto& [type, content] : items(request, 68)) {
    if (type == 0x10) answer += item(0x10, content);
    if (type == 0x50) {
      for (const auto& [kind, part] : items(content, 0)) {
        if (kind == 0x54) user += item(0x54, part);  // roles, as proposed
      }
    }
    if (type != 0x20) continue;
    std::string abstract, transfer;
    for (const auto& [kind, part] : items(content, 4)) {
      if (kind == 0x30) abstract = part;
      if (kind == 0x40 && transfer.empty()) transfer = part;
    }
    contexts.emplace(static_cast<unsigned char>(content[0]), abstract);
    const char result = agrees ? '\0' : '\3';
    answer += item(0x21, content.substr(0, 1) + '\0' + result + '\0' + item(0x40, transfer));
  }
  write_pdu(socket, 2, answer + item(0x50, user));
  return contexts;
}

std::string pdv(int context, bool command, bool last, const std::string& bytes) {
  return big(static_cast<std::uint32_t>(bytes.size() + 2), 4) + static_cast<char>(context) +
         static_cast<char>((command ? 1 : 0) | (last ? 2 : 0)) + bytes;
}

std::string read_part(int socket, int& context, std::chrono::microseconds pause) {
  std::string part;
  while (true) {
    if (pause.count() > 0) std::this_thread::sleep_for(pause);
    const Pdu pdu = read_pdu(socket);
    if (pdu.type == 5) {
      write_pdu(socket, 6, std::string(4, '\0'));
      throw Gone(pdu.type);
    }
    if (pdu.type != 4) throw Gone(pdu.type);
    context = static_cast<unsigned char>(pdu.body.at(4));
    part += pdu.body.substr(6);
    if ((pdu.body.at(5) & 2) != 0) return part;
  }
}

}  // namespace palpate::io::testing

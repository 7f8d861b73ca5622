// An archive that misbehaves, for tests: `odd_archive BEHAVIOR [PORT]`. It speaks DICOM's upper layer (PS3.8) byte by
// byte and knows nothing of DCMTK, so that it can do what no library would. Prints its own port, then serves one
// connection after the other until its input ends. PORT is where a C-MOVE's images go.

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace {

struct Gone : std::runtime_error {
  Gone() : std::runtime_error("the peer is gone") {}
};

constexpr const char* ct_image = "1.2.840.10008.5.1.4.1.1.2";

// --- Bytes.

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

std::string even(std::string text, char pad = '\0') {
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

// --- The upper layer.

struct Pdu {
  int type = 0;
  std::string body;
};

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

/// The items of a body from an offset on: type and content.
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

/// A message part (command or dataset) from its first PDU to its last.
std::string read_part(int socket, int& context) {
  std::string part;
  while (true) {
    const Pdu pdu = read_pdu(socket);
    if (pdu.type == 5) {
      write_pdu(socket, 6, std::string(4, '\0'));
      throw Gone();
    }
    if (pdu.type != 4) throw Gone();
    context = static_cast<unsigned char>(pdu.body.at(4));
    part += pdu.body.substr(6);
    if ((pdu.body.at(5) & 2) != 0) return part;
  }
}

// --- Messages.

using Elements = std::map<std::uint32_t, std::string>;

std::string element(std::uint32_t tag, const std::string& value) {  // implicit VR
  return little(tag >> 16U, 2) + little(tag & 0xFFFFU, 2) + little(static_cast<std::uint32_t>(value.size()), 4) + value;
}

Elements parse_implicit(const std::string& text) {
  Elements result;
  for (std::size_t at = 0; at + 8 <= text.size();) {
    const std::uint32_t tag = number(text, at, 2, false) << 16U | number(text, at + 2, 2, false);
    const std::size_t length = number(text, at + 4, 4, false);
    result[tag] = text.substr(at + 8, length);
    at += 8 + length;
  }
  return result;
}

/// Explicit VR with short lengths: all that a question holds.
Elements parse_explicit(const std::string& text) {
  Elements result;
  for (std::size_t at = 0; at + 8 <= text.size();) {
    const std::uint32_t tag = number(text, at, 2, false) << 16U | number(text, at + 2, 2, false);
    const std::size_t length = number(text, at + 6, 2, false);
    result[tag] = text.substr(at + 8, length);
    at += 8 + length;
  }
  return result;
}

std::string with_length(const std::string& elements) {
  return element(0x00000000, little(static_cast<std::uint32_t>(elements.size()), 4)) + elements;
}

void write_message(int socket, int context, const std::string& command, const std::string& dataset = {}) {
  write_pdu(socket, 4, pdv(context, true, true, with_length(command)));
  if (!dataset.empty()) write_pdu(socket, 4, pdv(context, false, true, dataset));
}

struct Request {
  int context = 0, field = 0;
  std::uint32_t id = 0;
  std::string sop_class;
  Elements keys;
};

std::string uid_of(const std::string& text) {
  return text.c_str();  // without its padding
}

void respond(int socket, const Request& request, std::uint32_t status, const std::string& dataset = {},
             int completed = 0, int failed = 0) {
  std::string command = element(0x00000002, even(request.sop_class)) +
                        element(0x00000100, little(static_cast<std::uint32_t>(request.field) | 0x8000U, 2)) +
                        element(0x00000120, little(request.id, 2)) +
                        element(0x00000800, little(dataset.empty() ? 0x0101 : 0, 2)) +
                        element(0x00000900, little(status, 2));
  if (request.field == 0x10 || request.field == 0x21) {
    command += element(0x00001020, little(0, 2)) +
               element(0x00001021, little(static_cast<std::uint32_t>(completed), 2)) +
               element(0x00001022, little(static_cast<std::uint32_t>(failed), 2)) + element(0x00001023, little(0, 2));
  }
  write_message(socket, request.context, command, dataset);
}

// --- Objects, explicit VR.

std::string field(std::uint32_t tag, const char* vr, const std::string& value) {
  return little(tag >> 16U, 2) + little(tag & 0xFFFFU, 2) + vr + little(static_cast<std::uint32_t>(value.size()), 2) +
         value;
}

std::string image(const std::string& instance, const std::string& study, const std::string& series) {
  return field(0x00080016, "UI", even(ct_image)) + field(0x00080018, "UI", even(instance)) +
         field(0x0020000D, "UI", even(study)) + field(0x0020000E, "UI", even(series)) + field(0x00200013, "IS", "1 ");
}

std::string store_command(const std::string& instance) {
  return element(0x00000002, even(ct_image)) + element(0x00000100, little(1, 2)) + element(0x00000110, little(77, 2)) +
         element(0x00000700, little(0, 2)) + element(0x00000800, little(0, 2)) + element(0x00001000, even(instance));
}

int context_of(const std::map<int, std::string>& contexts, const std::string& sop_class) {
  for (const auto& [id, name] : contexts) {
    if (name == sop_class) return id;
  }
  throw Gone();
}

/// Sends an image; its status in the answer.
std::uint32_t store(int socket, int context, const std::string& instance, const std::string& dataset) {
  write_message(socket, context, store_command(instance), dataset);
  int id = 0;
  Elements answer = parse_implicit(read_part(socket, id));
  const std::uint32_t status = number(answer.at(0x00000900), 0, 2, false);
  std::printf("stored %04X\n", status);
  std::fflush(stdout);
  return status;
}

void begin_image(int socket, int context, const std::string& study) {
  const std::string start = image("1.2.3.9", study, "1.2.3.1") + field(0x00280002, "US", little(1, 2));
  const std::string pixels = little(0x7FE0, 2) + little(0x0010, 2) + "OW" + little(0, 2) + little(0xFFFFFFFEU, 4);
  write_pdu(socket, 4, pdv(context, true, true, with_length(store_command("1.2.3.9"))));
  write_pdu(socket, 4, pdv(context, false, false, start + pixels));
}

void send_without_end(int socket, int context, const std::string& study) {
  begin_image(socket, context, study);
  const std::string block(16000, 'x');
  for (std::uint64_t sent = 0; sent < 3ULL << 30U; sent += block.size()) {
    write_pdu(socket, 4, pdv(context, false, false, block));
  }
}

/// A byte a while in the midst of a PDU: never silent, and never done.
void drip(int socket, int context, const std::string& study) {
  begin_image(socket, context, study);
  write_all(socket, std::string("\4\0", 2) + big(16006, 4) + big(16002, 4) + static_cast<char>(context) + '\0');
  for (int n = 0; n < 600; ++n) {
    write_all(socket, "x");
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
}

/// What the store service that we connect to says to someone whom it does not know: 3 rejects.
void call_as_stranger(int port) {
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) {
    const std::string context = std::string("\1\0\0\0", 4) + item(0x30, ct_image) + item(0x40, "1.2.840.10008.1.2.1");
    std::string called = "PALPATE", calling = "STRANGER";
    called.resize(16, ' ');
    calling.resize(16, ' ');
    write_pdu(socket, 1,
              std::string("\0\1\0\0", 4) + called + calling + std::string(32, '\0') +
                  item(0x10, "1.2.840.10008.3.1.1.1") + item(0x20, context) +
                  item(0x50, item(0x51, big(16384, 4)) + item(0x52, "1.2.3.4")));
    std::printf("stranger %d\n", read_pdu(socket).type);
    std::fflush(stdout);
  }
  close(socket);
}

// --- Behaviors.

class Serving {
 public:
  Serving(int socket, std::string behavior, int port) : socket_(socket), behavior_(std::move(behavior)), port_(port) {}

  void serve() {
    if (behavior_ == "not-dicom") {
      write_all(socket_, "HTTP/1.1 400 Bad Request\r\n\r\n");
      return;
    }
    const Pdu request = read_pdu(socket_);
    if (behavior_ == "silent") std::this_thread::sleep_for(std::chrono::seconds(60));
    if (behavior_ == "refuse") return reject(1);
    if (behavior_ == "wrong-calling") return reject(3);
    if (behavior_ == "wrong-called") return reject(7);
    if (behavior_ == "busy") return write_pdu(socket_, 3, std::string("\0\2\3\1", 4));
    contexts_ = accept(socket_, request.body, behavior_ != "offers-nothing");
    while (true) answer(read_request());
  }

 private:
  void reject(int reason) { write_pdu(socket_, 3, std::string("\0\1\1", 3) + static_cast<char>(reason)); }

  Request read_request() {
    Request request;
    Elements command = parse_implicit(read_part(socket_, request.context));
    request.field = static_cast<int>(number(command.at(0x00000100), 0, 2, false));
    if (command.contains(0x00000110)) request.id = number(command.at(0x00000110), 0, 2, false);
    if (command.contains(0x00000002)) request.sop_class = uid_of(command.at(0x00000002));
    if (number(command.at(0x00000800), 0, 2, false) != 0x0101) {
      const std::string dataset = read_part(socket_, request.context);
      if (request.field != 1) request.keys = parse_explicit(dataset);
    }
    return request;
  }

  void answer(const Request& request) {
    if (request.field == 0x0FFF) return;  // cancel
    if (request.field == 0x20) return find(request);
    if (request.field == 0x10) return get(request);
    if (request.field == 0x21) return move(request);
    if (behavior_ == "refuses-store") return respond(socket_, request, 0xA900);
    if (behavior_ == "echoes-at-store") return echo(request);
    respond(socket_, request, behavior_ == "refuses-echo" ? 0x0122 : 0);
  }

  /// The answer to another question than the one that was asked.
  void echo(Request request) {
    request.field = 0x30;
    respond(socket_, request, 0);
  }

  void find(const Request& request) {
    if (behavior_ == "dies-at-find") std::_Exit(0);
    if (behavior_ == "echoes") return echo(request);
    if (behavior_ == "garbage") return respond(socket_, request, 0xFF00, std::string(5, '\7') + std::string(5, '\xFF'));
    if (behavior_ == "refuses-find") return respond(socket_, request, 0xA700);
    const std::string study = request.keys.contains(0x0020000D) ? uid_of(request.keys.at(0x0020000D)) : std::string();
    const bool all = behavior_ == "endless-find";
    const std::string match = field(0x00080005, "CS", "ISO_IR 100") + field(0x00080052, "CS", "STUDY ") +
                              field(0x00100010, "PN", "M\xFCller^Zo\xEB ") +
                              field(0x0020000D, "UI", even(study.empty() ? "1.2.3" : study)) +
                              field(0x00201208, "IS", behavior_ == "grows" ? "9 " : "2 ");
    if (behavior_ == "huge-answer") {
      write_pdu(socket_, 4,
                pdv(request.context, true, true,
                    with_length(element(0x00000100, little(0x8020, 2)) + element(0x00000120, little(request.id, 2)) +
                                element(0x00000800, little(0, 2)) + element(0x00000900, little(0xFF00, 2)))));
      for (int n = 0; n < 1000; ++n) write_pdu(socket_, 4, pdv(request.context, false, false, std::string(16000, 'x')));
    }
    const bool is_study = uid_of(request.keys.at(0x00080052)).starts_with("STUDY");
    const int count = all ? 100000 : behavior_ == "two-studies" && is_study ? 2 : 1;
    for (int n = 0; n < count; ++n) {
      respond(socket_, request, 0xFF00, match);
      pollfd ready{socket_, POLLIN, 0};
      if (all && poll(&ready, 1, 0) > 0) {
        const Request cancel = read_request();
        std::printf("canceled %04X after %d\n", static_cast<unsigned>(cancel.field), n);
        std::fflush(stdout);
        return respond(socket_, request, 0xFE00);
      }
    }
    respond(socket_, request, 0);
  }

  void get(const Request& request) {
    const std::string study = uid_of(request.keys.at(0x0020000D));
    const int context = context_of(contexts_, ct_image);
    const auto send = [&](const std::string& instance, const std::string& of, const std::string& series) {
      return store(socket_, context, instance, image(instance, of, series)) == 0;
    };
    if (behavior_ == "echoes-at-get") return echo(request);
    if (behavior_ == "empty") return respond(socket_, request, 0);
    if (behavior_ == "all-fail") return respond(socket_, request, 0xB000, {}, 0, 2);
    if (behavior_ == "partly-unasked") {
      send("1.2.3.4", study, "1.2.3.1");
      send("1.2.3.5", "9.9.9", "1.2.3.1");
      return respond(socket_, request, 0, {}, 2);
    }
    if (behavior_ == "without-end") send_without_end(socket_, context, study);
    if (behavior_ == "drips") drip(socket_, context, study);
    if (behavior_ == "dies-midway") {
      send("1.2.3.4", study, "1.2.3.1");
      begin_image(socket_, context, study);
      std::_Exit(0);
    }
    if (behavior_ == "falls-silent") {
      begin_image(socket_, context, study);
      std::this_thread::sleep_for(std::chrono::seconds(60));
    }
    if (behavior_ == "unasked") {
      send("1.2.3.4", "9.9.9", "1.2.3.1");
      return respond(socket_, request, 0xB000, {}, 0, 1);
    }
    if (behavior_ == "paths") {
      send("../../../../evil", study, "../../../../tmp/evil/series");
      send("/etc/evil", study, "/etc/evil");
      return respond(socket_, request, 0, {}, 2);
    }
    if (behavior_ == "half") {
      send("1.2.3.4", study, "1.2.3.1");
      return respond(socket_, request, 0xB000, field(0x00080058, "UI", "1.2.3.6\\1.2.3.7\\1.2.3.8 "), 1, 3);
    }
    if (behavior_ == "out-of-resources") return respond(socket_, request, 0xA702);
    send("1.2.3.4", study, "1.2.3.1");
    send("1.2.3.4", study, "1.2.3.1");  // the same once more
    send("1.2.3.5", study, "1.2.3.1");
    respond(socket_, request, 0, {}, 2);
  }

  void move(const Request& request) {
    if (behavior_ == "unknown-destination") return respond(socket_, request, 0xA801);
    if (behavior_ == "stranger") call_as_stranger(port_);
    respond(socket_, request, 0, {}, 2);
  }

  int socket_;
  std::string behavior_;
  int port_;
  std::map<int, std::string> contexts_;
};

void serve_all(int listening, const std::string& behavior, int port) {
  while (true) {
    pollfd ready[] = {{listening, POLLIN, 0}, {STDIN_FILENO, POLLIN, 0}};
    poll(ready, 2, -1);
    if (ready[1].revents != 0) return;
    const int socket = accept4(listening, nullptr, nullptr, SOCK_CLOEXEC);
    if (socket < 0) continue;
    try {
      Serving(socket, behavior, port).serve();
    } catch (const std::exception&) {  // the peer is gone, or sent what cannot be read
    }
    close(socket);
  }
}

}  // namespace

int main(int count, char** arguments) {
  const int listening = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  if (count < 2 || bind(listening, reinterpret_cast<const sockaddr*>(&address), size) != 0 ||
      listen(listening, 8) != 0 || getsockname(listening, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
    return 1;
  }
  std::printf("%d\n", ntohs(address.sin_port));
  std::fflush(stdout);
  // Ended with its test, also where it is in the midst of something.
  std::thread([] {
    pollfd input{STDIN_FILENO, POLLIN, 0};
    poll(&input, 1, -1);
    std::_Exit(0);
  }).detach();
  serve_all(listening, arguments[1], count > 2 ? std::atoi(arguments[2]) : 0);
  return 0;
}

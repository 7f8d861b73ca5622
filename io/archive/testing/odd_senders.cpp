#include "io/archive/testing/odd_senders.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <thread>

#include "io/archive/testing/dimse.h"
#include "io/archive/testing/telling.h"
#include "io/archive/testing/upper_layer.h"

namespace palpate::io::testing {

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

void drip(int socket, int context, const std::string& study) {
  begin_image(socket, context, study);
  write_all(socket, std::string("\4\0", 2) + big(16006, 4) + big(16002, 4) + static_cast<char>(context) + '\0');
  for (int n = 0; n < 600; ++n) {
    write_all(socket, "x");
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
}

int call(int port, std::string calling, std::string called) {
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    close(socket);
    return -1;
  }
  const std::string context = std::string("\1\0\0\0", 4) + item(0x30, ct_image) + item(0x40, "1.2.840.10008.1.2.1");
  const std::string echo =
      std::string("\3\0\0\0", 4) + item(0x30, "1.2.840.10008.1.1") + item(0x40, "1.2.840.10008.1.2.1");
  called.resize(16, ' ');
  calling.resize(16, ' ');
  write_pdu(socket, 1,
            std::string("\0\1\0\0", 4) + called + calling + std::string(32, '\0') +
                item(0x10, "1.2.840.10008.3.1.1.1") + item(0x20, context) + item(0x20, echo) +
                item(0x50, item(0x51, big(16384, 4)) + item(0x52, "1.2.3.4")));
  return socket;
}

void call_hesitantly(int port) {
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) {
    write_all(socket, std::string("\1\0\0\0\4\0", 6));
    pollfd heard{socket, POLLIN, 0};
    for (int n = 0; n < 300 && poll(&heard, 1, 200) == 0; ++n) write_all(socket, "x");
  }
  close(socket);
}

void call_as_stranger(int port, bool knows_us) {
  const int socket = knows_us ? call(port, "STRANGER") : call(port, "ODD", "SOMEONE");
  if (socket < 0) return;
  const Pdu answer = read_pdu(socket);
  std::printf("stranger %d for %d\n", answer.type, answer.body.at(3));
  std::fflush(stdout);
  close(socket);
}

void call_and_hang_up(int port, int others) {
  const int first = call(port, "ODD");
  if (first < 0) return;
  read_pdu(first);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  for (int n = 0; n < others; ++n) {
    const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
    const linger at_once{1, 0};  // closing resets
    setsockopt(socket, SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
    connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address);
    close(socket);
  }
  write_pdu(first, 5, std::string(4, '\0'));
  read_pdu(first);
  close(first);
}

void talk(int port, const std::string& study, bool asks, const std::string& title) {
  const int socket = call(port, title);
  if (socket < 0) return;
  read_pdu(socket);
  int context = 0;
  const auto answer = [&] { tell_command(parse_implicit(read_part(socket, context)), {}); };
  write_message(socket, 3,
                element(0x00000002, even("1.2.840.10008.1.1")) + element(0x00000100, little(0x30, 2)) +
                    element(0x00000110, little(5, 2)) + element(0x00000800, little(0x0101, 2)),
                {});
  answer();
  write_message(socket, 1, store_command("1.2.3.4"), image("1.2.3.4", study, "1.2.3.1"));
  answer();
  if (asks) {
    write_message(socket, 1,
                  element(0x00000002, even(ct_image)) + element(0x00000100, little(0x20, 2)) +
                      element(0x00000110, little(6, 2)) + element(0x00000700, little(0, 2)) +
                      element(0x00000800, little(0, 2)),
                  field(0x00080052, "CS", "STUDY "));
  } else {
    write_pdu(socket, 5, std::string(4, '\0'));
  }
  std::printf("ends with %d\n", read_pdu(socket).type);
  std::fflush(stdout);
  close(socket);
}

void send_slowly(int port, const std::string& study) {
  const int socket = call(port, "ODD");
  if (socket < 0) return;
  read_pdu(socket);
  begin_image(socket, 1, study);
  for (int n = 0; n < 50; ++n) {
    write_pdu(socket, 4, pdv(1, false, n == 49, std::string(1000, 'x')));
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  int context = 0;
  read_part(socket, context);  // the answer
  close(socket);
}

}  // namespace palpate::io::testing

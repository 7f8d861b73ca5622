// A misbehaving archive for tests: `odd_archive BEHAVIOR [PORT]`. It speaks DICOM's upper layer (PS3.8) byte by byte
// without DCMTK, so it can break the rules as no library would. Prints its own port, then serves one connection after
// the other until its input ends. PORT is the target of a C-MOVE's images. The behavior `tells` is correct, and prints
// the requests.

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <thread>
#include <utility>

#include "io/archive/testing/dimse.h"
#include "io/archive/testing/odd_senders.h"
#include "io/archive/testing/telling.h"
#include "io/archive/testing/upper_layer.h"

namespace palpate::io::testing {
namespace {

bool has_sent = false;  // all that was asked for

class Serving {
 public:
  Serving(int socket, std::string behavior, int port)
      : socket_(socket), behavior_(std::move(behavior)), port_(port), tells_(behavior_.starts_with("tells")) {}

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
    if (behavior_ == "busy" || (behavior_ == "busy-afterwards" && has_sent)) {
      return write_pdu(socket_, 3, std::string("\0\2\3\1", 4));
    }
    if (tells_) tell_association(request.body);
    contexts_ = accept(socket_, request.body, behavior_ != "offers-nothing");
    while (true) answer(read_request());
  }
  /// What ended it: the peer's release (5) or abort (7), or its connection (0).
  void tell_end(int type) const {
    if (!tells_) return;
    std::printf("ended by %d\n", type);
    std::fflush(stdout);
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
      // 2048 pieces, as a file of 32 MiB has, take 5 s.
      const std::chrono::microseconds pause(behavior_ == "reads-slowly" ? 2500 : 0);
      const std::string dataset = read_part(socket_, request.context, pause);
      if (request.field != 1) request.keys = parse_explicit(dataset);
    }
    if (tells_) tell_command(command, request.keys);
    return request;
  }

  void answer(const Request& request) {
    if (request.field == 0x0FFF) return;  // cancel
    if (request.field == 0x20) return find(request);
    if (request.field == 0x10) return get(request);
    if (request.field == 0x21) return move(request);
    if (behavior_ == "silent-at-store") std::this_thread::sleep_for(std::chrono::seconds(60));
    if (behavior_ == "changes-at-store") return respond(socket_, request, 0xB000);
    if (behavior_ == "leaves-out-at-store") return respond(socket_, request, 0xB006);
    if (behavior_ == "doubts-at-store") return respond(socket_, request, 0xB007);
    if (behavior_ == "refuses-store") return respond(socket_, request, 0xA900);
    if (behavior_ == "echoes-at-store") return echo(request);
    respond(socket_, request, behavior_ == "refuses-echo" ? 0x0122 : 0);
  }

  /// A command that says that a dataset follows.
  static std::string find_pending(const Request& request) {
    return pdv(request.context, true, true,
               with_length(element(0x00000100, little(0x8020, 2)) + element(0x00000120, little(request.id, 2)) +
                           element(0x00000800, little(0, 2)) + element(0x00000900, little(0xFF00, 2))));
  }

  /// A study of the behavior as-its-uid-says is 1.2.3 and four digits: images that come, objects of another study that
  /// come, images that fail, and how many images it is said to have. Of 0 nothing is said.
  static int digit(const std::string& study, std::size_t n) { return study.at(6 + 2 * n) - '0'; }

  /// The answer to a different request.
  void echo(Request request) {
    request.field = 0x30;
    respond(socket_, request, 0);
  }

  void find(const Request& request) {
    if (behavior_ == "dies-at-find") std::_Exit(0);
    if (behavior_ == "echoes") return echo(request);
    if (behavior_ == "garbage") return respond(socket_, request, 0xFF00, std::string(5, '\7') + std::string(5, '\xFF'));
    if (behavior_ == "refuses-find") return respond(socket_, request, 0xA700);
    if (behavior_ == "cancels-itself") return respond(socket_, request, 0xFE00);
    if (behavior_ == "pends-without-data") {
      respond(socket_, request, 0xFF00);
      return respond(socket_, request, 0);
    }
    if (behavior_ == "dies-in-an-answer") {
      write_pdu(socket_, 4, find_pending(request));
      std::_Exit(0);
    }
    const std::string study = request.keys.contains(0x0020000D) ? uid_of(request.keys.at(0x0020000D)) : std::string();
    if (behavior_ == "tells-of-series" && uid_of(request.keys.at(0x00080052)).starts_with("STUDY")) {
      return respond(socket_, request, 0);
    }
    if (behavior_ == "tells-of-other") return echo(request);
    if (behavior_ == "forgets-afterwards" && has_sent) return respond(socket_, request, 0);
    if (behavior_ == "several") return find_several(request);
    if (behavior_ == "tells-late") throw Gone(read_pdu(socket_).type);
    if (behavior_ == "tells-and-errs") return write_message(socket_, request.context, "nonsense", {});
    if (behavior_ == "says-nothing") {  // one fragment without a byte
      write_pdu(socket_, 4, find_pending(request) + pdv(request.context, false, true, {}));
      return respond(socket_, request, 0);
    }
    const bool all = behavior_ == "endless-find";
    std::string images = behavior_ == "grows" ? "9 " : "2 ";
    if (behavior_ == "as-its-uid-says") {
      images = digit(study, 3) == 0 ? std::string() : std::to_string(digit(study, 3)) + " ";
    }
    const std::string match = field(0x00080005, "CS", "ISO_IR 100") + field(0x00080052, "CS", "STUDY ") +
                              field(0x00100010, "PN", "M\xFCller^Zo\xEB ") +
                              field(0x0020000D, "UI", even(study.empty() ? "1.2.3" : study)) +
                              field(0x0020000E, "UI", even("1.2.3.1")) + field(0x00201208, "IS", images);
    if (behavior_ == "huge-answer") {
      write_pdu(socket_, 4, find_pending(request));
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

  /// Three of each level, unsorted, each with its own data.
  void find_several(const Request& request) {
    struct One {
      const char *date, *number, *images, *description;
    };
    constexpr std::array all{One{"20210301", "20", "5 ", "Localizer "}, One{"20240115", "1 ", "7 ", "Thin slices "},
                             One{"20231231", "3 ", "40", "Thick slices"}};
    const bool is_study = uid_of(request.keys.at(0x00080052)).starts_with("STUDY");
    for (std::size_t n = 0; n < all.size(); ++n) {
      const std::string last = std::string(1, '.').append(std::to_string(n + 1));
      const std::string study = is_study ? std::string("1.2.3").append(last) : uid_of(request.keys.at(0x0020000D));
      std::string match = is_study ? field(0x00080020, "DA", all[n].date) : std::string();
      match +=
          field(is_study ? 0x00081030 : 0x0008103E, "LO", all[n].description) + field(0x0020000D, "UI", even(study));
      if (!is_study) {
        match += field(0x0020000E, "UI", even(study + last)) + field(0x00200011, "IS", all[n].number) +
                 field(0x00201209, "IS", all[n].images);
      }
      respond(socket_, request, 0xFF00, match);
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
    if (behavior_ == "as-its-uid-says") {
      const int sent = digit(study, 0), unasked = digit(study, 1), failed = digit(study, 2);
      for (int n = 0; n < sent; ++n) send(study + ".1" + std::to_string(n), study, study + ".1");
      for (int n = 0; n < unasked; ++n) send(study + ".2" + std::to_string(n), "9.9.9", "9.9.9.1");
      return respond(socket_, request, failed > 0 ? 0xB000 : 0, {}, sent, failed);
    }
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
    if (behavior_ == "fails-much") {
      send("1.2.3.4", study, "1.2.3.1");
      std::string failed = "1.2.3.10";
      for (int n = 11; n < 40; ++n)
        failed += n == 12 ? "\\1\x80" : n == 13 ? "\\1\x7F" : "\\1.2.3." + std::to_string(n);
      return respond(socket_, request, 0xB000, field(0x00080058, "UI", even(failed)), 1, 30);
    }
    if (behavior_ == "out-of-resources") return respond(socket_, request, 0xA702);
    if (behavior_ == "gives-up-midway" || behavior_ == "stops-midway") {
      send("1.2.3.4", study, "1.2.3.1");
      return respond(socket_, request, 0xA702, {}, 1, behavior_ == "gives-up-midway" ? 1 : 0);
    }
    send("1.2.3.4", study, "1.2.3.1");
    send("1.2.3.4", study, "1.2.3.1");  // the same once more
    send("1.2.3.5", study, "1.2.3.1");
    has_sent = true;
    respond(socket_, request, 0, {}, 2);
  }

  void move(const Request& request) {
    if (behavior_ == "unknown-destination") return respond(socket_, request, 0xA801);
    if (behavior_ == "stranger" || behavior_ == "misdials") call_as_stranger(port_, behavior_ == "stranger");
    if (behavior_ == "breaks-off-at-move") {
      const int socket = call(port_, "ODD");
      if (socket >= 0) read_pdu(socket);
      begin_image(socket, 1, uid_of(request.keys.at(0x0020000D)));
      close(socket);
    }
    if (behavior_ == "others-hang-up") call_and_hang_up(port_, 5);
    if (behavior_ == "tells-all" || behavior_ == "tells-and-asks" || behavior_ == "others-hang-up" ||
        behavior_ == "tells-its-title-with-spaces") {
      talk(port_, uid_of(request.keys.at(0x0020000D)), behavior_ == "tells-and-asks",
           behavior_ == "tells-its-title-with-spaces" ? "  ODD" : "ODD");
      return respond(socket_, request, 0, {}, 1);
    }
    if (behavior_ == "falls-silent-at-move") {
      const int socket = call(port_, "ODD");
      if (socket >= 0) read_pdu(socket);
      std::this_thread::sleep_for(std::chrono::seconds(60));
    }
    if (behavior_ == "drips-at-move") {
      const int socket = call(port_, "ODD");
      if (socket >= 0) read_pdu(socket);
      drip(socket, 1, uid_of(request.keys.at(0x0020000D)));
    }
    if (behavior_ == "sends-slowly" || behavior_ == "calls-hesitantly-first") {
      if (behavior_ == "calls-hesitantly-first") call_hesitantly(port_);
      send_slowly(port_, uid_of(request.keys.at(0x0020000D)));
      return respond(socket_, request, 0, {}, 1);
    }
    respond(socket_, request, 0, {}, 2);
  }

  int socket_;
  std::string behavior_;
  int port_;
  bool tells_;
  std::map<int, std::string> contexts_;
};

void serve_all(int listening, const std::string& behavior, int port) {
  while (true) {
    pollfd ready[] = {{listening, POLLIN, 0}, {STDIN_FILENO, POLLIN, 0}};
    poll(ready, 2, -1);
    if (ready[1].revents != 0) return;
    const int socket = accept4(listening, nullptr, nullptr, SOCK_CLOEXEC);
    if (socket < 0) continue;
    Serving serving(socket, behavior, port);
    try {
      serving.serve();
    } catch (const Gone& gone) {
      serving.tell_end(gone.type);
    } catch (const std::exception&) {  // it sent what cannot be read
    }
    close(socket);
  }
}

}  // namespace
}  // namespace palpate::io::testing

int main(int count, char** arguments) {
  const int listening = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  const int small = 65536;  // bytes that wait to be read: a slow reader is felt by the sender
  setsockopt(listening, SOL_SOCKET, SO_RCVBUF, &small, sizeof small);
  if (count < 2 || bind(listening, reinterpret_cast<const sockaddr*>(&address), size) != 0 ||
      listen(listening, 8) != 0 || getsockname(listening, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
    return 1;
  }
  std::printf("%d\n", ntohs(address.sin_port));
  std::fflush(stdout);
  // Ends with its test, whatever it is doing.
  std::thread([] {
    pollfd input{STDIN_FILENO, POLLIN, 0};
    poll(&input, 1, -1);
    std::_Exit(0);
  }).detach();
  palpate::io::testing::serve_all(listening, arguments[1], count > 2 ? std::atoi(arguments[2]) : 0);
  return 0;
}

#include "plugin/openigtlink/server.h"

#include <arpa/inet.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <thread>

#include "plugin/openigtlink/image.h"
#include "plugin/openigtlink/marks.h"
#include "plugin/openigtlink/names.h"

namespace palpate::plugin::igtl {
namespace {

constexpr std::size_t room_for_metadata = 65536, longest_query = 4096, most_requests = 16;
constexpr int send_buffer = 1 << 16;  // bytes: what a slow client gets late

bool is_loopback(const sockaddr_storage& address) {
  if (address.ss_family == AF_INET) {
    return (ntohl(reinterpret_cast<const sockaddr_in&>(address).sin_addr.s_addr) >> 24U) == 127;
  }
  const in6_addr& six = reinterpret_cast<const sockaddr_in6&>(address).sin6_addr;
  return IN6_IS_ADDR_LOOPBACK(&six) || (IN6_IS_ADDR_V4MAPPED(&six) && six.s6_addr[12] == 127);
}

int port_of(const sockaddr_storage& address) {
  return ntohs(address.ss_family == AF_INET ? reinterpret_cast<const sockaddr_in&>(address).sin_port
                                            : reinterpret_cast<const sockaddr_in6&>(address).sin6_port);
}

void set_option(int socket, int level, int option, int value) {
  ::setsockopt(socket, level, option, &value, sizeof(value));
}

bool is_query(const std::string& type) {
  return type.size() > 4 && (type.starts_with("GET_") || type.starts_with("STT_") || type.starts_with("STP_"));
}

std::string without_prefix(const std::string& type) {
  return type.substr(4);
}

}  // namespace

Server::Server(const Address& address, std::size_t most_bytes) : most_bytes_(most_bytes) {
  const std::string port = std::to_string(address.port);
  const auto refused = [&](const char* why) { return Refusal(say("igtl-cannot-listen", address.host, port, why)); };
  addrinfo hints{};
  hints.ai_flags = AI_NUMERICHOST | AI_NUMERICSERV | AI_PASSIVE;
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (const int error = ::getaddrinfo(address.host.c_str(), port.c_str(), &hints, &found); error != 0) {
    throw refused(::gai_strerror(error));
  }
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> owner(found, &::freeaddrinfo);
  listener_ = ::socket(found->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  set_option(listener_, SOL_SOCKET, SO_REUSEADDR, 1);
  sockaddr_storage bound{};
  socklen_t size = sizeof(bound);
  if (listener_ < 0 || ::bind(listener_, found->ai_addr, found->ai_addrlen) != 0 ||
      ::listen(listener_, static_cast<int>(most_clients)) != 0 ||
      ::getsockname(listener_, reinterpret_cast<sockaddr*>(&bound), &size) != 0) {
    const Refusal refusal = refused(std::strerror(errno));
    if (listener_ >= 0) ::close(listener_);
    throw refusal;
  }
  port_ = port_of(bound);
  local_ = is_loopback(bound);
}

Server::~Server() {
  clients_.clear();
  ::close(listener_);
}

void Server::offer(const std::string& name, Bytes wire, bool kept) {
  const Waiting waiting{name, std::make_shared<const Bytes>(std::move(wire))};
  const std::lock_guard lock(mutex_);
  put(offered_, waiting);
  if (kept) put(kept_, waiting);
}

void Server::forget(const std::string& name) {
  const std::lock_guard lock(mutex_);
  std::erase_if(kept_, [&](const Waiting& one) { return one.name == name; });
}

void Server::answer(std::uint64_t client, const std::string& name, Bytes wire) {
  const std::lock_guard lock(mutex_);
  if (answers_.size() >= most_requests) answers_.erase(answers_.begin());
  answers_.push_back({client, {name, std::make_shared<const Bytes>(std::move(wire))}});
}

void Server::set_owners_scene(std::shared_ptr<const std::string> scene) {
  const std::lock_guard lock(mutex_);
  owners_scene_ = std::move(scene);
}

std::vector<Server::Request> Server::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(requests_, {});
}

ServerCounts Server::counts() const {
  const std::lock_guard lock(mutex_);
  return counts_;
}

void Server::step(std::chrono::milliseconds wait) {
  std::vector<pollfd> waiting{{.fd = listener_, .events = POLLIN, .revents = 0}};
  {
    const std::lock_guard lock(mutex_);
    for (const auto& client : clients_) {
      for (const Waiting& one : offered_) client->queue(one, counts_);
      for (const auto& [id, one] : answers_) {
        if (id == client->id()) client->queue(one, counts_);
      }
      client->write(counts_);
      waiting.push_back(
          {.fd = client->socket(), .events = static_cast<short>(POLLIN | (client->has_to_write() ? POLLOUT : 0))});
    }
    offered_.clear();
    answers_.clear();
  }
  ::poll(waiting.data(), waiting.size(), static_cast<int>(wait.count()));
  const std::lock_guard lock(mutex_);
  bool read = false;
  for (std::size_t n = 1; n < waiting.size(); ++n) {
    serve(*clients_[n - 1], waiting[n].revents);
    read = read || (waiting[n].revents & POLLIN) != 0;
  }
  if ((waiting.front().revents & POLLIN) != 0) accept_one();
  drop_the_gone();
  counts_.clients = clients_.size();
  // A client that floods gets this thread's time in slices, and leaves the processor to others in between.
  if (read) std::this_thread::sleep_for(std::chrono::microseconds(500));
}

void Server::accept_one() {
  sockaddr_storage from{};
  socklen_t size = sizeof(from);
  const int socket = ::accept4(listener_, reinterpret_cast<sockaddr*>(&from), &size, SOCK_NONBLOCK | SOCK_CLOEXEC);
  if (socket < 0) return;
  if (clients_.size() >= most_clients) {
    ++counts_.turned_away;
    ::close(socket);
    return;
  }
  set_option(socket, IPPROTO_TCP, TCP_NODELAY, 1);
  set_option(socket, SOL_SOCKET, SO_SNDBUF, send_buffer);
  const std::uint64_t id = ++last_client_;
  const auto wanted_of_it = [this, id](const Header& header) {
    const auto of_it = std::ranges::find_if(clients_, [id](const auto& one) { return one->id() == id; });
    return wanted(**of_it, header);
  };
  clients_.push_back(std::make_unique<Client>(socket, id, is_loopback(from), wanted_of_it));
  for (const Waiting& one : kept_) clients_.back()->queue(one, counts_);
}

void Server::serve(Client& client, short events) {
  if ((events & POLLOUT) != 0) client.write(counts_);
  if ((events & (POLLIN | POLLERR | POLLHUP)) == 0) return;
  const std::uint64_t passed_over = client.receiver().passed_over(), dropped = client.receiver().dropped();
  try {
    client.read([&](Message&& message) { take_message(client, std::move(message)); });
  } catch (const InvalidInput& error) {
    refuse(client, Status::Code::overflow, error.text());
    client.close_soon();
  }
  counts_.passed_over += client.receiver().passed_over() - passed_over;
  if (client.receiver().dropped() != dropped) {
    counts_.dropped += client.receiver().dropped() - dropped;
    refuse(client, Status::Code::checksum_error, client.receiver().why_dropped());
  }
}

std::size_t Server::wanted(Client& client, const Header& header) {
  const std::string& type = header.type;
  if (is_query(type)) return longest_query;
  std::size_t most = 0;
  if (type == "STRING" && is_request(header.device)) most = longest_string + 4 + room_for_metadata;
  if (type == "POINT" && header.device == marks_name) most = most_marks * point_size + room_for_metadata;
  if (type == "IMAGE") most = largest_image + room_for_metadata;
  if (most == 0) return 0;
  if (controls_ == 0) controls_ = client.id();
  if (controls_ == client.id()) {
    const auto older = find_request(type, header.device);  // makes way for this one
    const std::size_t held = *bytes_ - (older == requests_.end() ? 0 : older->message.content.size());
    // What is too large by itself is refused for its size.
    if (header.body_size > most || held == 0 || held + header.body_size <= most_bytes_) return most;
    refuse(client, Status::Code::overflow, say("igtl-too-much-waits", type, header.device, header.body_size, held));
    return 0;
  }
  ++counts_.refused;
  if (!std::exchange(client.told_read_only, true)) {
    refuse(client, Status::Code::access_denied, say("igtl-another-client-controls"));
  }
  return 0;
}

void Server::take_message(Client& client, Message&& message) {
  if (is_query(message.type)) {
    answer_query(client, message);
  } else {
    keep_request(client, std::move(message));
  }
}

auto Server::find_request(const std::string& type, const std::string& device) -> std::vector<Request>::iterator {
  return std::ranges::find_if(
      requests_, [&](const Request& one) { return one.message.type == type && one.message.device == device; });
}

void Server::keep_request(Client& client, Message&& message) {
  ++counts_.taken;
  const auto same = find_request(message.type, message.device);
  if (same != requests_.end()) {
    requests_.erase(same);
    ++counts_.outrun;
  }
  if (requests_.size() >= most_requests) {
    requests_.erase(requests_.begin());
    ++counts_.outrun;
  }
  const std::size_t size = message.content.size();
  *bytes_ += size;
  std::shared_ptr<const void> counted(bytes_.get(), [bytes = bytes_, size](const void*) { *bytes -= size; });
  requests_.push_back({client.id(), client.from_this_machine(), std::move(message), std::move(counted), owners_scene_});
}

void Server::answer_query(Client& client, const Message& message) {
  const std::string what = without_prefix(message.type);
  if (message.type.starts_with("GET_")) {
    bool any = false;
    for (const Waiting& one : kept_) {
      const Header header = read_header(*one.wire);
      const bool of_type = header.type == what || (what == "TRANS" && header.type == "TRANSFORM");
      const bool of_device = message.device.empty() || header.device == message.device || one.name == frame_name;
      if (!of_type || !of_device) continue;
      any = true;
      client.queue({"answer " + one.name, one.wire}, counts_);
    }
    if (!any) refuse(client, Status::Code::not_ready, say("igtl-nothing-to-get", message.type));
    return;
  }
  const bool of_frames = what == "TRANS" || what == "TRANSFORM";
  if (of_frames) client.streams = message.type.starts_with("STT_");
  Bytes wire;
  append(wire,
         {.type = "RTS_" + what, .device = message.device, .content = {static_cast<std::uint8_t>(of_frames ? 0 : 1)}});
  client.queue({"answer RTS_", std::make_shared<const Bytes>(std::move(wire))}, counts_);
}

void Server::refuse(Client& client, Status::Code code, const Text& why) {
  ++counts_.refused;
  Bytes wire;
  append(wire, {.type = "STATUS",
                .device = program_name,
                .content = content_of(Status{.code = code, .name = "refused", .text = why})});
  client.queue({"refused", std::make_shared<const Bytes>(std::move(wire))}, counts_);
}

void Server::drop_the_gone() {
  const auto now = Client::Clock::now();
  std::erase_if(clients_, [&](const std::unique_ptr<Client>& client) {
    const bool ends = client->ends(now, counts_);
    if (ends && client->id() == controls_) controls_ = 0;
    return ends;
  });
}

}  // namespace palpate::plugin::igtl

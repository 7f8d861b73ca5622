#pragma once

/// A server stepped by a thread, and clients of it.

#include <atomic>
#include <optional>
#include <thread>
#include <vector>

#include "plugin/openigtlink/contents.h"
#include "plugin/openigtlink/receiver.h"
#include "plugin/openigtlink/server.h"
#include "plugin/openigtlink/testing/peer.h"

namespace palpate::plugin::igtl::testing {

inline Bytes wire_of(const Message& message) {
  Bytes wire;
  append(wire, message);
  return wire;
}

class SteppedServer {
 public:
  explicit SteppedServer(std::size_t most_bytes = most_request_bytes)
      : server({.port = 0}, most_bytes), thread_([this] {
          while (!stop_) server.step(std::chrono::milliseconds(2));
        }) {}
  ~SteppedServer() {
    stop_ = true;
    thread_.join();
  }
  SteppedServer(const SteppedServer&) = delete;
  SteppedServer& operator=(const SteppedServer&) = delete;

  Server server;

 private:
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/// Reads messages one by one.
class TestClient {
 public:
  explicit TestClient(int port) : connection_(port) {}

  bool send(const Message& message) { return connection_.send(wire_of(message)); }
  bool send(ByteView bytes) { return connection_.send(bytes); }
  bool send_text(const char* device, std::string_view text) {
    return send({.type = "STRING", .device = device, .content = string_content(text)});
  }
  /// The next message; none if none comes in that time, or the connection is closed.
  std::optional<Message> next(int milliseconds = 5000) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(milliseconds);
    while (got_.empty() && !connection_.closed() && std::chrono::steady_clock::now() < end) {
      receiver_.take(connection_.receive(10), [&](Message&& message) { got_.push_back(std::move(message)); });
    }
    if (got_.empty()) return std::nullopt;
    Message message = std::move(got_.front());
    got_.erase(got_.begin());
    return message;
  }
  /// The next message of that type and device; earlier ones are skipped.
  std::optional<Message> next(std::string_view type, std::string_view device, int milliseconds = 5000) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(milliseconds);
    while (std::chrono::steady_clock::now() < end) {
      auto message = next(100);
      if (message && message->type == type && message->device == device) return message;
      if (!message && connection_.closed()) break;
    }
    return std::nullopt;
  }
  /// The next STATUS with that name.
  std::optional<Status> next_status(std::string_view name, int milliseconds = 5000) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(milliseconds);
    while (std::chrono::steady_clock::now() < end) {
      const auto message = next("STATUS", "Palpate", 200);
      if (message && status_of(message->content).name == name) return status_of(message->content);
      if (!message && connection_.closed()) break;
    }
    return std::nullopt;
  }
  /// Whether the other side closes it.
  bool is_closed_soon() {
    for (int n = 0; n < 500 && !connection_.closed(); ++n) connection_.receive(10);
    return connection_.closed();
  }

 private:
  Connection connection_;
  Receiver receiver_{[](const Header&) { return std::size_t{1} << 28U; }};
  std::vector<Message> got_;
};

}  // namespace palpate::plugin::igtl::testing

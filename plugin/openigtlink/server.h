#pragma once

/// An OpenIGTLink server for a few clients. One thread steps it, and no other thread waits for the network: sent and
/// received messages are in bounded queues, in which the newest of a name replaces the previous one.
///
/// The first client that sends a request is the controlling one; until it disconnects, the others only read.

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "plugin/openigtlink/client.h"

namespace palpate::plugin::igtl {

inline constexpr int default_port = 18944;
inline constexpr std::size_t most_clients = 8;
inline constexpr std::size_t most_request_bytes = std::size_t{1} << 30U;

struct Address {
  std::string host = "127.0.0.1";  ///< address of an interface of this machine, numeric
  int port = default_port;         ///< 0: any free port
};

class Server {
 public:
  /// A client's request.
  struct Request {
    std::uint64_t client = 0;
    bool from_this_machine = true;
    Message message;
    std::shared_ptr<const void> counted = nullptr;  ///< while it exists, the message's bytes count as taken
    /// The owner's scene when the request came, as text; null: it was not told.
    std::shared_ptr<const std::string> owners_scene = nullptr;
  };

  /// Listens. Requests count until they are destroyed. A new one is refused if others still count and would take more
  /// than `most_bytes` together with it. Throws Refusal that names the address and what to do.
  explicit Server(const Address& address, std::size_t most_bytes = most_request_bytes);
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;
  ~Server();

  int port() const noexcept { return port_; }
  /// Whether only this machine can connect.
  bool is_local() const noexcept { return local_; }

  // --- Any thread.
  /// To all clients: replaces a waiting message of that name. `kept`: new clients get it, too.
  void offer(const std::string& name, Bytes wire, bool kept = false);
  /// No longer sends it to new clients.
  void forget(const std::string& name);
  /// For one client.
  void answer(std::uint64_t client, const std::string& name, Bytes wire);
  /// Tells the owner's scene: requests that come from now on carry it.
  void set_owners_scene(std::shared_ptr<const std::string> scene);
  /// The requests since the previous call: the newest of each type and device.
  std::vector<Request> take();
  ServerCounts counts() const;

  // --- The network's thread.
  /// Waits up to that long, then reads and writes as much as possible without waiting.
  void step(std::chrono::milliseconds wait);

 private:
  void accept_one();
  void serve(Client& client, short events);
  void take_message(Client& client, Message&& message);
  void answer_query(Client& client, const Message& message);
  std::vector<Request>::iterator find_request(const std::string& type, const std::string& device);
  void keep_request(Client& client, Message&& message);
  std::size_t wanted(Client& client, const Header& header);
  void refuse(Client& client, Status::Code code, const Text& why);
  void drop_the_gone();

  std::size_t most_bytes_;
  std::shared_ptr<std::atomic<std::size_t>> bytes_ = std::make_shared<std::atomic<std::size_t>>(0);  // of requests
  int listener_ = -1, port_ = 0;
  bool local_ = true;
  std::uint64_t last_client_ = 0, controls_ = 0;  // 0: none
  std::vector<std::unique_ptr<Client>> clients_;
  // Across the threads.
  mutable std::mutex mutex_;
  std::vector<Waiting> offered_, kept_;
  std::vector<std::pair<std::uint64_t, Waiting>> answers_;
  std::vector<Request> requests_;
  std::shared_ptr<const std::string> owners_scene_;
  ServerCounts counts_;
};

}  // namespace palpate::plugin::igtl

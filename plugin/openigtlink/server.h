#pragma once

/// A server of OpenIGTLink for a few clients. One thread steps it, and no other thread waits for the network: what is
/// sent and what has come lie in bounded queues in which the newest of a name takes the place of the one before.
///
/// The first client that sends something to be done controls; the others read, until it is gone.

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

struct Address {
  std::string host = "127.0.0.1";  ///< of an interface of this machine, in numbers
  int port = default_port;         ///< 0: any that is free
};

class Server {
 public:
  /// What a client wants to be done.
  struct Request {
    std::uint64_t client = 0;
    bool from_this_machine = true;
    Message message;
  };

  /// Listens. Throws Refusal that names the address and what to do.
  explicit Server(const Address& address);
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;
  ~Server();

  int port() const noexcept { return port_; }
  /// Whether only this machine can connect.
  bool is_local() const noexcept { return local_; }

  // --- Any thread.
  /// For all clients: takes the place of what waits under that name. `kept`: new clients get it, too.
  void offer(const std::string& name, Bytes wire, bool kept = false);
  /// New clients do not get it any more.
  void forget(const std::string& name);
  /// For one client.
  void answer(std::uint64_t client, const std::string& name, Bytes wire);
  /// What has come since the last call: of each type and device the newest.
  std::vector<Request> take();
  ServerCounts counts() const;

  // --- The network's thread.
  /// Waits up to that long for something to do, then reads and writes what can be read and written without waiting.
  void step(std::chrono::milliseconds wait);

 private:
  void accept_one();
  void serve(Client& client, short events);
  void take_message(Client& client, Message&& message);
  void answer_query(Client& client, const Message& message);
  void keep_request(Client& client, Message&& message);
  std::size_t wanted(Client& client, const Header& header);
  void refuse(Client& client, Status::Code code, const Text& why);
  void drop_the_gone();

  int listener_ = -1, port_ = 0;
  bool local_ = true;
  std::uint64_t last_client_ = 0, controls_ = 0;  // 0: nobody
  std::vector<std::unique_ptr<Client>> clients_;
  // Across the threads.
  mutable std::mutex mutex_;
  std::vector<Waiting> offered_, kept_;
  std::vector<std::pair<std::uint64_t, Waiting>> answers_;
  std::vector<Request> requests_;
  ServerCounts counts_;
};

}  // namespace palpate::plugin::igtl

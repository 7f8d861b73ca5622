#pragma once

/// One client of the server: its connection, its send queue, and its received messages.

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "plugin/openigtlink/contents.h"
#include "plugin/openigtlink/receiver.h"

namespace palpate::plugin::igtl {

/// The name in the queue for the transforms of a frame.
inline constexpr const char* frame_name = "frame";

/// Bytes to be sent, by name.
struct Waiting {
  std::string name;
  std::shared_ptr<const Bytes> wire;
};
/// Replaces the entry of that name, or appends. True if one was replaced.
bool put(std::vector<Waiting>& queue, const Waiting& waiting);

/// Counts since the server began.
struct ServerCounts {
  std::size_t clients = 0;        ///< connected now
  std::uint64_t sent = 0;         ///< completely written messages or frames
  std::uint64_t replaced = 0;     ///< messages replaced by newer ones, because the client is slow
  std::uint64_t taken = 0;        ///< requests
  std::uint64_t outrun = 0;       ///< requests replaced by newer ones
  std::uint64_t refused = 0;      ///< refused requests, and invalid streams
  std::uint64_t passed_over = 0;  ///< messages of types that Palpate does not use
  std::uint64_t dropped = 0;      ///< messages with a wrong checksum
  std::uint64_t cut = 0;          ///< connections closed because the client stopped reading
  std::uint64_t turned_away = 0;  ///< clients beyond most_clients
};

/// Used only by the network's thread.
class Client {
 public:
  using Clock = std::chrono::steady_clock;

  /// Takes the connection over.
  Client(int socket, std::uint64_t id, bool from_this_machine, Receiver::Wanted wanted);
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;
  ~Client();

  int socket() const noexcept { return socket_; }
  std::uint64_t id() const noexcept { return id_; }
  bool from_this_machine() const noexcept { return from_this_machine_; }
  bool is_gone() const noexcept { return gone_; }
  bool has_to_write() const noexcept { return current_ != nullptr || !queue_.empty(); }
  const Receiver& receiver() const noexcept { return receiver_; }

  /// Whether it gets frames; STT_ and STP_ messages change it.
  bool streams = true;
  bool told_read_only = false;

  void queue(const Waiting& waiting, ServerCounts& counts);
  /// Writes as much as possible without waiting.
  void write(ServerCounts& counts);
  /// Reads available bytes, at most a quarter of a MiB. Throws InvalidInput as Receiver::take() does.
  void read(const Receiver::Got& got);
  /// Closes after everything is written, at the latest after a second.
  void close_soon() noexcept { closes_ = true; }
  /// Whether it is to be dropped: gone, or it has not read for ten seconds.
  bool ends(Clock::time_point now, ServerCounts& counts);

 private:
  int socket_;
  std::uint64_t id_;
  bool from_this_machine_, gone_ = false, closes_ = false;
  Receiver receiver_;
  std::vector<Waiting> queue_;
  std::shared_ptr<const Bytes> current_;  // being written
  std::size_t written_ = 0;
  Clock::time_point last_progress_ = Clock::now();
};

}  // namespace palpate::plugin::igtl

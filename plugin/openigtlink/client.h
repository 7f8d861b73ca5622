#pragma once

/// One client of the server: its connection, what waits to be sent to it, and what has come from it.

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "plugin/openigtlink/contents.h"
#include "plugin/openigtlink/receiver.h"

namespace palpate::plugin::igtl {

/// The name under which the transforms of a frame are offered.
inline constexpr const char* frame_name = "frame";

/// Bytes that wait to be sent, in a name's place.
struct Waiting {
  std::string name;
  std::shared_ptr<const Bytes> wire;
};
/// Puts it in the place of its name, or last. True if another one was replaced.
bool put(std::vector<Waiting>& queue, const Waiting& waiting);

/// Since the server began.
struct ServerCounts {
  std::size_t clients = 0;        ///< now
  std::uint64_t sent = 0;         ///< messages or frames that were written whole
  std::uint64_t replaced = 0;     ///< that a newer one took the place of: the client is slow
  std::uint64_t taken = 0;        ///< requests
  std::uint64_t outrun = 0;       ///< requests that a newer one took the place of
  std::uint64_t refused = 0;      ///< requests, and streams that could not be followed
  std::uint64_t passed_over = 0;  ///< messages that Palpate has no use for
  std::uint64_t dropped = 0;      ///< messages with a wrong checksum
  std::uint64_t cut = 0;          ///< clients that stopped reading
  std::uint64_t turned_away = 0;  ///< clients beyond most_clients
};

/// Of the network's thread alone.
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

  /// Whether it gets frames; STT_ and STP_ change it.
  bool streams = true;
  bool told_read_only = false;

  void queue(const Waiting& waiting, ServerCounts& counts);
  /// Writes what can be written without waiting.
  void write(ServerCounts& counts);
  /// Reads what has come, a quarter of a MiB at most. Throws InvalidInput as Receiver::take().
  void read(const Receiver::Got& got);
  /// After what waits is written, or at once if that takes longer than a second.
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

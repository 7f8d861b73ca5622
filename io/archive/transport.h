#pragma once

/// The connection of an association: plain TCP or TLS, and the watch that ends it if the peer is silent.

#include <dcmtk/config/osconfig.h>
// DCMTK's configuration comes first.
#include <dcmtk/dcmnet/assoc.h>
#include <dcmtk/dcmnet/dcmlayer.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

#include "io/archive/archive.h"

namespace palpate::io {

constexpr long maximum_pdu = 65536;  ///< bytes: the largest PDU that we accept

/// DCMTK's transport layer for one connection; it also remembers the connection's socket.
struct Transport {
  std::unique_ptr<DcmTransportLayer> layer;
  int socket = -1;           ///< of the latest connection; DCMTK closes it
  bool names_other = false;  ///< the peer's certificate is for a machine that is not the archive's
};

/// For the side that requests the association (NET_REQUESTOR) or accepts it (NET_ACCEPTOR). As requestor, the peer's
/// certificate must be for its host (RFC 6125). As acceptor, only the certificate's authority is checked here; the
/// peer's AE title is checked later. Throws ArchiveError naming a certificate or key that cannot be used.
std::unique_ptr<Transport> make_transport(const Archive& archive, T_ASC_NetworkRole role);

/// Shuts a socket down after a while without a complete message part. DCMTK's time-outs restart with every byte, so a
/// peer that sends a byte now and then could hold a reader for ever.
class Watch {
 public:
  Watch(int socket, int silence_s);
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;
  ~Watch();

  /// To be called when a complete message part was received or sent.
  void heard() noexcept { last_.store(std::chrono::steady_clock::now(), std::memory_order_relaxed); }
  bool ended() const noexcept { return ended_.load(std::memory_order_relaxed); }
  /// Ends the connection at once.
  void end() noexcept;
  /// Whether it was ended because a question whether to go on was answered with no.
  bool cancelled() const noexcept { return cancelled_.load(std::memory_order_relaxed); }

  /// While it exists, the watch asks once a second whether to go on, also while a message part is being waited for. The
  /// question is asked on the watch's thread.
  class Asking {
   public:
    Asking(Watch& watch, KeepGoing keep_going) : watch_(watch) { watch_.ask(std::move(keep_going)); }
    Asking(const Asking&) = delete;
    Asking& operator=(const Asking&) = delete;
    ~Asking() { watch_.ask({}); }

   private:
    Watch& watch_;
  };

 private:
  void ask(KeepGoing keep_going);
  bool goes_on() noexcept;

  int socket_;
  std::chrono::seconds silence_;
  std::atomic<std::chrono::steady_clock::time_point> last_{std::chrono::steady_clock::now()};
  std::atomic<bool> ended_{false}, cancelled_{false};
  KeepGoing keep_going_;
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::jthread thread_;
};

}  // namespace palpate::io

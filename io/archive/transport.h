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

#include "io/archive/archive.h"

namespace palpate::io {

constexpr long maximum_pdu = 65536;  ///< bytes of a message that we accept in one part

/// DCMTK's layer for one connection, which also remembers the connection's socket.
struct Transport {
  std::unique_ptr<DcmTransportLayer> layer;
  int socket = -1;           ///< of the latest connection; DCMTK closes it
  bool names_other = false;  ///< the peer's certificate is for another machine than the archive's
};

/// For the requestor's side (NET_REQUESTOR) or the acceptor's (NET_ACCEPTOR). As a requestor, we require that the
/// peer's certificate is for its machine (RFC 6125). As an acceptor, we check only the certificate's authority, and the
/// AE title later. Throws ArchiveError that names the certificate or key that cannot be used.
std::unique_ptr<Transport> make_transport(const Archive& archive, T_ASC_NetworkRole role);

/// Shuts a socket down if no whole part of a message has come for a while. Without it, a peer that sends a byte now and
/// then could keep a reader waiting for ever, since DCMTK's time-outs start anew with every byte.
class Watch {
 public:
  Watch(int socket, int silence_s);
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;
  ~Watch();

  /// A whole part of a message has been received or sent.
  void heard() noexcept { last_.store(std::chrono::steady_clock::now(), std::memory_order_relaxed); }
  bool ended() const noexcept { return ended_.load(std::memory_order_relaxed); }
  /// Ends the connection at once.
  void end() noexcept;

 private:
  int socket_;
  std::chrono::seconds silence_;
  std::atomic<std::chrono::steady_clock::time_point> last_{std::chrono::steady_clock::now()};
  std::atomic<bool> ended_{false};
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::jthread thread_;
};

}  // namespace palpate::io

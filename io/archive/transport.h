#pragma once

/// The connection under an association: plain TCP or TLS, and the watch that ends it where the peer is silent.

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

constexpr long maximum_pdu = 65536;  ///< bytes of a message that we take in one part

/// DCMTK's layer for one connection, which also remembers the connection's socket.
struct Transport {
  std::unique_ptr<DcmTransportLayer> layer;
  int socket = -1;           ///< of the connection that was made last; DCMTK's to close
  bool names_other = false;  ///< the peer's certificate is for another machine than the archive's
};

/// For the side that asks (NET_REQUESTOR) or is asked (NET_ACCEPTOR). If we ask, the peer's certificate has to be for
/// its machine (RFC 6125); if a peer asks us, only its certificate's authority is checked, and its AE title later.
/// Throws ArchiveError naming the certificate or key that cannot be used.
std::unique_ptr<Transport> make_transport(const Archive& archive, T_ASC_NetworkRole role);

/// Shuts a socket down where nothing was heard on it for a while. Without it a peer that sends a byte now and then
/// would hold a reader in the midst of a message for ever: DCMTK's time-outs start anew with every byte.
class Watch {
 public:
  Watch(int socket, int silence_s);
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;
  ~Watch();

  /// A whole piece of a message has come, or has gone.
  void heard() noexcept { last_.store(std::chrono::steady_clock::now(), std::memory_order_relaxed); }
  bool ended() const noexcept { return ended_.load(std::memory_order_relaxed); }
  /// Ends the connection now.
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

#pragma once

/// Our storage service (SCP), which receives the images of a C-MOVE. It listens on one address for as long as the
/// object exists, and accepts the archive's AE title alone. Not installed.

#include <atomic>
#include <exception>
#include <mutex>
#include <string>
#include <thread>

#include "io/archive/archive.h"
#include "io/archive/inbox.h"
#include "io/archive/transport.h"

namespace palpate::io {

class StoreServer {
 public:
  /// Starts to listen. Throws ArchiveError if the address or the port cannot be used.
  StoreServer(const Archive& archive, Inbox& inbox);
  StoreServer(const StoreServer&) = delete;
  StoreServer& operator=(const StoreServer&) = delete;
  /// Stops listening and ends all associations.
  ~StoreServer();

  /// Rethrows the error that ended it: a full disk or a passed limit. Otherwise does nothing.
  void rethrow();
  /// The AE titles that were refused, in words; empty if there are none.
  std::string turned_away();

 private:
  /// While it exists, stopping the server also ends this association.
  class Active {
   public:
    Active(StoreServer& server, Watch& watch);
    Active(const Active&) = delete;
    Active& operator=(const Active&) = delete;
    ~Active();

   private:
    StoreServer& server_;
  };
  void run();
  void serve(int socket);
  void converse(T_ASC_Association& association, Watch& watch);
  bool let_in(T_ASC_Association& association);

  const Archive& archive_;
  Inbox& inbox_;
  int listening_ = -1;
  std::atomic<bool> stopping_{false};
  std::mutex mutex_;
  std::exception_ptr failure_;
  std::string turned_away_;
  Watch* watch_ = nullptr;  // of the active association
  std::thread thread_;
};

}  // namespace palpate::io

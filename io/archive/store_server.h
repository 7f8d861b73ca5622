#pragma once

/// Our storage service (SCP), to which an archive sends the objects that a C-MOVE requested. It listens for as long as
/// the object lives, on one address, and accepts objects from the archive's AE title only. Not installed.

#include <atomic>
#include <exception>
#include <mutex>
#include <string>
#include <thread>

#include "io/archive/archive.h"
#include "io/archive/inbox.h"

namespace palpate::io {

class StoreServer {
 public:
  /// Listens. Throws ArchiveError if it cannot listen on the address and port.
  StoreServer(const Archive& archive, Inbox& inbox);
  StoreServer(const StoreServer&) = delete;
  StoreServer& operator=(const StoreServer&) = delete;
  /// Stops listening and ends all associations.
  ~StoreServer();

  /// Throws the error that ended it, such as a full disk or a limit.
  void rethrow();
  /// The AE titles that were rejected, in words; empty if none was.
  std::string turned_away();

 private:
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
  std::thread thread_;
};

}  // namespace palpate::io

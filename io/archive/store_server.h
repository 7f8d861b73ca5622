#pragma once

/// Our storage service (SCP), to which an archive sends what a C-MOVE asked for. It listens only while it lives, on one
/// address, and takes objects from the archive's AE title alone. Not installed.

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
  /// Listens. Throws ArchiveError where the address or the port cannot be had.
  StoreServer(const Archive& archive, Inbox& inbox);
  StoreServer(const StoreServer&) = delete;
  StoreServer& operator=(const StoreServer&) = delete;
  /// Closed, and no association is left.
  ~StoreServer();

  /// Throws what ended it: a full disk, a limit.
  void rethrow();
  /// AE titles that wanted in and were not let in, in words; empty: none.
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

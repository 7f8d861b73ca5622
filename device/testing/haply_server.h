#pragma once

/// The fake Haply service behind a real socket on this machine: HTTP for its version, a WebSocket for its sessions.

#include <functional>
#include <memory>
#include <string>

#include "device/testing/fake_haply.h"

namespace palpate::device {

class HaplyServer {
 public:
  /// Listens on a port of the loopback that is free, and serves in a thread of its own.
  explicit HaplyServer(const FakeHaply& service = {});
  HaplyServer(const HaplyServer&) = delete;
  HaplyServer& operator=(const HaplyServer&) = delete;
  /// Ends every connection.
  ~HaplyServer();

  int port() const noexcept;
  /// Of its events.
  int events_port() const noexcept;
  /// Sends an event to each who hears them.
  void tell(const std::string& event);
  /// Runs with the service while it serves nobody.
  void with(const std::function<void(FakeHaply&)>& run);
  /// N, that acts now.
  Vec3 acting();

  /// Closes each connection without a word, as a service does that is killed.
  void drop();
  /// Each message from now on ends in the middle of its frame.
  void cut_frames(bool on);
  /// Nothing is read or written any more, and no connection is closed.
  void stall(bool on);
  int sessions() const noexcept;  ///< there have been

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace palpate::device

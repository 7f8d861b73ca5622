#pragma once

/// The fake Haply service behind a real socket on this machine: HTTP for its version, a WebSocket for its sessions.

#include <functional>
#include <memory>
#include <string>

#include "device/testing/fake_haply.h"

namespace palpate::device {

class HaplyServer {
 public:
  /// Listens on a free loopback port, and serves in a thread of its own.
  explicit HaplyServer(const FakeHaply& service = {});
  HaplyServer(const HaplyServer&) = delete;
  HaplyServer& operator=(const HaplyServer&) = delete;
  /// Ends every connection.
  ~HaplyServer();

  int port() const noexcept;
  /// The port for events.
  int events_port() const noexcept;
  /// Sends an event to every listener.
  void tell(const std::string& event);
  /// Runs a function on the service while it serves no request.
  void with(const std::function<void(FakeHaply&)>& run);
  /// The force that acts now, N.
  Vec3 acting();

  /// Closes every connection without a closing message, like a killed service.
  void drop();
  /// From now on each message ends in the middle of its frame.
  void cut_frames(bool on);
  /// Stops reading and writing, without closing connections.
  void stall(bool on);
  int sessions() const noexcept;  ///< number so far

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace palpate::device

#pragma once

#include <systemd/sd-bus.h>

#include <memory>

namespace palpate::device {

/// The guardian's D-Bus client of systemd. logind announces a sleep (a closed lid, the menu, an empty battery) and
/// waits, by default at most 5 s, for the holders of delay locks. The user's systemd gives the guardian a scope of its
/// own. Without a bus or these services it does nothing. It never waits for an answer.
class LoginManager {
 public:
  /// Takes a delay lock, and asks for a scope for this process.
  LoginManager();
  LoginManager(const LoginManager&) = delete;
  LoginManager& operator=(const LoginManager&) = delete;
  ~LoginManager();

  /// Handles the messages that have arrived. Call it every few hundredths of a second.
  void look() noexcept;
  /// True from the announcement of a sleep until the machine is awake again.
  bool sleep_is_near() const noexcept { return sleep_is_near_; }
  bool holds_lock() const noexcept { return lock_ >= 0; }
  /// Releases the lock, once no force is on the device. A new one is taken when the machine is awake again.
  void let_sleep() noexcept;

 private:
  struct BusCloser {
    void operator()(sd_bus* bus) const { sd_bus_close_unref(bus); }
  };
  static int on_sleep(sd_bus_message* message, void* self, sd_bus_error* error);
  static int on_lock(sd_bus_message* message, void* self, sd_bus_error* error);
  void take_lock() noexcept;
  void ask_for_scope() noexcept;

  std::unique_ptr<sd_bus, BusCloser> system_;
  std::unique_ptr<sd_bus, BusCloser> user_;
  bool sleep_is_near_ = false;
  int lock_ = -1;
};

}  // namespace palpate::device

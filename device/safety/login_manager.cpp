#include "device/safety/login_manager.h"

#include <fcntl.h>
#include <unistd.h>

#include <string>

namespace palpate::device {

namespace {

constexpr const char* logind = "org.freedesktop.login1";
constexpr const char* logind_path = "/org/freedesktop/login1";
constexpr const char* logind_manager = "org.freedesktop.login1.Manager";
constexpr const char* systemd = "org.freedesktop.systemd1";
constexpr const char* systemd_path = "/org/freedesktop/systemd1";
constexpr const char* systemd_manager = "org.freedesktop.systemd1.Manager";

using Message = std::unique_ptr<sd_bus_message, decltype(&sd_bus_message_unref)>;

/// Nothing is done with the answer: a guardian that stays where it is guards all the same.
int ignore_answer(sd_bus_message* /*message*/, void* /*self*/, sd_bus_error* /*error*/) {
  return 0;
}

}  // namespace

LoginManager::LoginManager() {
  sd_bus* bus = nullptr;
  if (sd_bus_open_system(&bus) >= 0) {
    system_.reset(bus);
    sd_bus_match_signal_async(bus, nullptr, logind, logind_path, logind_manager, "PrepareForSleep", &on_sleep, nullptr,
                              this);
    take_lock();
  }
  bus = nullptr;
  if (sd_bus_open_user(&bus) >= 0) {
    user_.reset(bus);
    ask_for_scope();
  }
}

LoginManager::~LoginManager() {
  let_sleep();
}

void LoginManager::take_lock() noexcept {
  sd_bus_call_method_async(system_.get(), nullptr, logind, logind_path, logind_manager, "Inhibit", &on_lock, this,
                           "ssss", "sleep", "Palpate", "a stylus is held: its force is taken away first", "delay");
}

void LoginManager::ask_for_scope() noexcept {
  sd_bus_message* raw = nullptr;
  if (sd_bus_message_new_method_call(user_.get(), &raw, systemd, systemd_path, systemd_manager, "StartTransientUnit") <
      0) {
    return;
  }
  const Message message(raw, &sd_bus_message_unref);
  const auto pid = static_cast<std::uint32_t>(getpid());
  const std::string name = "palpate-guardian-" + std::to_string(pid) + ".scope";
  const bool made = sd_bus_message_append(raw, "ss", name.c_str(), "fail") >= 0 &&
                    sd_bus_message_append(raw, "a(sv)", 2, "Description", "s", "Palpate: takes a stylus's force away",
                                          "PIDs", "au", 1, pid) >= 0 &&
                    sd_bus_message_append(raw, "a(sa(sv))", 0) >= 0;
  if (made) sd_bus_call_async(user_.get(), nullptr, raw, &ignore_answer, nullptr, 0);
}

int LoginManager::on_lock(sd_bus_message* message, void* self, sd_bus_error* /*error*/) {
  auto& manager = *static_cast<LoginManager*>(self);
  int lock = -1;
  // The message's own descriptor ends with the message.
  if (sd_bus_message_is_method_error(message, nullptr) != 0 || sd_bus_message_read(message, "h", &lock) < 0) return 0;
  manager.let_sleep();
  manager.lock_ = fcntl(lock, F_DUPFD_CLOEXEC, 4);  // 3 is the session's memory
  return 0;
}

int LoginManager::on_sleep(sd_bus_message* message, void* self, sd_bus_error* /*error*/) {
  auto& manager = *static_cast<LoginManager*>(self);
  int near = 0;
  if (sd_bus_message_read(message, "b", &near) < 0) return 0;
  manager.sleep_is_near_ = near != 0;
  if (!manager.sleep_is_near_ && !manager.holds_lock()) manager.take_lock();
  return 0;
}

void LoginManager::look() noexcept {
  constexpr int most = 64;  // messages at a look
  for (const auto* bus : {&system_, &user_}) {
    for (int n = 0; n < most && *bus && sd_bus_process(bus->get(), nullptr) > 0; ++n) {
    }
  }
}

void LoginManager::let_sleep() noexcept {
  if (lock_ >= 0) close(lock_);
  lock_ = -1;
}

}  // namespace palpate::device

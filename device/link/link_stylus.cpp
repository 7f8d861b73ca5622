#include "device/link/link_stylus.h"

#include <array>
#include <limits>

#include "device/link/realtime.h"
#include "device/vectors.h"

namespace palpate::device {

const char* name_of(LinkFault fault) {
  switch (fault) {
    case LinkFault::none:
      return "none";
    case LinkFault::unplugged:
      return "unplugged";
    case LinkFault::silent:
      return "silent";
    case LinkFault::slow:
      return "too slow to push safely";
    case LinkFault::unreachable_pose:
      return "unreachable pose";
    case LinkFault::unhomed:
      return "lost its home";
  }
  return "unknown";
}

namespace {

// At a period of 8 ms and a delay of as much, the linear bound of stiffness.h lies below a wall of 400 N/m.
constexpr double rate_window = 0.25;  // s
constexpr std::uint64_t fewest_in_window = 30;

}  // namespace

LinkStylus::LinkStylus(Specification specification, std::unique_ptr<Protocol> protocol, LinkMaker make_link,
                       const LinkStylusOptions& options)
    : specification_(std::move(specification)),
      protocol_(std::move(protocol)),
      make_link_(std::move(make_link)),
      options_(options) {}

LinkStylus::~LinkStylus() {
  close();
}

void LinkStylus::open() {
  close();
  // The guardian first: from the moment when a force can be sent, somebody can take it back.
  guardian_ = start_guardian(options_.guardian);
  try {
    link_ = make_link_();
    protocol_->connect(*link_);
  } catch (...) {
    link_.reset();
    guardian_.reset();
    throw;
  }
  opened_ = news_time_ = window_start_ = link_->now();
  news_ = window_news_ = protocol_->status().news;
  force_.store(Vec3(0));
  force_.load();
  force_time_ = -std::numeric_limits<double>::infinity();
  last_reading_ = {};
  reading_.store({});
  reading_.load();
  fault_.store(LinkFault::none, std::memory_order_relaxed);
  state_.store(protocol_->status().state, std::memory_order_relaxed);
  if (!options_.threaded) return;
  stop_.store(false, std::memory_order_relaxed);
  thread_ = std::thread([this] {
    make_thread_realtime(options_.priority);
    while (!stop_.load(std::memory_order_relaxed)) exchange(1e-3, false);
  });
}

void LinkStylus::close() noexcept {
  if (!link_) return;
  if (thread_.joinable()) {
    stop_.store(true, std::memory_order_relaxed);
    thread_.join();
  }
  send_zeros();
  link_.reset();
  if (guardian_) guardian_->dismiss();
  guardian_.reset();
  state_.store(State::disconnected, std::memory_order_relaxed);
}

void LinkStylus::send_zeros() noexcept {
  // Two poses after the first zero: the device has taken it, not only the wire.
  const double start = link_->now();
  const std::uint64_t enough = protocol_->status().news + 3;
  while (!link_->lost() && link_->now() - start < 0.050 && protocol_->status().news < enough) exchange(1e-3, true);
  link_->flush(0.020);
}

void LinkStylus::service(double timeout) noexcept {
  if (link_ && !options_.threaded) exchange(timeout, false);
}

void LinkStylus::exchange(double timeout, bool closing) noexcept {
  std::array<std::uint8_t, 64> packet{};
  // The newest packet wins; the bound keeps a babbling device from holding the thread.
  std::size_t size = link_->receive(packet, timeout);
  for (int i = 0; size > 0 && i < 64; ++i) {
    protocol_->receive(std::span(packet).first(size), link_->now());
    size = link_->receive(packet, 0);
  }
  const double now = link_->now();
  const ProtocolStatus& status = protocol_->status();
  if (link_->lost()) fail(LinkFault::unplugged);
  if (status.news != news_) {
    news_ = status.news;
    news_time_ = now;
    reading_.store({now - opened_, status.position, status.buttons, true});
  }
  if (status.state == State::fault) fail(status.fault);
  if (now - news_time_ > protocol_->longest_silence()) fail(LinkFault::silent);
  judge_rate(now);

  if (force_.has_news()) force_time_ = now;
  const Vec3 newest = force_.load();
  const bool may_push = !closing && fault() == LinkFault::none && now - force_time_ <= options_.force_age;
  const std::size_t due = protocol_->step(may_push ? newest : Vec3(0), now, packet);
  if (due > 0) link_->send(std::span(packet).first(due));
  if (fault() == LinkFault::none) state_.store(protocol_->status().state, std::memory_order_relaxed);
}

void LinkStylus::judge_rate(double now) noexcept {
  if (now - window_start_ < rate_window) return;
  // A window much longer than it should be was this thread's own delay, and tells nothing of the device.
  const bool fair = now - window_start_ < 2 * rate_window && state() == State::idle;
  if (fair && news_ - window_news_ < fewest_in_window) fail(LinkFault::slow);
  window_start_ = now;
  window_news_ = news_;
}

void LinkStylus::fail(LinkFault fault) noexcept {
  if (this->fault() != LinkFault::none) return;
  fault_.store(fault, std::memory_order_relaxed);
  state_.store(State::fault, std::memory_order_relaxed);
}

Reading LinkStylus::read() noexcept {
  const bool news = reading_.has_news();
  last_reading_ = reading_.load();
  last_reading_.fresh = news && last_reading_.fresh;
  return last_reading_;
}

void LinkStylus::write_force(const Vec3& force) noexcept {
  force_.store(is_finite(force) ? force : Vec3(0));
}

}  // namespace palpate::device

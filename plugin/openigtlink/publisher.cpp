#include "plugin/openigtlink/publisher.h"

#include <chrono>
#include <utility>

#include "plugin/openigtlink/frame.h"

namespace palpate::plugin::igtl {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::uint64_t velocity_ticks = 10;
constexpr auto between_frames =
    std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1 / frames_per_s));

double utc_s() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

/// The last tick there is; waits for the first one.
TickRecord newest(const TickRing& ticks) {
  TickRecord tick;
  for (int ms = 0; ms < 1000; ++ms) {
    const std::uint64_t written = ticks.written();
    if (written > 0 && ticks.read(written - 1, tick)) return tick;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return tick;
}

}  // namespace

Publisher::Publisher(Server& server, std::shared_ptr<const TickRing> ticks) : server_(server) {
  set_ticks(std::move(ticks));
  thread_ = std::thread([this] { run(); });
}

Publisher::~Publisher() {
  stop_ = true;
  thread_.join();
}

void Publisher::set_ticks(std::shared_ptr<const TickRing> ticks) {
  const double began_s = ticks ? utc_s() - newest(*ticks).time_s : 0;
  const std::lock_guard lock(mutex_);
  ticks_ = std::move(ticks);
  began_s_ = began_s;
  first_epoch_.reset();
}

double Publisher::stamp_of(const TickRecord& tick) const {
  const std::lock_guard lock(mutex_);
  return began_s_ + tick.time_s;
}

void Publisher::set_workspace(std::uint32_t epoch, const modes::Workspace& workspace) {
  const std::lock_guard lock(mutex_);
  if (first_epoch_) {
    workspace_.change_to(workspace, epoch);
  } else {
    workspace_.set(workspace);
    first_epoch_ = epoch;
  }
  last_epoch_ = epoch;
}

void Publisher::set_orientation(const std::optional<glm::dquat>& orientation) {
  const std::lock_guard lock(mutex_);
  orientation_ = orientation;
}

std::optional<modes::Workspace> Publisher::workspace_of(const TickRecord& tick) {
  const bool is_known = first_epoch_ && tick.scene_epoch >= *first_epoch_ && tick.scene_epoch <= last_epoch_;
  return is_known ? std::optional(workspace_.at(tick)) : std::nullopt;
}

std::optional<Bytes> Publisher::newest_frame() {
  const std::lock_guard lock(mutex_);
  const std::uint64_t written = ticks_ ? ticks_->written() : 0;
  TickRecord tick, before;
  if (written == 0 || !ticks_->read(written - 1, tick)) return std::nullopt;
  const bool has_before = written > velocity_ticks && ticks_->read(written - 1 - velocity_ticks, before);
  const auto workspace = workspace_of(tick);
  if (!workspace) return std::nullopt;
  return wire_of(frame_of(tick, has_before ? std::optional(before) : std::nullopt, *workspace, orientation_),
                 began_s_ + tick.time_s);
}

void Publisher::run() {
  auto next = Clock::now();
  while (!stop_) {
    if (auto frame = newest_frame()) server_.offer(frame_name, std::move(*frame), true);
    next = std::max(next + between_frames, Clock::now());  // frames that were missed are not made up for
    for (auto left = Clock::duration(0); left >= Clock::duration(0) && !stop_; left = next - Clock::now()) {
      server_.step(std::chrono::ceil<std::chrono::milliseconds>(left));
    }
  }
  const auto end = Clock::now() + std::chrono::milliseconds(100);
  while (Clock::now() < end) server_.step(std::chrono::milliseconds(10));
}

}  // namespace palpate::plugin::igtl

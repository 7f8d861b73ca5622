#include "device/link/given_force.h"

#include <algorithm>
#include <limits>

#include "device/vectors.h"

namespace palpate::device {

namespace {

// A pose may be on its way while a zero is given. The second pose after it was sent after the zero was taken.
constexpr std::uint64_t poses_until_taken = 2;
constexpr double never = -std::numeric_limits<double>::infinity();

}  // namespace

void GivenForce::start(double now) noexcept {
  *this = {};
  taken_time_ = now;
}

void GivenForce::restart() noexcept {
  given_ = Vec3(0);
  gain_ = 0;
}

Vec3 GivenForce::next(const Vec3& wanted, bool withheld, double now) noexcept {
  // A device that was just opened, waited so long, or refused, may have taken its force away by itself, or hold it
  // still. Only a zero is no step in both cases: the ramp begins at this time.
  if (now - given_time_ > ceiling::link_force_age_s) {
    restart();
    time_ = now;
  }
  const double elapsed = std::clamp(now - time_, 0.0, ceiling::slew_time_s);
  time_ = now;
  gain_ = withheld ? 0 : std::min(1.0, gain_ + elapsed / ceiling::resume_ramp_s);
  const double since_given = std::clamp(now - given_time_, 0.0, ceiling::slew_time_s);
  const Vec3 target = gain_ * clamp_length(wanted, ceiling::force_n);
  const Vec3 change = target - given_;
  const Vec3 step = clamp_length(change, ceiling::slew_n_per_s * since_given);
  return step == change ? target : given_ + step;
}

OnDevice GivenForce::while_giving(const Vec3& force, std::uint64_t news) noexcept {
  if (force != Vec3(0)) {
    on_device_ = OnDevice::pushing;
    zero_given_ = false;
  } else if (zero_given_ && news >= zero_news_ + poses_until_taken) {
    on_device_ = OnDevice::zero_taken;
  }
  return on_device_;
}

void GivenForce::answered(ForceAnswer answer, const Vec3& force, std::uint64_t news, double now) noexcept {
  refuses_ = answer == ForceAnswer::refused;
  if (answer == ForceAnswer::waiting) return;
  if (refuses_) {
    zero_given_ = false;
    doubt();
    given_time_ = never;
    return;
  }
  taken_time_ = given_time_ = now;
  given_ = force;
  if (answer == ForceAnswer::withheld) restart();
  if (given_ == Vec3(0) && !zero_given_) {
    zero_given_ = true;
    zero_news_ = news;
  }
}

void GivenForce::doubt() noexcept {
  if (on_device_ != OnDevice::zero_taken) on_device_ = OnDevice::unknown;
}

}  // namespace palpate::device

#pragma once

/// A stylus that is open. What it can do is known once it is open (device::Specification), so a scene is planned after
/// the stylus is opened and before its session begins.

#include <memory>
#include <utility>

#include "device/stylus.h"

namespace palpate::plugin {

class OpenStylus {
 public:
  /// Throws what Stylus::open() throws.
  explicit OpenStylus(std::shared_ptr<device::Stylus> stylus) : stylus_(std::move(stylus)) { stylus_->open(); }
  /// Opens it, unless it is open already.
  static OpenStylus of(std::shared_ptr<device::Stylus> stylus) {
    return stylus->state() == device::State::disconnected ? OpenStylus(std::move(stylus))
                                                          : OpenStylus(std::move(stylus), Open{});
  }
  OpenStylus(OpenStylus&& other) noexcept = default;
  OpenStylus& operator=(OpenStylus&&) = delete;
  OpenStylus(const OpenStylus&) = delete;
  OpenStylus& operator=(const OpenStylus&) = delete;
  /// Closes it, unless it was released.
  ~OpenStylus() {
    if (stylus_) stylus_->close();
  }

  device::Specification specification() const { return stylus_->specification(); }
  /// From now on the caller has to close it.
  std::shared_ptr<device::Stylus> release() noexcept { return std::exchange(stylus_, nullptr); }

 private:
  struct Open {};
  OpenStylus(std::shared_ptr<device::Stylus> open, Open /*is open already*/) noexcept : stylus_(std::move(open)) {}

  std::shared_ptr<device::Stylus> stylus_;
};

}  // namespace palpate::plugin

#pragma once

/// 3Dconnexion's SpaceMouse family and its ancestors: a puck that is pushed and does not travel. It gives no force. It
/// reports a rate, which is integrated to a pose. Tested against a fake of its reports: never run on hardware.

#include <memory>
#include <string>

#include "device/stylus.h"

namespace palpate::device {

struct SpaceMouseSettings {
  std::string address;                 ///< the hidraw path; empty: the only one
  double speed = 0.1;                  ///< m/s at full deflection
  double dead_zone = 0.08;             ///< of full deflection
  double full_deflection = 350;        ///< of a report's int16
  Vec3 half_extent{0.08, 0.06, 0.06};  ///< m: the pose stays within
};

/// The stylus is not open yet. open() throws std::runtime_error naming the device and what to do.
std::unique_ptr<Stylus> make_space_mouse(const SpaceMouseSettings& settings = {});

/// Whether USB ids are a puck's. 3Dconnexion's keyboards and mice without a puck have the same vendor id.
bool is_space_mouse(unsigned vendor, unsigned product) noexcept;

}  // namespace palpate::device

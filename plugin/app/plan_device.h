#pragma once

/// The device's part of a plan: what holding this stylus leaves out, why, and what that saves.

#include <string>
#include <vector>

#include "device/stylus.h"
#include "plugin/app/plan_savings.h"

namespace palpate::plugin {

/// `device` as --device names it. Takes some milliseconds.
std::vector<Saving> savings_of_device(const std::string& device, const device::Specification& specification);

}  // namespace palpate::plugin

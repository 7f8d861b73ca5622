#pragma once

/// The effect of the stylus on a plan: which parts are left out because of it, why, and what that saves.

#include <string>
#include <vector>

#include "device/stylus.h"
#include "plugin/app/plan_savings.h"

namespace palpate::plugin {

/// `device` as in --device. Takes some milliseconds.
std::vector<Saving> savings_of_device(const std::string& device, const device::Specification& specification);

}  // namespace palpate::plugin

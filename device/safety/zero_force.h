#pragma once

#include <string>

namespace palpate::device {

/// Opens the device and sends zeros until it has taken some; for the guardian, which knows nothing of its state.
/// Retries while a dying process still holds it, for at most `patience` s. False where the device is gone. `take_away`:
/// from a process that is stopped and will not let go of it.
bool send_zero_force(const std::string& kind, const std::string& address, double patience, bool take_away = false);

}  // namespace palpate::device

#pragma once

/// Whether a place in one scan is the same place in another.

#include <tuple>

#include "io/volume.h"

namespace palpate::plugin {

/// Whether both are of one patient, in one frame of reference. False if a frame of reference is unknown.
inline bool have_same_space(const io::Volume& a, const io::Volume& b) noexcept {
  const auto of = [](const io::Volume& volume) {
    return std::tie(volume.frame_of_reference_uid, volume.patient_id, volume.patient_name);
  };
  return !a.frame_of_reference_uid.empty() && of(a) == of(b);
}

}  // namespace palpate::plugin

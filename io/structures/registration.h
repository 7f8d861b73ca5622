#pragma once

/// Registrations between frames of reference: DICOM REG (Spatial Registration).

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/structures/rigid_motion.h"
#include "solver/text/message.h"

class DcmDataset;

namespace palpate::io {

struct Registration {
  std::filesystem::path file;
  std::string frame_of_reference_uid;  ///< the target frame
  std::string patient_id;              ///< used only for comparison; never written or shown
  struct Part {
    std::string frame_of_reference_uid;  ///< the registered frame
    RigidMotion motion;                  ///< from the registered frame to the target
    Text unfit;                          ///< why it cannot be applied; empty if it can
  };
  std::vector<Part> parts;
};

/// Reads a Spatial Registration (PS3.3 C.20.2), or a deformable one (C.20.3), which is listed but not applied. Nothing
/// if the dataset is neither.
std::optional<Registration> registration_in(DcmDataset& dataset, const std::filesystem::path& path);

/// The motion from one frame of reference to another, or the reason for its absence. Both are empty if no registration
/// contains both frames.
struct Joined {
  std::optional<RigidMotion> motion;
  std::filesystem::path file;  ///< the registration's file
  Text why_not;
};

/// Several registrations may join the two if they agree. Registrations of a patient with an id other than `patient_id`
/// are ignored.
Joined join(std::span<const Registration> registrations, const std::string& from, const std::string& to,
            const std::string& patient_id);

}  // namespace palpate::io

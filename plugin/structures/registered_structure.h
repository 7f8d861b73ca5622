#pragma once

/// Which registration put a structure on a scan. Recordings hold it, so that a session is repeated where the
/// registration is not, or where the study has got another one.

#include <string>

#include "io/structures/rigid_motion.h"

namespace palpate::plugin {

struct RegisteredStructure {
  std::string structure;   ///< its name in the scene
  std::string file_hash;   ///< of the registration's file (structure_files.h)
  io::RigidMotion motion;  ///< from the frame of reference that it was outlined in to the scan's

  bool operator==(const RegisteredStructure&) const = default;
};

/// "12.0, 0.0, -3.5 mm" and, if it turns, ", turned by 2.5 degrees".
std::string in_words(const io::RigidMotion& motion);

}  // namespace palpate::plugin

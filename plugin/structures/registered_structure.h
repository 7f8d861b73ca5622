#pragma once

/// The registration that placed a structure on a scan. Recordings store it, so that a session can be replayed where the
/// registration is missing, or after the study has got another one.

#include <string>

#include "io/structures/rigid_motion.h"

namespace palpate::plugin {

struct RegisteredStructure {
  std::string structure;   ///< its name in the scene
  std::string file_hash;   ///< of the registration's file (structure_files.h)
  io::RigidMotion motion;  ///< from the structure's frame of reference to the scan's

  bool operator==(const RegisteredStructure&) const = default;
};

/// "12.0, 0.0, -3.5 mm" and, if there is a rotation, ", turned by 2.5 degrees".
std::string in_words(const io::RigidMotion& motion);

}  // namespace palpate::plugin

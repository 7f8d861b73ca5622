#pragma once

/// A session in a file: HDF5, so that NumPy, MATLAB, R and ParaView's users read it without us, tables grow as they are
/// written, and columns that hardly change cost little.
///
///   /frames   one row a tick: the members of Frame
///   /shares   one row a primitive and tick: the members of Share
///   attributes of /: those of RecordingHeader
///
/// No patient's name or identifier and no path goes into it; the scan is named by a hash of its voxels and geometry.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "palpate/plugin/frame.h"

namespace palpate::plugin {

struct RecordingHeader {
  std::string palpate_version;
  std::string scene;      ///< the scene's JSON
  std::string device;     ///< its specification's name
  std::string scan_hash;  ///< 16 hexadecimal digits
  double seed = 0;        ///< of the simulated hand
};

struct Recording {
  RecordingHeader header;
  std::vector<Frame> frames;
  std::vector<Share> shares;  ///< frame by frame, in the order of the primitives
};

/// Writes beside the file and renames, so that nothing half-written is left. Throws std::runtime_error naming the file.
void write_recording(const Recording& recording, const std::filesystem::path& file);

/// Throws std::runtime_error naming the file and what is missing in it.
Recording read_recording(const std::filesystem::path& file);

}  // namespace palpate::plugin

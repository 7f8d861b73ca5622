#pragma once

/// A session in a file: HDF5, so that NumPy, MATLAB, R and ParaView's users read it without us, tables grow as they are
/// written, and columns that hardly change cost little; in its single-writer mode (SWMR), in which what is in the file
/// can be read at any moment, also after a crash.
///
///   /frames   one row a tick: the members of TickRecord
///   /shares   one row a primitive and tick: the members of PrimitiveRecord
///   /events   lines of JSON: scenes as they came, styluses, and frames that were lost
///   /palpate_version, /device, /scan_hash, /seed, /rate_hz   texts
///
/// No patient's name or identifier and no path goes into it; the scan is named by a hash of its voxels and geometry,
/// the file of a structure by one of its content.

#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "plugin/session/tick_record.h"

namespace palpate::plugin {

struct RecordingHeader {
  std::string palpate_version;
  std::string scene;      ///< the first scene's JSON
  std::string device;     ///< the first stylus' name
  std::string scan_hash;  ///< of the first scan: 16 hexadecimal digits
  double seed = 0;        ///< of the simulated hand
  double rate_hz = 1000;
};

/// A scene as it was published, with all that is needed to make its Snapshot again.
struct SceneRecord {
  std::uint32_t epoch = 0;  ///< TickRecord::scene_epoch
  std::string scene;        ///< JSON
  std::string scan_hash;
  glm::dvec3 half_extent_m{0};   ///< of the stylus that the workspace was placed for
  double maximum_force_n = 1e9;  ///< of that stylus
  double change_s = 0.5;         ///< how long the change to it took
  /// Names of those whose distances the frames tell, in the order of TickRecord::distance_mm.
  std::vector<std::string> structures = {};
};

struct StylusRecord {
  std::uint32_t epoch = 0;  ///< TickRecord::stylus_epoch
  std::string name;
  int force_axes = 3;
  double maximum_force_n = 1e9;
};

/// Frames that the recorder did not get: the disk was slower for longer than the ring holds.
struct Gap {
  std::uint64_t first_frame = 0;
  std::uint64_t frames = 0;
};

struct Recording {
  RecordingHeader header;
  std::vector<TickRecord> frames;
  std::vector<PrimitiveRecord> shares;  ///< frame by frame, in the order of the primitives
  std::vector<SceneRecord> scenes;
  std::vector<StylusRecord> styluses;
  std::vector<Gap> gaps;
  bool complete = true;  ///< false: the file was not closed in good order; what was flushed is here
};

/// Writes beside the file and renames, so that nothing half-written is left. Throws std::runtime_error naming the file.
void write_recording(const Recording& recording, const std::filesystem::path& file);

/// Also one that is still being written, or was when its writer died. Throws std::runtime_error naming the file and
/// what is missing in it.
Recording read_recording(const std::filesystem::path& file);

/// One line a frame, every member a column. Throws std::runtime_error naming the file.
void write_csv(const Recording& recording, const std::filesystem::path& file);

}  // namespace palpate::plugin

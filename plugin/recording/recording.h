#pragma once

/// A session in an HDF5 file. NumPy, MATLAB, R and ParaView's users can read it without Palpate; tables grow as they
/// are written; columns that hardly change take little room. The file is written in HDF5's single-writer mode (SWMR),
/// so that its content can be read at any moment, also after a crash.
///
///   /frames   one row a tick: the members of TickRecord
///   /shares   one row a primitive and tick: the members of PrimitiveRecord
///   /known_to_mm   one number a tick: how precisely the place of the boundary that holds the proxy is known
///   /events   lines of JSON: scenes, styluses, and ticks that were lost, in the order in which they came
///   /palpate_version, /device, /scan_hash, /seed, /rate_hz   texts
///
/// The file holds no patient's name or identifier and no path. A scan is named by a hash of its voxels and geometry,
/// and the file of a structure or registration by a hash of its content.

#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "plugin/session/tick_record.h"
#include "plugin/structures/registered_structure.h"

namespace palpate::plugin {

struct RecordingHeader {
  std::string palpate_version;
  std::string scene;      ///< the first scene's JSON
  std::string device;     ///< the first stylus' name
  std::string scan_hash;  ///< of the first scan: 16 hexadecimal digits
  double seed = 0;        ///< of the simulated hand
  double rate_hz = 1000;
};

/// The felt frame of a series with several images at a position.
struct ScanFrame {
  int number = 0;  ///< from 0
  int count = 1;

  bool operator==(const ScanFrame&) const = default;
};

/// A scene as published, with everything that is needed to make its Snapshot again.
struct SceneRecord {
  std::uint32_t epoch = 0;  ///< TickRecord::scene_epoch
  std::string scene;        ///< JSON
  std::string scan_hash;
  glm::dvec3 half_extent_m{0};   ///< of the stylus for which the workspace was computed
  double maximum_force_n = 1e9;  ///< of that stylus
  double change_s = 0.5;         ///< duration of the change to it
  /// The structures with recorded distances, by name, in the order of TickRecord::distance_mm.
  std::vector<std::string> structures = {};
  /// Those of them that were placed by a registration. Also empty in recordings of versions before 0.2.0.
  std::vector<RegisteredStructure> registered = {};
  std::optional<ScanFrame> frame = std::nullopt;  ///< none in recordings of versions before 0.2.0
};

struct StylusRecord {
  std::uint32_t epoch = 0;  ///< TickRecord::stylus_epoch
  std::string name;
  int force_axes = 3;
  double maximum_force_n = 1e9;
};

/// Ticks that the recorder missed because the disk was slow for longer than the ring can hold.
struct Gap {
  std::uint64_t first_tick = 0;
  std::uint64_t ticks = 0;
};

struct Recording {
  RecordingHeader header;
  std::vector<TickRecord> ticks;
  std::vector<PrimitiveRecord> shares;  ///< tick by tick, in the order of the primitives
  /// One for each tick: at 95 of 100 places the true boundary is within this of the proxy, mm
  /// (io/fields/boundary_uncertainty.h). NaN if no boundary of the scan holds the proxy, while a scene changes, or if
  /// the recording thread was far behind. Empty in recordings of versions before 0.2.0.
  std::vector<double> known_to_mm;
  std::vector<SceneRecord> scenes;
  std::vector<StylusRecord> styluses;
  std::vector<Gap> gaps;
  bool complete = true;  ///< false: the file was not closed properly; these are the flushed ticks
};

/// Writes to a second file and renames it, so that no half-written file is left. Throws std::runtime_error that names
/// the file.
void write_recording(const Recording& recording, const std::filesystem::path& file);

/// Can also read a file that is still being written, or whose writer crashed. Throws std::runtime_error that names the
/// file and what is missing in it.
Recording read_recording(const std::filesystem::path& file);

/// The felt frames of the series, each once, in the order of first use. Empty if the recording does not contain them.
std::vector<ScanFrame> scan_frames_of(const Recording& recording);

/// The registrations that placed structures on the scan, each once.
std::vector<RegisteredStructure> registered_of(const Recording& recording);

/// One line for each tick, one column for each member. Throws std::runtime_error naming the file.
void write_csv(const Recording& recording, const std::filesystem::path& file);

}  // namespace palpate::plugin

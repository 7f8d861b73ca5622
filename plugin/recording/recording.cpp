#include "plugin/recording/recording.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>

#include "plugin/messages/messages.h"
#include "plugin/recording/recording_rows.h"
#include "plugin/recording/recording_writer.h"

namespace palpate::plugin {
namespace {

using hdf5::check;
using hdf5::Handle;

struct Source {
  Handle file;
  std::uintmax_t bytes = 0;  ///< of the whole file
};

/// Before memory is taken: a damaged file of a few kB may claim to hold any number of rows.
void check_claim(const Source& source, hid_t data, const std::string& name, std::uintmax_t count, std::size_t size) {
  constexpr std::uintmax_t most_packed = 1032;        // bytes that deflate makes of one
  constexpr std::uintmax_t not_yet_stored = 1 << 24;  // a writer that died had set the length, but not written the rows
  constexpr std::uintmax_t most = std::numeric_limits<std::uintmax_t>::max();
  const std::uintmax_t claimed = size > 0 && count > most / size ? most : count * size;
  const std::uintmax_t stored = std::min<std::uintmax_t>(H5Dget_storage_size(data), source.bytes);
  if (claimed > not_yet_stored && (claimed - not_yet_stored) / most_packed > stored) {
    throw Refusal(say("claims-more-than-is-stored", name, claimed, stored));
  }
}

template <typename Row>
std::vector<Row> read_table(const Source& source, const char* name, const Handle& type) {
  const Handle table(H5Dopen2(source.file, name, H5P_DEFAULT), H5Dclose, "find-what-a-recording-holds");
  const Handle space(H5Dget_space(table), H5Sclose, "read-what-is-in-it");
  const auto count = static_cast<std::size_t>(std::max<hssize_t>(0, H5Sget_simple_extent_npoints(space)));
  check_claim(source, table, name, count, sizeof(Row));
  std::vector<Row> rows(count);
  if (!rows.empty()) {
    check(H5Dread(table, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data()), "read-what-is-in-it");
  }
  return rows;
}

std::string read_text(const Source& source, const char* name) {
  const Handle data(H5Dopen2(source.file, name, H5P_DEFAULT), H5Dclose, "find-what-a-recording-holds");
  const Handle type(H5Dget_type(data), H5Tclose, "read-what-is-in-it");
  const Handle space(H5Dget_space(data), H5Sclose, "read-what-is-in-it");
  // One text of a known length, as ours are: H5Dread() writes as many as there are.
  const bool is_one = H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0;
  check(is_one && H5Sget_simple_extent_npoints(space) == 1 ? 0 : -1, "read-what-is-in-it");
  check_claim(source, data, name, H5Tget_size(type), 1);
  std::string text(H5Tget_size(type), '\0');
  check(H5Dread(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()), "read-what-is-in-it");
  text.resize(std::min(text.size(), text.find('\0')));
  return text;
}

/// Says whether the file was closed in good order.
Handle open(const std::filesystem::path& file, bool& complete) {
  const hid_t closed = H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  complete = closed >= 0;
  if (complete) {
    return {closed, H5Fclose, "open-it"};
  }
  // What does not match its checksum may be half written: HDF5 reads it again, and each time waits twice as long, from
  // a nanosecond on. Of a hundred attempts, its default, none would see the end.
  constexpr unsigned attempts = 24;
  const Handle patience(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "open-it-as-a-recording");
  check(H5Pset_metadata_read_attempts(patience, attempts), "open-it-as-a-recording");
  return {H5Fopen(file.c_str(), H5F_ACC_RDONLY | H5F_ACC_SWMR_READ, patience), H5Fclose, "open-it-as-a-recording"};
}

/// Where the writer died between two tables, only ticks with all their shares count.
void keep_whole_ticks(Recording& recording) {
  std::size_t shares = 0;
  std::size_t ticks = 0;
  for (; ticks < recording.ticks.size(); ++ticks) {
    const std::size_t with_it = shares + recording.ticks[ticks].share_count;
    if (with_it > recording.shares.size()) {
      break;
    }
    shares = with_it;
  }
  recording.ticks.resize(ticks);
  recording.shares.resize(shares);
  if (!recording.known_to_mm.empty()) recording.known_to_mm.resize(ticks, std::numeric_limits<double>::quiet_NaN());
}

}  // namespace

void write_recording(const Recording& recording, const std::filesystem::path& file) {
  RecordingWriter writer(file, recording.header);
  try {
    if (recording.scenes.empty() && !recording.header.scene.empty()) {
      writer.append(SceneRecord{.scene = recording.header.scene, .scan_hash = recording.header.scan_hash});
    }
    for (const SceneRecord& scene : recording.scenes) {
      writer.append(scene);
    }
    for (const StylusRecord& stylus : recording.styluses) {
      writer.append(stylus);
    }
    for (const Gap& gap : recording.gaps) {
      writer.append(gap);
    }
    writer.append(recording.ticks, recording.shares, recording.known_to_mm);
    writer.finish();
  } catch (...) {
    std::error_code ignored;
    std::filesystem::remove(writer.partial(), ignored);
    throw;
  }
}

Recording read_recording(const std::filesystem::path& file) {
  hdf5::silence();
  try {
    Recording recording;
    const Source input{open(file, recording.complete), std::filesystem::file_size(file)};
    recording.header.palpate_version = read_text(input, "palpate_version");
    recording.header.device = read_text(input, "device");
    recording.header.scan_hash = read_text(input, "scan_hash");
    recording.header.seed = std::stod(read_text(input, "seed"));
    recording.header.rate_hz = std::stod(read_text(input, "rate_hz"));
    // Ticks first: a writer may meanwhile add shares, which then belong to later ticks.
    recording.ticks = read_table<TickRecord>(input, "frames", tick_row_type());
    recording.shares = read_table<PrimitiveRecord>(input, "shares", share_row_type());
    if (H5Lexists(input.file, "known_to_mm", H5P_DEFAULT) > 0) {
      recording.known_to_mm = read_table<double>(input, "known_to_mm", known_to_row_type());
    }
    keep_whole_ticks(recording);
    const Handle byte(H5Tcopy(H5T_NATIVE_UINT8), H5Tclose, "read-what-is-in-it");
    const auto events = read_table<char>(input, "events", byte);
    read_events({events.data(), events.size()}, recording);
    if (!recording.scenes.empty()) {
      recording.header.scene = recording.scenes.front().scene;
    }
    return recording;
  } catch (const std::exception& error) {
    throw Refusal(say("cannot-read-the-recording", file.string(), error.what()));
  }
}

std::vector<RegisteredStructure> registered_of(const Recording& recording) {
  std::vector<RegisteredStructure> registered;
  for (const SceneRecord& scene : recording.scenes) {
    for (const RegisteredStructure& one : scene.registered) {
      if (std::ranges::find(registered, one) == registered.end()) registered.push_back(one);
    }
  }
  return registered;
}

std::vector<ScanFrame> scan_frames_of(const Recording& recording) {
  std::vector<ScanFrame> frames;
  for (const SceneRecord& scene : recording.scenes) {
    if (scene.frame && std::ranges::find(frames, *scene.frame) == frames.end()) frames.push_back(*scene.frame);
  }
  return frames;
}

}  // namespace palpate::plugin

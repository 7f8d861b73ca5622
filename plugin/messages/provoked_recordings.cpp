#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "io/load.h"
#include "io/series.h"
#include "plugin/messages/provoked.h"
#include "plugin/recording/recorded_session.h"
#include "plugin/recording/recorder.h"
#include "plugin/recording/recording.h"
#include "plugin/session/tick_ring.h"
#include "plugin/testing/command_rig.h"

namespace palpate::plugin::testing {
namespace {

using palpate::testing::said_when;

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

void write_bytes(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

namespace fs = std::filesystem;

std::string press(const fs::path& file, const std::string& seconds) {
  return std::string(PALPATE_PROGRAM) + " record " + phantom().string() +
         " --scene ct-skin-and-bone --from 0,-29,0 --to 0,0,0 --seconds " + seconds + " -o " + file.string();
}

/// A recording where no file may grow beyond so many bytes: as on a disk that is full.
std::string recorded_within(int bytes, const fs::path& file, const std::string& seconds) {
  return output_of(fmt::format("prlimit --fsize={} sh -c \"trap '' XFSZ; {}\"", bytes, press(file, seconds)));
}

io::Volume ball() {
  return io::load(io::find_series(std::array{phantom()}).series.at(0));
}

/// What replay says of a recording that was changed.
std::string replayed(const Recording& recording, const std::function<void(Recording&)>& change) {
  Recording changed = recording;
  change(changed);
  const auto file = fresh_path("changed.h5");
  write_recording(changed, file);
  return palpate("replay " + file.string() + " " + phantom().string()).output;
}

std::string of_little_room() {
  TickRing ring(16);
  Recorder recorder(ring, fresh_path("room.h5"), {}, {.spare_bytes = std::uintmax_t{1} << 62U});
  return recorder.finish().why;
}

/// The middle of the file overwritten: compressed ticks that cannot be inflated.
std::string of_damage(const fs::path& recording) {
  std::string bytes = bytes_of(recording);
  bytes.replace(bytes.size() / 2, 2000, 2000, '\x55');
  const auto file = fresh_path("damaged.h5");
  write_bytes(file, bytes);
  return said_when([&] { read_recording(file); });
}

std::string of_another_hdf5_file() {
  const auto file = fresh_path("other.h5");
  write_recording({}, file);
  std::string bytes = bytes_of(file);
  for (std::size_t at = bytes.find("scan_hash"); at != std::string::npos; at = bytes.find("scan_hash", at)) {
    bytes[at] = 'S';
  }
  write_bytes(file, bytes);
  return said_when([&] { read_recording(file); });
}

}  // namespace

std::vector<Provoked> provoke_recordings() {
  const auto good = fresh_path("good.h5");
  output_of(press(good, "1.2"));
  const Recording recording = read_recording(good);
  const auto full = fresh_path("full.h5");
  const std::string unrecorded = recorded_within(12288, full, "1.2");
  const io::Volume scan = ball();
  io::Volume another = scan;
  another.slope *= 2;
  return {
      {"goes-on-unrecorded", unrecorded},
      {"what-was-written-before", unrecorded},
      {"write-is-the-disk-full", unrecorded},
      {"not-closed-in-good-order", palpate("replay " + full.string() + ".partial --csv /dev/null").output},
      {"let-the-file-be-read-while", recorded_within(1000, fresh_path("tiny.h5"), "0.1")},
      {"less-than-mib-are-left-on", of_little_room()},
      {"open-it", said_when([] { read_recording("/absent.h5"); })},
      {"find-what-a-recording-holds", of_another_hdf5_file()},
      {"read-what-is-in-it", of_damage(good)},
      {"recording-lacks", replayed(recording,
                                   [](Recording& changed) {
                                     for (SceneRecord& scene : changed.scenes) scene.epoch += 7;
                                   })},
      {"replay-is-not-the-session", replayed(recording,
                                             [](Recording& changed) {
                                               for (TickRecord& tick : changed.ticks) tick.proxy_m[0] += 0.001;
                                             })},
      {"recording-is-empty", said_when([&] { RecordedSession({}, scan); })},
      {"recorded-on-another-scan-open", said_when([&] { RecordedSession(recording, another); })},
      {"table-cannot-be-written", palpate("profile " + phantom().string() + forehead + "--table /absent/a.csv").output},
  };
}

}  // namespace palpate::plugin::testing

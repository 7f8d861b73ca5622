#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcdeftag.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <string>

#include "device/simulated/simulated_stylus.h"
#include "io/testing/test_image.h"
#include "plugin/app/live_session.h"
#include "plugin/messages/provoked.h"
#include "plugin/session/path.h"
#include "plugin/testing/command_rig.h"

namespace palpate::plugin::testing {
namespace {

using palpate::testing::said_when;

std::string file_with(const std::string& name, const std::string& text) {
  const auto file = fresh_path(name);
  std::ofstream(file) << text;
  return file.string();
}

std::string scene_with(const std::string& member) {
  return R"({"version": 1, "modes": [{"type": "surface", "strength_n": {"of": "gradient_per_mm", "nodes": [[20, 0], [60, 1]]}}], )" +
         member + "}";
}

std::string small_ball() {
  const auto folder = fresh_path("small_ball");
  testdata::write_series(testdata::scan(testdata::make_sphere(10), testdata::make_geometry({.size = glm::ivec3(30)})),
                         folder);
  return folder.string();
}

/// Two stacks across each other that have one series UID.
std::string two_of_one_uid() {
  const auto folder = fresh_path("across");
  for (const bool sagittal : {false, true}) {
    const auto part = folder / (sagittal ? "sagittal" : "axial");
    std::filesystem::create_directories(part);
    io::internal::write_stack(part, 3, [&](int k, io::internal::TestImage& image) {
      if (!sagittal) return;
      image.edit = [k](DcmDataset& d) {
        io::internal::put(d, DCM_ImageOrientationPatient, std::string("0\\1\\0\\0\\0\\-1"));
        io::internal::put(d, DCM_ImagePositionPatient, std::to_string(3 * k) + "\\0\\50");
      };
    });
  }
  return folder.string();
}

/// Tubes and friction without the solvers that they need.
const std::string unsolvable =
    R"({"version": 1, "solvers": {"exact": false, "descent": false}, "modes": [)"
    R"({"type": "surface", "strength_n": {"of": "gradient_per_mm", "nodes": [[20, 0], [60, 1]]}},)"
    R"({"type": "tube", "strength_n": {"of": "gradient_per_mm", "nodes": [[20, 0], [60, 1]]}},)"
    R"({"type": "friction", "strength_n": 0.2}]})";

/// A session whose user may neither have real-time threads nor lock memory: root may, unless it has given that up.
std::string without_real_time() {
  const std::string as_any_user = ::geteuid() == 0 ? "setpriv --bounding-set=-sys_nice,-ipc_lock " : "";
  return output_of("ulimit -r 0; ulimit -l 0; " + as_any_user + PALPATE_PROGRAM " record " + phantom().string() +
                   " --scene ct-skin-and-bone --seconds 0.1 --from 0,-29,0 --to 0,0,0 -o " +
                   fresh_path("late.h5").string());
}

std::string said(const std::string& arguments) {
  return palpate(arguments).output;
}

std::string letter() {
  return file_with("letter.txt", "This is no scan.");
}

/// A folder with two scans of balls.
std::filesystem::path two_balls() {
  const auto two = fresh_path("two");
  std::filesystem::create_directory(two);
  for (const char* const name : {"one", "other"}) {
    const testdata::Phantom ball = testdata::make_sphere(name == std::string("one") ? 5 : 8);
    testdata::write_series(testdata::scan(ball, testdata::make_geometry({.size = glm::ivec3(16)})), two / name);
  }
  return two;
}

std::string air_alone() {
  const auto air = fresh_path("air");
  testdata::write_series(testdata::scan(testdata::make_sphere(0.01), testdata::make_geometry({.size = glm::ivec3(16)})),
                         air);
  return air.string();
}

/// Of choosing and reading a scan.
std::vector<Provoked> of_scans(const std::string& scan, const std::string& two) {
  return {
      {"choose-a-series", said("profile " + two + forehead)},
      {"no-such-frame", said("profile " + scan + forehead + "--frame 7")},
      {"there-is-no-series", said("profile " + scan + forehead + "--series 9")},
      {"no-usable-series", said("profile " + letter() + forehead)},
      {"none-is-an-image", said("profile " + letter() + forehead)},
      {"no-image-series-in-what-was-given", said("info " + letter())},
      {"volumes-do-not-fit-together", said("profile " + two_of_one_uid() + forehead + "--series 1.2.3.4")},
      {"no-boundary-between-tissues-was-found", said("suggest " + air_alone())},
  };
}

/// Of a line or a path through a scan.
std::vector<Provoked> of_paths(const std::string& scan) {
  const std::string path = "probe " + scan + " --scene ct-skin-and-bone -o " + fresh_path("out").string() + " --path ";
  return {
      {"not-a-point", said("profile " + scan + " --from a --to 0,0,0")},
      {"speed-has-to-be-above-0-mm", said("profile " + scan + forehead + "--speed 0")},
      {"stroke-has-no-ticks", said("profile " + scan + forehead + "--speed 1e-9")},
      {"line-not-four-finite-numbers", said(path + file_with("a.csv", "0,1,2\n"))},
      {"line-time-s-does-not-come-after", said(path + file_with("b.csv", "0,1,2,3\n0,2,3,4\n"))},
      {"path-needs-at-least-two-points", said(path + file_with("c.csv", "0,1,2,3\n"))},
      {"path-point-at-s", said(path + file_with("d.csv", "0,0,0,0\n1,9000,0,0\n"))},
      {"cannot-open-the-path-file", said_when([] { read_path_csv("/absent.csv"); })},
      {"scene-lets-nothing-be-felt-between",
       said("probe " + scan + " --scene ct-skin-and-bone --from 0,-29,0 --to 0,-28,0 -o " + fresh_path("n").string())},
      {"balance-not-solved", said("profile " + small_ball() + " --from 0,-14,0 --to 3,0,2 --scene " +
                                  file_with("unsolved.json", unsolvable))},
  };
}

/// Of writing a recording and of reading it again.
std::vector<Provoked> of_recordings(const std::string& scan, const std::filesystem::path& other) {
  const auto recording = fresh_path("press.h5");
  const std::string press = " --scene ct-skin-and-bone --seconds 1.2 --from 0,-29,0 --to 0,0,0 ";
  const std::string recorded = palpate("record " + scan + press + "-o " + recording.string()).output;
  return {
      {"exists-name-another-file", said("record " + scan + press + "-o " + recording.string())},
      {"cannot-read-the-recording", said("replay " + letter() + " " + scan)},
      {"cannot-write-the-recording", said("record " + scan + press + "-o /absent/a.h5")},
      {"hdf5-cannot", said("record " + scan + press + "-o /absent/a.h5")},
      {"create-the-file", said("record " + scan + press + "-o /absent/a.h5")},
      {"create-it-there", said("record " + scan + press + "-o /absent/a.h5")},
      {"open-it-as-a-recording", said("replay " + letter() + " " + scan)},
      {"stiffness-taken-down",
       said("record " + scan + " --seconds 0.2 --from 0,-29,0 --to 0,0,0 -o " + fresh_path("stiff.h5").string() +
            " --scene " + file_with("stiff.json", scene_with(R"("stiffness_n_per_m": 9000)")))},
      {"limit-drawn-down",
       said("record " + scan + " --seconds 0.2 --from 0,-29,0 --to 0,0,0 -o " + fresh_path("strong.h5").string() +
            " --scene " + file_with("strong.json", scene_with(R"("limits": {"force_limit_n": 1e9})")))},
      {"faults-cannot-be-played", output_of("PALPATE_FAULTS=/absent " PALPATE_PROGRAM " devices --faults")},
      {"real-time", without_real_time()},
      {"replay-needs-the-series-that-was-felt", said("replay " + recording.string())},
      {"recorded-on-another-scan", said("replay " + recording.string() + " " + other.string())},
      {"cannot-write-is-the-disk-full", said("replay " + recording.string() + " --csv /absent/a.csv")},
  };
}

/// Messages about the programs' input and output.
std::vector<Provoked> of_others(const std::string& scan) {
  const auto no_file = fresh_path("folder.json");
  std::filesystem::create_directory(no_file);
  const auto forces = [](const std::string& rest) { return output_of(PALPATE_BENCH " forces --trajectories " + rest); };
  return {
      {"device-there-is-no-device", said("probe " + scan + " --device hand -o " + fresh_path("h").string())},
      {"jpeg-lossless-needs-dcmcjpeg", output_of("PATH= " PALPATE_BENCH " load --jpeg-lossless " + scan)},
      {"standard-output-cannot-be-written", output_of("echo {} | " PALPATE_PROGRAM " solve > /dev/full")},
      {"standard-input-cannot-be-read", output_of(PALPATE_PROGRAM " solve < /")},
      {"cannot-write-the-picture", said("profile " + scan + forehead + "--picture /absent/a.png")},
      {"cannot-be-written", said("suggest " + scan + " -o " + no_file.string())},
      {"lines-not-solved", said("solve < " + letter())},
      {"tick-needs-a-scan", output_of(PALPATE_BENCH " tick")},
      {"trajectories-need-a-scan", forces("/absent")},
      {"cannot-open-the-trajectory", forces("/absent " + scan)},
      {"trajectory-columns-are-wrong", forces("/absent --columns x " + scan)},
      {"trajectory-line-has-other-columns", forces(file_with("few.traj", "1 2 3\n") + " " + scan)},
      {"trajectory-line-holds-no-number", forces(file_with("word.traj", "0 1 2 3 4 5 up\n") + " " + scan)},
      {"trajectory-time-does-not-ascend",
       forces(file_with("back.traj", "1 1 2 3 4 5 6\n0 1 2 3 4 5 6\n") + " " + scan)},
      {"trajectory-has-too-few-samples", forces(file_with("one.traj", "0 1 2 3 4 5 6\n") + " " + scan)},
      {"no-structure-lies-on-the-scan",
       output_of(PALPATE_BENCH " forces " + small_ball() + " --structures " + file_with("none.txt", "no labels"))},
      {"there-is-no-scan-to-feel-yet", said_when([] {
         LiveSession session;
         session.connect(std::make_shared<device::SimulatedStylus>());
       })},
      {"no-stylus-is-held", said_when([] { LiveSession().record("a.h5"); })},
  };
}

}  // namespace

std::vector<Provoked> provoke_programs() {
  const std::string scan = phantom().string();
  const std::filesystem::path two = two_balls();
  std::vector<Provoked> all;
  for (const std::vector<Provoked>& some :
       {of_scans(scan, two.string()), of_paths(scan), of_recordings(scan, two / "one"), of_others(scan)}) {
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

}  // namespace palpate::plugin::testing

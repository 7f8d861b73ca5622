#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcdeftag.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <string>

#include "device/simulated/simulated_stylus.h"
#include "plugin/app/live_session.h"
#include "plugin/messages/provoked.h"
#include "plugin/messages/provoked_scans.h"
#include "plugin/session/path.h"
#include "plugin/testing/command_rig.h"

namespace palpate::plugin::testing {
namespace {

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
    io::internal::write_stack(part, 3, [&](int k, TestImage& image) {
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

}  // namespace

std::vector<Provoked> provoke_programs() {
  const std::string scan = phantom().string();
  const auto two = fresh_path("two");
  std::filesystem::create_directory(two);
  for (const char* const name : {"one", "other"}) {
    const testdata::Phantom ball = testdata::make_sphere(name == std::string("one") ? 5 : 8);
    testdata::write_series(testdata::scan(ball, testdata::make_geometry({.size = glm::ivec3(16)})), two / name);
  }
  const auto air = fresh_path("air");
  testdata::write_series(testdata::scan(testdata::make_sphere(0.01), testdata::make_geometry({.size = glm::ivec3(16)})),
                         air);
  const auto no_file = fresh_path("folder.json");
  std::filesystem::create_directory(no_file);
  const auto recording = fresh_path("press.h5");
  const std::string press = " --scene ct-skin-and-bone --seconds 1.2 --from 0,-29,0 --to 0,0,0 ";
  const std::string recorded = palpate("record " + scan + press + "-o " + recording.string()).output;
  const std::string letter = file_with("letter.txt", "This is no scan.");
  const std::string path = "probe " + scan + " --scene ct-skin-and-bone -o " + fresh_path("out").string() + " --path ";
  const auto said = [](const std::string& arguments) { return palpate(arguments).output; };
  return {
      {"{}; choose one with --series N or --series UID:{}", said("profile " + two.string() + forehead)},
      {"--frame {}: series {} has {} frame{}, counted from 0", said("profile " + scan + forehead + "--frame 7")},
      {"no usable series in {}{}; `palpate info` tells more", said("profile " + letter + forehead)},
      {": of {} files none is an image, the first ({}) because: {}", said("profile " + letter + forehead)},
      {"no image series in what was given; the files and why are listed above", said("info " + letter)},
      {"{}: no such scene file can be read; the starting scenes are: {}", said("plan " + scan + " --scene absent")},
      {R"("{}" is not a point; write x,y,z in mm, such as -12.5,40,88)",
       said("profile " + scan + " --from a --to 0,0,0")},
      {"--speed has to be above 0 mm/s", said("profile " + scan + forehead + "--speed 0")},
      {"a stroke of {} mm at {} mm/s would have {} frames; from one to {} can be run",
       said("profile " + scan + forehead + "--speed 1e-9")},
      {"{}, line {}: not four finite numbers; expected {}", said(path + file_with("a.csv", "0,1,2\n"))},
      {"{}, line {}: time_s {} does not come after the previous line's; times ascend from 0",
       said(path + file_with("b.csv", "0,1,2,3\n0,2,3,4\n"))},
      {"{}: a path needs at least two points ({})", said(path + file_with("c.csv", "0,1,2,3\n"))},
      {"the path's point at {} s, {}, is {} mm from the workspace's center, beyond the device's reach: set "
       "workspace.center_mm or workspace.scale in the scene",
       said(path + file_with("d.csv", "0,0,0,0\n1,9000,0,0\n"))},
      {"the scene lets nothing be felt between {}, {}, {} and {}, {}, {} mm: choose another stroke with --from and "
       "--to, "
       "or another scene",
       said("probe " + scan + " --scene ct-skin-and-bone --from 0,-29,0 --to 0,-28,0 -o " + fresh_path("n").string())},
      {"{}: no boundary between tissues was found in this series; take a starting scene, such as ct-skin-and-bone",
       said("suggest " + air.string())},
      {R"(--device: there is no device "{}"; there are: {})",
       said("probe " + scan + " --device hand -o " + fresh_path("h").string())},
      {"{} exists; name another file", said("record " + scan + press + "-o " + recording.string())},
      {"cannot read the recording {}: {}", said("replay " + letter + " " + scan)},
      {"cannot write the recording {}: {}", said("record " + scan + press + "-o /absent/a.h5")},
      {"HDF5 cannot {}", said("record " + scan + press + "-o /absent/a.h5")},
      {"create the file", said("record " + scan + press + "-o /absent/a.h5")},
      {"cannot open the path file {}; check its name, and that it is yours to read",
       said_when([] { read_path_csv("/absent.csv"); })},
      {"palpate: the scene's stiffness of {} N/m is taken down to {}, what {} renders stably",
       said("record " + scan + " --seconds 0.2 --from 0,-29,0 --to 0,0,0 -o " + fresh_path("stiff.h5").string() +
            " --scene " + file_with("stiff.json", scene_with(R"("stiffness_n_per_m": 9000)")))},
      {"a gradient scale of {} mm reaches over more than {} voxels of this scan; take a smaller one",
       said("profile " + scan + forehead + "--scene " +
            file_with("wide.json", scene_with(R"("gradient_scale_mm": 500)")))},
      {"there is no series {} in {}", said("profile " + scan + forehead + "--series 9")},
      {"series {} holds {} volumes that do not fit together",
       said("profile " + two_of_one_uid() + forehead + "--series 1.2.3.4")},
      {"DCMTK's data dictionary is missing: reinstall the package libdcmtk17, or let the environment variable "
       "DCMDICTPATH name its dicom.dic",
       output_of("DCMDICTPATH=/absent " PALPATE_PROGRAM " info " + scan)},
      {"--jpeg-lossless needs dcmcjpeg: install the package dcmtk",
       output_of("PATH= " PALPATE_BENCH " load --jpeg-lossless " + scan)},
      {"standard output cannot be written", output_of("echo {} | " PALPATE_PROGRAM " solve > /dev/full")},
      {"standard input cannot be read", output_of(PALPATE_PROGRAM " solve < /")},
      {"the balance at {}, {}, {} mm could not be solved: does the scene switch off the solver it needs?",
       said("profile " + small_ball() + " --from 0,-14,0 --to 3,0,2 --scene " +
            file_with("unsolved.json", unsolvable))},
      {"palpate: real time: {}", without_real_time()},
      {"replay needs the SERIES that was felt, or --csv to export the recording alone",
       said("replay " + recording.string())},
      {"the recording was made on another scan: its hash is {}, this one's {}; name the scan that was felt",
       said("replay " + recording.string() + " " + (two / "one").string())},
      {"cannot write {}: {} (is the disk full?)", said("replay " + recording.string() + " --csv /absent/a.csv")},
      {"cannot write the picture {}: {} (is the folder there, and room on the disk?)",
       said("profile " + scan + forehead + "--picture /absent/a.png")},
      {"{}: cannot be written; is the folder there, is it yours to write, and is there room?",
       said("suggest " + scan + " -o " + no_file.string())},
      {"{} of {} line{} could not be solved: see \"error\" in the answers", said("solve < " + letter)},
      {"{}: exists and is not an empty folder; choose another or remove it",
       said("probe " + small_ball() + " -o " + two.parent_path().string())},
      {"{}: cannot make a folder in it ({})", said("probe " + small_ball() + " -o /proc/out")},
      {"palpate-bench tick needs a SERIES, --sphere or --place", output_of(PALPATE_BENCH " tick")},
      {"there is no scan to feel yet: open one first", said_when([] {
         LiveSession session;
         session.connect(std::make_shared<device::SimulatedStylus>());
       })},
      {"no stylus is held: connect one, then record", said_when([] { LiveSession().record("a.h5"); })},
  };
}

}  // namespace palpate::plugin::testing

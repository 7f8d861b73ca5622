#include "plugin/bench/bench_load.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <glm/geometric.hpp>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "io/fresh_folder.h"
#include "io/load.h"
#include "plugin/app/errors.h"
#include "plugin/app/open_scan.h"
#include "plugin/messages/messages.h"
#include "plugin/options/series_option.h"
#include "plugin/session/prepared_scene.h"

extern char** environ;  // NOLINT: POSIX's

namespace palpate::plugin {
namespace {

namespace fs = std::filesystem;

struct LoadOptions {
  std::vector<std::string> folders;
  int rounds = 5;
  bool jpeg_lossless = false;
  bool once = false;
  bool first_force = false;
};

/// The roles in the comparison: the reader alone and its peers, which do equally little; and the whole program, which a
/// person waits for, also up to a force.
enum class Role { reader, program, force, peer };

struct Loader {
  Role role;
  std::string name;
  std::vector<std::string> call;  // the folder is appended
};

struct Run {
  double seconds = 0;
  double cpu_seconds = 0;
  long peak_mib = 0;
};

std::string own_program() {
  return fs::read_symlink("/proc/self/exe").string();
}

std::optional<std::string> find_program(const std::string& name) {
  const fs::path beside = fs::path(own_program()).parent_path() / name;
  if (fs::exists(beside)) return beside.string();
  const char* path = std::getenv("PATH");
  std::string rest = path != nullptr ? path : "";
  while (!rest.empty()) {
    const auto colon = rest.find(':');
    const fs::path candidate = fs::path(rest.substr(0, colon)) / name;
    if (::access(candidate.c_str(), X_OK) == 0) return candidate.string();
    rest = colon == std::string::npos ? "" : rest.substr(colon + 1);
  }
  return std::nullopt;
}

/// Nothing if the program fails.
std::optional<Run> time_program(const std::vector<std::string>& call) {
  std::vector<char*> arguments;
  for (const std::string& word : call)
    arguments.push_back(const_cast<char*>(word.c_str()));  // NOLINT: posix_spawn's type
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t quiet;
  posix_spawn_file_actions_init(&quiet);
  posix_spawn_file_actions_addopen(&quiet, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&quiet, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  const auto start = std::chrono::steady_clock::now();
  pid_t child = 0;
  const int failed = ::posix_spawn(&child, arguments.front(), &quiet, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&quiet);
  int status = 0;
  rusage usage{};
  if (failed != 0 || ::wait4(child, &status, 0, &usage) != child || !WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    return std::nullopt;
  }
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  return Run{wall.count(), seconds(usage.ru_utime) + seconds(usage.ru_stime), usage.ru_maxrss / 1024};
}

std::vector<Loader> loaders(const fs::path& scratch) {
  const auto reader = find_program("load_by_palpate");
  const std::vector<std::string> program{own_program(), "bench", "load", "--once"};
  std::vector<Loader> all{{Role::reader, "palpate's io", reader ? std::vector{*reader} : program},
                          {Role::program, "palpate", program},
                          {Role::force, "to a force", {own_program(), "bench", "load", "--once", "--first-force"}}};
  for (const auto& [name, file] :
       {std::pair{"DCMTK", "load_by_dcmtk"}, {"GDCM", "load_by_gdcm"}, {"ITK", "load_by_itk"}}) {
    if (const auto peer = find_program(file)) all.push_back({Role::peer, name, {*peer}});
  }
  if (const auto peer = find_program("dcm2niix")) {
    all.push_back(
        {Role::peer, "dcm2niix", {*peer, "-z", "n", "-b", "n", "-w", "1", "-f", "x", "-o", scratch.string()}});
  }
  if (const auto peer = find_program("dicomtonifti")) {
    all.push_back({Role::peer, "vtk-dicom", {*peer, "-s", "-r", "-o", (scratch / "v.nii").string()}});
  }
  return all;
}

template <typename Value>
Value median(std::vector<Value> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

struct Fastest {
  double typical = 1e300;
  double best = 1e300;
};

void compare(const std::string& title, const std::string& folder, int rounds) {
  const io::FreshFolder output = io::temporary_folder();
  const std::vector<Loader> all = loaders(output.path());
  std::vector<std::vector<Run>> runs(all.size());
  for (int round = -1; round < rounds; ++round) {  // the first warms the page cache
    for (std::size_t l = 0; l < all.size(); ++l) {
      auto call = all[l].call;
      call.push_back(folder);
      const auto run = time_program(call);
      if (run && round >= 0) runs[l].push_back(*run);
    }
  }
  fmt::print("\n{}: median of {} alternating runs, {} cores\n", title, rounds, std::thread::hardware_concurrency());
  fmt::print("{:<12} {:>9} {:>9} {:>9} {:>9}   call\n", "", "wall s", "best s", "CPU s", "peak MiB");
  std::array<Fastest, 4> fastest;  // by role
  for (std::size_t l = 0; l < all.size(); ++l) {
    if (runs[l].empty()) {
      fmt::print("{:<12} failed   {} {}\n", all[l].name, fmt::join(all[l].call, " "), folder);
      continue;
    }
    std::vector<double> wall;
    std::vector<double> cpu;
    std::vector<long> peak;
    for (const Run& run : runs[l]) {
      wall.push_back(run.seconds);
      cpu.push_back(run.cpu_seconds);
      peak.push_back(run.peak_mib);
    }
    const Fastest times{median(wall), *std::min_element(wall.begin(), wall.end())};
    fmt::print("{:<12} {:>9.3f} {:>9.3f} {:>9.3f} {:>9}   {} {}\n", all[l].name, times.typical, times.best, median(cpu),
               median(peak), fmt::join(all[l].call, " "), folder);
    Fastest& of = fastest[static_cast<std::size_t>(all[l].role)];
    of.typical = std::min(of.typical, times.typical);
    of.best = std::min(of.best, times.best);
  }
  // Other work on the machine hurts what uses all cores more than what uses one: the best runs saw least of it.
  const auto ratio = [&](const char* what, Role role, Role to) {
    const Fastest& a = fastest[static_cast<std::size_t>(role)];
    const Fastest& b = fastest[static_cast<std::size_t>(to)];
    if (a.best < 1e300 && b.best < 1e300) {
      fmt::print("{}: {:.2f} (best runs {:.2f})\n", what, a.typical / b.typical, a.best / b.best);
    }
  };
  ratio("palpate's io / fastest peer", Role::reader, Role::peer);
  ratio("palpate / fastest peer", Role::program, Role::peer);
  ratio("first force / load", Role::force, Role::program);
}

// The same series in JPEG lossless, by DCMTK's dcmcjpeg.
void compress(const std::string& program, const fs::path& folder, const fs::path& into) {
  for (const auto& entry : fs::directory_iterator(folder)) {
    time_program({program, "+e1", entry.path().string(), (into / entry.path().filename()).string()});
  }
}

void load_once(const std::string& folder, bool first_force) {
  const SeriesOption option{.path = folder, .series = "", .frame = 0};
  const auto shared = std::make_shared<const io::Volume>(io::load(choose_series(option)));
  const io::Volume& volume = *shared;
  if (first_force) {
    // The steps from a loaded volume to a force: the fields, and a sample of them at the proxy.
    const PreparedScene felt = prepare(scene_for("", volume), shared, glm::dvec3(0.1));
    const glm::dvec3 middle = volume.geometry.to_patient(0.5 * glm::dvec3(volume.geometry.dimensions - 1));
    const io::Sample sample = felt.source->sample(middle, felt.plan->fields);
    fmt::print("gradient in the middle {:.3g} per mm\n", glm::length(sample.gradient));
    return;
  }
  const io::Statistics values = io::statistics(volume);
  fmt::print("{} slices, {} to {}, mean {:.9g}\n", volume.geometry.dimensions.z, values.minimum, values.maximum,
             values.mean);
}

void run(const LoadOptions& options) {
  if (options.once) {
    load_once(options.folders.front(), options.first_force);
    return;
  }
  const auto compressor = find_program("dcmcjpeg");
  if (options.jpeg_lossless && !compressor) {
    throw InputRefused(say("jpeg-lossless-needs-dcmcjpeg"));
  }
  for (const std::string& folder : options.folders) {
    compare(folder, folder, options.rounds);
    if (options.jpeg_lossless) {
      const io::FreshFolder compressed = io::temporary_folder();
      compress(*compressor, folder, compressed.path());
      compare(folder + " in JPEG lossless", compressed.path().string(), options.rounds);
    }
  }
  fmt::print(
      "\nWhat is found beside this program or on the PATH is run; load_by_palpate, load_by_dcmtk, load_by_gdcm and "
      "load_by_itk are built with -DPALPATE_PEERS=ON, dcm2niix and dicomtonifti are Debian's dcm2niix and "
      "vtk-dicom-tools.\n");
}

}  // namespace

void add_bench_load(CLI::App& bench) {
  CLI::App* command = bench.add_subcommand(
      "load", "Time from a folder to a volume, compared with DCMTK, GDCM, ITK, vtk-dicom and dcm2niix");
  const auto options = std::make_shared<LoadOptions>();
  command->add_option("FOLDER", options->folders, "Folders that hold one series each")->required();
  command->add_option("--rounds", options->rounds, "Runs of each program, in turn")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  command->add_flag("--jpeg-lossless", options->jpeg_lossless,
                    "Load each series also in JPEG lossless (needs dcmcjpeg)");
  command->add_flag("--once", options->once,
                    "Load the first folder once and print its values (this is the timed part)");
  command->add_flag("--first-force", options->first_force,
                    "With --once: stop at the first force instead of the values");
  command->callback([options] { run(*options); });
}

}  // namespace palpate::plugin

#include "plugin/bench/bench_soak.h"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "io/fresh_folder.h"
#include "plugin/app/errors.h"
#include "plugin/app/run_session.h"
#include "plugin/bench/soak.h"
#include "plugin/messages/messages.h"
#include "plugin/messages/tell.h"

namespace palpate::plugin {
namespace {

void print(const SoakResult& result) {
  fmt::print("{} ticks, {} deadlines missed, {} of them unaccounted for\n", result.ticks, result.missed,
             result.unaccounted);
  fmt::print("{} changes of scene, {} of scan, {} unplugs; {} ticks with a latched fault\n", result.scenes,
             result.scans, result.unplugs, result.faulty_ticks);
  fmt::print("largest force {:.2f} N; ticks beyond a limit of force or slew {}, not finite {}\n", result.largest_n,
             result.over_limit, result.not_finite);
  fmt::print("replayed {} ticks, {} differ; ticks lost to the recording {}\n", result.replay.ticks,
             result.replay.different, result.lost);
  fmt::print(
      "live heap at the end of {} cycles: differs by {} bytes once warm; resident memory grows by {:.3f} MiB/h\n",
      result.points.size(), result.heap_spread(), result.resident_slope() / (1024.0 * 1024.0));
  for (const SoakPoint& point : result.points) {
    fmt::print("  {:8.1f} s  live {:>12} bytes  resident {:>12} bytes\n", point.time_s, point.live_bytes,
               point.resident_bytes);
  }
}

/// Freed memory in the thread caches of the C library counts as allocated, and varies. The caches can only be disabled
/// before the program starts: so it restarts itself.
void start_again_without_thread_caches() {
  constexpr const char* name = "GLIBC_TUNABLES";
  if (std::getenv(name) != nullptr) return;
  setenv(name, "glibc.malloc.tcache_count=0", 1);
  std::ifstream command_line("/proc/self/cmdline", std::ios::binary);
  std::vector<std::string> words;
  for (std::string word; std::getline(command_line, word, '\0');) words.push_back(word);
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  execv("/proc/self/exe", arguments.data());
  tell(say("no-start-without-thread-caches"));
}

void run(SoakOptions options) {
  start_again_without_thread_caches();
  const bool show = stderr_is_terminal();
  const io::FreshFolder folder = io::temporary_folder();
  options.folder = folder.path();
  options.progress = [show](double done) {
    if (show) fmt::print(stderr, "\rsoaking {:3.0f} %{}", 100 * done, done < 1 ? "" : "\r\033[K");
  };
  const SoakResult result = soak(options);
  print(result);
  if (result.over_limit + result.not_finite + result.unaccounted + result.lost + result.replay.different +
          result.replay.after_gap >
      0) {
    throw InputRefused(say("soak-found-a-fault"));
  }
}

}  // namespace

void add_bench_soak(CLI::App& bench) {
  auto options = std::make_shared<SoakOptions>();
  CLI::App* command = bench.add_subcommand(
      "soak",
      "An hour of probing: scenes swapped every second, scans every minute, the device unplugged at random;\n"
      "recorded, replayed, limits and memory watched.");
  command->add_option("--minutes", options->minutes, "minutes of probing")->capture_default_str();
  command->add_option("--scan", options->seconds_of_scan, "seconds of each scan")->capture_default_str();
  command->add_option("--rate", options->rate_hz, "ticks a second")->capture_default_str();
  command->add_option("--seed", options->seed, "seed of the hand's tremor and of the unplugging")
      ->capture_default_str();
  command->add_flag("--clock", options->at_clock_pace,
                    "in real time on the servo thread, instead of as fast as possible");
  command->callback([options] { run(*options); });
}

}  // namespace palpate::plugin

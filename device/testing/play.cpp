#include "device/testing/play.h"

#include <grp.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <iterator>
#include <stdexcept>
#include <thread>

#include "device/link/driver_clock.h"
#include "device/link/realtime.h"
#include "device/testing/fake_space_mouse.h"
#include "device/testing/fake_wooden_haptics.h"

namespace palpate::device {

namespace {

constexpr double longest_while_stopped = 0.3;  // s
constexpr double longest_after_replug = 0.3;   // s from the node to the zero
constexpr double longest_scenario = 60;        // s; one that works takes 5
const Vec3 asked_force(0, 1, 0);               // N: what the client asks for

std::string firmware() {
  std::string image(1500, 0);
  for (std::size_t i = 0; i < image.size(); ++i) image[i] = static_cast<char>(i * 7 + i / 251);
  return image;
}

std::string read_text(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// The exit status of a child as in a shell: 128 + n if signal n killed it. -1: there is no such child.
int wait_for(pid_t pid) {
  int status = 0;
  if (waitpid(pid, &status, 0) < 0) return -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

/// Waits for the processes that a killed session has left behind, and returns the guardian's exit status; -1: there was
/// none. The process that keeps the machine awake is another one, and ends by itself.
int wait_for_guardian() {
  int guardian = -1;
  siginfo_t ended{};
  while (waitid(P_ALL, 0, &ended, WEXITED | WNOWAIT) == 0) {
    std::string name;
    std::ifstream("/proc/" + std::to_string(ended.si_pid) + "/comm") >> name;
    const int code = wait_for(ended.si_pid);
    if (name.starts_with("palpate-guard")) guardian = code;
  }
  return guardian;
}

pid_t start_client(const Scenario& scenario, const std::string& client, const std::string& file) {
  const pid_t pid = fork();
  if (pid == 0) {
    if (scenario.user >= 0) {
      const auto user = static_cast<unsigned>(scenario.user);
      const gid_t group = plugdev_group;
      if (setgroups(scenario.in_plugdev ? 1 : 0, &group) != 0 || setgid(user) != 0 || setuid(user) != 0) _exit(126);
    }
    execl(client.c_str(), client.c_str(), scenario.kind.c_str(), scenario.name.c_str(), file.c_str(), nullptr);
    _exit(127);
  }
  return pid;
}

/// Waits until the client is stopped. False if it has ended.
bool wait_for_stop(pid_t pid) {
  siginfo_t info{};
  return waitid(P_PID, static_cast<id_t>(pid), &info, WSTOPPED | WEXITED | WNOWAIT) == 0 && info.si_code == CLD_STOPPED;
}

/// What each thread of the client and of its guardian waits for, as far as this user may know it.
void tell_what_hangs() {
  for (const auto& process : std::filesystem::directory_iterator("/proc")) {
    const std::string name = read_text(process.path() / "comm");
    if (!name.starts_with("device_cl") && !name.starts_with("palpate-guard")) continue;
    for (const auto& thread : std::filesystem::directory_iterator(process.path() / "task")) {
      std::printf("%s, thread %s: %s%s\n", name.c_str(), thread.path().filename().c_str(),
                  read_text(thread.path() / "stat").c_str(), read_text(thread.path() / "stack").c_str());
    }
  }
}

/// Ends this process, and tells why, where a scenario does not end by itself.
std::jthread limit_time() {
  return std::jthread([](const std::stop_token& over) {
    for (const double start = monotonic_time(); !over.stop_requested(); sleep_seconds(0.05)) {
      if (monotonic_time() - start < longest_scenario) continue;
      std::printf("the scenario did not end within %.0f s\n", longest_scenario);
      tell_what_hangs();
      std::fflush(stdout);
      std::_Exit(1);
    }
  });
}

/// Those that this process has; its clients' guardians become its own.
void end_children() {
  std::ifstream file("/proc/self/task/" + std::to_string(getpid()) + "/children");
  for (pid_t child = 0; file >> child;) {
    kill(child, SIGKILL);
    wait_for(child);
  }
}

}  // namespace

/// Of the fake, at one time.
struct Play::Outcome {
  bool pushing = false;
  unsigned long long packets = 0;
  Vec3 strongest{0};      // N
  std::string complaint;  // empty, or what the client did that this device does not take
};

Play::Play(const Scenario& scenario) : scenario_(scenario) {
  if (scenario.kind == "falcon") {
    FakeFalconOptions options;
    options.firmware_loaded = scenario.name != "run";
    const std::string image = firmware();
    options.image.assign(image.begin(), image.end());
    falcon = std::make_unique<FakeFalcon>(options);
    file_ = files_.write("firmware", image);
  } else if (scenario.kind == "wooden_haptics") {
    FakeWoodenHapticsOptions options;
    const std::array<int, 3>& home = options.arm.home_counts;
    file_ = files_.write("settings.json", "{\"preset\": \"2015\", \"address\": \"" + scenario.address +
                                              "\", \"home_counts\": [" + std::to_string(home[0]) + ", " +
                                              std::to_string(home[1]) + ", " + std::to_string(home[2]) + "]}");
    options.button_time = monotonic_time() + 0.3;
    hid = std::make_unique<FakeWoodenHaptics>(options);
  } else if (scenario.kind == "space_mouse") {
    auto puck = std::make_unique<FakeSpaceMouse>(scenario.newer_puck);
    puck->deflect(Vec3(350, 0, 0));
    hid = std::move(puck);
  } else {
    throw std::invalid_argument("there is no fake of '" + scenario.kind + "'");
  }
}

void Play::touch(double now) noexcept {
  if (first_touch_ < 0) first_touch_ = now;
}

void Play::lose_usb() noexcept {
  if (falcon) falcon->lose_usb();
}

bool Play::unplugged(double now) const noexcept {
  const double since = now - first_touch_ - scenario_.unplug_after;
  if (first_touch_ < 0 || since <= 0) return false;
  return scenario_.name == "unplug" || (is_replugged() && since < scenario_.replug_after);
}

Play::Outcome Play::look() {
  const std::lock_guard lock(mutex);
  if (falcon) {
    const bool loaded_anew = falcon->uploads() == (scenario_.name == "run" ? 1 : 0);
    return {falcon->is_pushing(), falcon->commands(), falcon->strongest_force(),
            loaded_anew ? "" : "firmware uploaded " + std::to_string(falcon->uploads()) + " times"};
  }
  if (const auto* arm = dynamic_cast<const FakeWoodenHaptics*>(hid.get())) {
    // Its own watchdog ends a force that is not renewed; so after a replug the commands count.
    const bool pushes =
        is_replugged() ? arm->milliamperes() != std::array<int, 3>{} : arm->is_pushing(monotonic_time());
    Outcome outcome{pushes, arm->reports(), arm->strongest_force(), ""};
    // A guardian cannot know the length and sends them all.
    if (scenario_.name == "run" && arm->odd_outputs() != 0) {
      outcome.complaint = std::to_string(arm->odd_outputs()) + " outputs of another length";
    }
    return outcome;
  }
  const auto* puck = dynamic_cast<const FakeSpaceMouse*>(hid.get());
  return {false, puck == nullptr ? 0 : puck->reports(), Vec3(0), ""};
}

double Play::wait_for_zero(double since, double patience) {
  while (look().pushing && monotonic_time() - since < patience) {
    std::this_thread::sleep_for(std::chrono::microseconds(500));
  }
  return monotonic_time() - since;
}

/// s from when the system has a node of it again.
double Play::zero_after_replug() {
  const auto is_out = [&] {
    const std::lock_guard lock(mutex);
    return unplugged(monotonic_time());
  };
  const auto wait_while = [](const std::function<bool()>& holds) {
    for (int ms = 0; holds() && ms < 20000; ++ms) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  };
  wait_while([&] { return !is_out(); });
  const bool kept_force = look().pushing;
  wait_while(is_out);
  const double plugged_in = monotonic_time();
  wait_while([&] { return !scenario_.is_plugged_in(); });
  const double has_node = monotonic_time();
  const double after = wait_for_zero(has_node, 3);
  std::printf("fake %s: force %s when it was unplugged; node %.0f ms after the plug, zero %.0f ms after the node\n",
              scenario_.kind.c_str(), kept_force ? "kept" : "GONE", 1e3 * (has_node - plugged_in), 1e3 * after);
  return after;
}

int Play::run(const std::string& client) {
  // A guardian that outlives its session becomes a child of this process.
  prctl(PR_SET_CHILD_SUBREAPER, 1);
  const std::jthread limit = limit_time();
  const pid_t pid = start_client(scenario_, client, file_);
  const double zeroed_after = is_replugged() ? zero_after_replug() : 0;
  bool stopped_too_long = false;
  if (scenario_.name == "sigstop" && wait_for_stop(pid)) {
    const double after = wait_for_zero(monotonic_time(), 1);
    stopped_too_long = after > longest_while_stopped;
    std::printf("fake %s: zero %.1f ms after the client was stopped\n", scenario_.kind.c_str(), after * 1e3);
    kill(pid, SIGKILL);
  }
  const int code = pid < 0 ? 127 : wait_for(pid);
  const double ended = monotonic_time();
  const bool should_die = scenario_.name.starts_with("sig");
  const double zero_after = wait_for_zero(ended, should_die ? scenario_.zero_within : 0);
  Outcome outcome = look();
  // One whose device was unplugged waits for it to come back: as it should, but not here.
  if (scenario_.name == "unplug" && scenario_.kind != "space_mouse") end_children();
  const int guardian = wait_for_guardian();

  // An unplugged device is left to its own watchdog, because no command reaches it. If opening was denied, nothing was
  // sent.
  const bool was_opened = scenario_.name != "denied";
  const bool ended_well = should_die ? code > 128 : code == 0;
  // A session that closes a stylus which is back has waited for its guardian; one that closes before has not.
  if (guardian != (should_die || scenario_.name == "replug_close" ? 0 : -1)) {
    outcome.complaint += " its guardian was left behind, or ended with " + std::to_string(guardian);
  }
  if (was_opened && scenario_.kind != "space_mouse" && glm::distance(outcome.strongest, asked_force) > 0.1) {
    outcome.complaint += " the strongest force was not the one asked for";
  }
  if (stopped_too_long || zeroed_after > longest_after_replug) outcome.complaint += " its zero came too late";
  if (was_opened && outcome.packets == 0) outcome.complaint += " it was never asked for anything";
  std::printf("fake %s, %s: %llu packets, strongest force %.3f N, client ended with %d, %s", scenario_.kind.c_str(),
              scenario_.name.c_str(), outcome.packets, glm::length(outcome.strongest), code,
              outcome.pushing ? "STILL PUSHING" : "no force");
  if (should_die) std::printf(" %.1f ms after the client was gone", zero_after * 1e3);
  if (scenario_.name == "unplug" && scenario_.kind != "space_mouse") {
    std::printf(" (its own watchdog: %s)", scenario_.kind == "falcon" ? "unknown" : "0.5 s");
  }
  std::printf("%s%s\n", outcome.complaint.empty() ? "" : "; WRONG: ", outcome.complaint.c_str());
  const bool quiet = !outcome.pushing || scenario_.name == "unplug";
  return ended_well && quiet && outcome.complaint.empty() ? 0 : 1;
}

}  // namespace palpate::device

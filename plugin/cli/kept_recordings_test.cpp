// What was recorded is kept, whatever ends the session or fails after it: a full disk, a signal, a closed pipe, a
// picture that cannot be written.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <string>

#include "plugin/app/interruptible.h"
#include "plugin/recording/recording.h"
#include "plugin/testing/command_rig.h"

namespace palpate::plugin {
namespace {

namespace fs = std::filesystem;
using namespace testing;
using ::testing::HasSubstr;

std::string probe_to(const fs::path& out, const std::string& more = "") {
  return PALPATE_PROGRAM " probe " + phantom().string() + forehead + more + " -o " + out.string();
}

/// Whether another folder than `out` lies beside it, whose name begins like it.
bool has_left_overs(const fs::path& out) {
  for (const auto& entry : fs::directory_iterator(out.parent_path())) {
    const std::string name = entry.path().filename().string();
    if (name != out.filename() && name.starts_with(out.filename().string() + ".")) return true;
  }
  return false;
}

/// A file may have three quarters of the bytes that the recording has.
TEST(KeptRecordings, OfAFullDiskTheMessageNamesWhatCanBeRead) {
  const fs::path out = fresh_path("full_disk"), whole = fresh_path("whole");
  ASSERT_EQ(run_command(probe_to(whole)).exit, 0);
  const std::uintmax_t blocks = fs::file_size(whole / "recording.h5") / 512 * 3 / 4;
  const Outcome outcome =
      run_command("{ trap '' XFSZ; ulimit -f " + std::to_string(blocks) + "; " + probe_to(out) + "; } 2>&1");
  EXPECT_EQ(outcome.exit, 1) << outcome.output;
  const fs::path partial = out / "recording.h5.partial";
  EXPECT_THAT(outcome.output, HasSubstr("what was written before is in " + partial.string()));
  ASSERT_TRUE(fs::exists(partial));
  const Recording recording = read_recording(partial);
  EXPECT_FALSE(recording.complete);
  EXPECT_FALSE(recording.ticks.empty());
  EXPECT_FALSE(has_left_overs(out));
}

TEST(KeptRecordings, WhereNoPictureCanBeWrittenTheRecordingIsWhole) {
  for (const char* const name : {"summary.txt", "slice.png", "force-time.png"}) {
    const fs::path out = fresh_path("no_picture"), taken = out / name;
    const Outcome outcome =
        run_command("{ " + probe_to(out, "--clock --seconds 3") + " & until [ -d " + out.string() +
                    " ] || ! kill -0 $!; do sleep 0.01; done; mkdir " + taken.string() + "; wait $!; } 2>&1");
    EXPECT_EQ(outcome.exit, 1) << name << ": " << outcome.output;
    const fs::path file = out / "recording.h5";
    EXPECT_THAT(outcome.output, HasSubstr("palpate: the recording is kept: " + file.string() + "\n"));
    ASSERT_TRUE(fs::exists(file)) << name;
    EXPECT_TRUE(read_recording(file).complete);
  }
}

/// Whatever it is doing when the signal comes: loading, feeling or drawing.
TEST(KeptRecordings, ASignalLeavesAFolderWithAWholeRecordingOrNothing) {
  for (const char* const seconds : {"0.01", "0.02", "0.05", "0.1", "0.2", "0.4", "0.8", "1.2"}) {
    const fs::path out = fresh_path("signal_at");
    const Outcome outcome = run_command("{ " + probe_to(out, "--clock --seconds 0.7") + " & sleep " + seconds +
                                        "; kill -TERM $!; wait $!; } 2>&1");
    EXPECT_FALSE(has_left_overs(out)) << "after " << seconds << " s: " << outcome.output;
    if (!fs::exists(out)) continue;
    ASSERT_TRUE(fs::exists(out / "recording.h5")) << "after " << seconds << " s: " << outcome.output;
    EXPECT_TRUE(read_recording(out / "recording.h5").complete);
  }
}

TEST(KeptRecordings, ASignalWhilePicturesAreDrawnLeavesThemAll) {
  const fs::path out = fresh_path("signal_late"), file = out / "recording.h5";
  const Outcome outcome = run_command("{ " + probe_to(out) + " & until [ -f " + file.string() +
                                      " ] || ! kill -0 $!; do sleep 0.002; done; kill -HUP $!; wait $!; } 2>&1");
  EXPECT_EQ(outcome.exit, 0) << outcome.output;
  EXPECT_TRUE(read_recording(file).complete);
  EXPECT_TRUE(fs::exists(out / "tick-time.png")) << "the last one";
}

/// The first line that is read closes the pipe; the session goes on to its end.
TEST(KeptRecordings, AClosedPipeEndsNoSession) {
  for (const char* const command : {"record --live ", "serve --live --port 0 "}) {
    const fs::path file = fresh_path("piped.h5");
    const Outcome outcome = run_command(std::string("{ " PALPATE_PROGRAM " ") + command + phantom().string() +
                                        forehead + "--seconds 1 -o " + file.string() + "; } 2>&1 | head -c 1");
    EXPECT_EQ(outcome.output.size(), 1U) << command;
    ASSERT_TRUE(fs::exists(file)) << command;
    const Recording recording = read_recording(file);
    EXPECT_TRUE(recording.complete) << command;
    EXPECT_GE(recording.ticks.back().time_s, 0.9) << command;
  }
}

TEST(Interruptible, OneWithinAnotherSharesItsFlag) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const Interruptible whole;
    EXPECT_FALSE(Interruptible::interrupted());
    {
      const Interruptible part;
      std::raise(SIGPIPE);
      EXPECT_FALSE(Interruptible::interrupted());
      std::raise(signal);
    }
    std::raise(signal);
    const Interruptible next;
    EXPECT_TRUE(Interruptible::interrupted());
  }
}

/// As nohup leaves it.
TEST(Interruptible, AHangUpThatIsIgnoredStaysIgnored) {
  auto* const before = std::signal(SIGHUP, SIG_IGN);
  {
    const Interruptible interruptible;
    std::raise(SIGHUP);
    EXPECT_FALSE(Interruptible::interrupted());
  }
  EXPECT_EQ(std::signal(SIGHUP, before), SIG_IGN);
}

}  // namespace
}  // namespace palpate::plugin

/// A recording in several files is replayed like one, wherever it was divided; and finished parts are released.

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "plugin/recording/replay.h"
#include "plugin/testing/session_rig.h"

namespace palpate::plugin {
namespace {

Snapshot snapshot_again(const SceneRecord& record) {
  return testing::snapshot(record.scene, testing::slab(std::stod(record.scan_hash)), record.change_s);
}

/// With three scenes, three styluses, a fault that is cleared, and commands.
const Recording& recorded_parts() {
  static const Recording recording = [] {
    Recording made;
    made.header.rate_hz = 1000;
    const char* const scenes[] = {"ct-skin-and-bone", "ct-bone", "ct-skin-and-bone"};
    for (std::uint32_t n = 0; n < 3; ++n) {
      made.scenes.push_back(
          {.epoch = n, .scene = scenes[n], .scan_hash = std::to_string(0.4 * n), .change_s = 0.1 + 0.05 * n});
    }
    const auto held = testing::stylus(testing::hold());
    const device::Specification specification = held->specification();
    for (std::uint32_t n = 0; n < 3; ++n) {
      made.styluses.push_back({.epoch = n,
                               .name = specification.name,
                               .force_axes = specification.force_axes,
                               .maximum_force_n = specification.maximum_force});
    }
    Session session(snapshot_again(made.scenes[0]), held);
    for (int n = 0; n < 2000; ++n) {
      if (n == 400) session.publish(snapshot_again(made.scenes[1]));
      if (n == 700) session.change_stylus(testing::stylus(testing::hold(-0.004), 5));
      if (n == 1000) session.publish(snapshot_again(made.scenes[2]));
      if (n == 1300) session.disarm();
      if (n == 1350) session.arm();
      if (n == 1500) session.change_stylus(testing::stylus(testing::hold(-0.002), 6));
      const double time = 1e-3 * n;
      made.ticks.push_back(session.tick({.time_s = time, .heartbeat_s = n < 1990 ? time : time - 5}));
      const auto shares = session.shares();
      made.shares.insert(made.shares.end(), shares.begin(), shares.end());
    }
    return made;
  }();
  return recording;
}

/// The ticks from `begin` to before `end`, and what was noted of scenes and styluses that came in them.
Recording part_of(const Recording& whole, std::size_t begin, std::size_t end) {
  Recording part;
  part.header = whole.header;
  part.ticks.assign(whole.ticks.begin() + static_cast<std::ptrdiff_t>(begin),
                    whole.ticks.begin() + static_cast<std::ptrdiff_t>(end));
  const auto first_with = [&](const auto& is_it) {
    return static_cast<std::size_t>(std::ranges::find_if(whole.ticks, is_it) - whole.ticks.begin());
  };
  for (const SceneRecord& scene : whole.scenes) {
    const std::size_t at = first_with([&](const TickRecord& tick) { return tick.scene_epoch == scene.epoch; });
    if (at >= begin && at < end) part.scenes.push_back(scene);
  }
  for (const StylusRecord& stylus : whole.styluses) {
    const std::size_t at = first_with([&](const TickRecord& tick) { return tick.stylus_epoch == stylus.epoch; });
    if (at >= begin && at < end) part.styluses.push_back(stylus);
  }
  return part;
}

void expect_equal(const Replay& a, const Replay& b) {
  EXPECT_EQ(a.ticks, b.ticks);
  EXPECT_EQ(a.different, b.different);
  EXPECT_EQ(a.first_different, b.first_different);
  EXPECT_EQ(a.largest_proxy_m, b.largest_proxy_m);
  EXPECT_EQ(a.largest_force_n, b.largest_force_n);
  EXPECT_EQ(a.largest_bound_m, b.largest_bound_m);
  EXPECT_EQ(a.after_gap, b.after_gap);
}

TEST(ReplayParts, AreRepeatedAsOneWhereverTheyAreCut) {
  const Recording& whole = recorded_parts();
  const Replay at_once = replay(whole, snapshot_again);
  EXPECT_EQ(at_once.ticks, 2000U);
  EXPECT_EQ(at_once.different, 0U) << at_once.first_different.value_or(0);
  std::mt19937 random(3);
  // Twice between the command for another stylus and the tick that has it, and before and after a change of scene.
  std::vector<std::vector<std::size_t>> all_cuts{{0, 500, 710, 1505, 2000}, {0, 450, 650, 1050, 1280, 1400, 2000}};
  for (int n = 0; n < 3; ++n) {
    all_cuts.push_back({0, random() % 2000, random() % 2000, random() % 2000, 2000});
    std::ranges::sort(all_cuts.back());
  }
  for (const std::vector<std::size_t>& cuts : all_cuts) {
    std::vector<std::weak_ptr<const io::FieldSource>> sources;
    Replayer replayer([&](const SceneRecord& record) {
      Snapshot made = snapshot_again(record);
      sources.push_back(made.source);
      return made;
    });
    for (std::size_t cut = 1; cut < cuts.size(); ++cut) {
      replayer.feed(part_of(whole, cuts[cut - 1], cuts[cut]));
      if (cuts[cut] == 0) continue;
      const bool is_changing = whole.ticks[cuts[cut] - 1].change_part < 1;
      EXPECT_EQ(std::ranges::count_if(sources, [](const auto& one) { return !one.expired(); }), is_changing ? 2 : 1)
          << "of a change both scans, else the last alone: at " << cuts[cut];
    }
    expect_equal(replayer.result(), at_once);
  }
}

/// A difference is found in whichever part it is, and ticks after a gap are counted in all parts.
TEST(ReplayParts, TellOfTheWholeWhatIsInAPart) {
  Recording changed = recorded_parts();
  changed.ticks[900].proxy_m[2] += 2e-6;
  changed.ticks[1400].sent_n[0] += 0.25;
  changed.ticks[1500].proxy_m[0] += 1e-6;
  Replayer replayer(snapshot_again);
  replayer.feed(part_of(changed, 0, 1000));
  EXPECT_EQ(replayer.result().different, 1U);
  replayer.feed(part_of(changed, 1000, 1600));
  EXPECT_EQ(replayer.result().different, 3U);
  EXPECT_EQ(replayer.result().first_different, 900U);
  EXPECT_NEAR(replayer.result().largest_proxy_m, 2e-6, 1e-12);
  EXPECT_NEAR(replayer.result().largest_force_n, 0.25, 1e-12);
  replayer.feed(part_of(changed, 1700, 1800));
  EXPECT_EQ(replayer.result().ticks, 1600U);
  EXPECT_EQ(replayer.result().after_gap, 100U);
  replayer.feed(part_of(changed, 1900, 2000));
  EXPECT_EQ(replayer.result().after_gap, 200U);
}

std::string unreplayable(const Recording& recording) {
  try {
    replay(recording, snapshot_again);
    return "replayed";
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

/// What is missing is named.
TEST(ReplayParts, NameWhatTheyLack) {
  Recording recording = part_of(recorded_parts(), 0, 900);
  EXPECT_EQ(unreplayable(recording), "replayed");
  Recording lacks = recording;
  lacks.scenes.pop_back();
  EXPECT_EQ(unreplayable(lacks), "the recording lacks its scene 1: the file is damaged, record anew");
  lacks = recording;
  lacks.styluses.clear();
  EXPECT_EQ(unreplayable(lacks), "the recording lacks its stylus 0: the file is damaged, record anew");
  EXPECT_EQ(replay({}, snapshot_again).ticks, 0U) << "of nothing, nothing";
}

/// The session would count through all numbers to the one that is named, up to 2^32 of them.
TEST(ReplayParts, ASceneThatDoesNotFollowIsRefused) {
  const Recording whole = part_of(recorded_parts(), 0, 900);
  const auto with_scene = [&](std::uint32_t epoch) {
    Recording changed = whole;
    changed.scenes.at(1).epoch = epoch;
    for (TickRecord& tick : changed.ticks) tick.scene_epoch *= epoch;
    return changed;
  };
  EXPECT_EQ(unreplayable(with_scene(4'000'000'000)),
            "the recording goes on from its scene 0 to 4000000000: the file is damaged, record anew");
  Recording skips = with_scene(2);
  EXPECT_EQ(unreplayable(skips), "the recording goes on from its scene 0 to 2: the file is damaged, record anew");
  skips.scenes.push_back(whole.scenes.at(1));
  EXPECT_EQ(unreplayable(skips), "replayed") << "the first was never taken";
  Recording descends = whole;
  ASSERT_EQ(descends.ticks.at(600).scene_epoch, 1U);
  descends.ticks[600].scene_epoch = 0;
  EXPECT_EQ(unreplayable(descends), "the recording goes on from its scene 1 to 0: the file is damaged, record anew");
}

TEST(ReplayParts, AStylusThatDoesNotFollowIsRefused) {
  const Recording whole = part_of(recorded_parts(), 0, 900);
  Recording far = whole;
  far.styluses.at(1).epoch = 4'000'000'000;
  for (TickRecord& tick : far.ticks) tick.stylus_epoch *= 4'000'000'000;
  EXPECT_EQ(unreplayable(far),
            "the recording goes on from its stylus 0 to 4000000000: the file is damaged, record anew");
  Recording descends = whole;
  ASSERT_EQ(descends.ticks.at(850).stylus_epoch, 1U);
  descends.ticks[850].commands |= command::change_stylus;
  descends.ticks[860].stylus_epoch = 0;
  EXPECT_EQ(unreplayable(descends), "the recording goes on from its stylus 1 to 0: the file is damaged, record anew");
}

}  // namespace
}  // namespace palpate::plugin

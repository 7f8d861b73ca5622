#include "plugin/paraview/client/model/mode_ids.h"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <utility>
#include <vector>

namespace palpate::plugin {
namespace {

/// A scene whose modes have a hidden identity, which a test knows and the numbers must follow.
struct KnownModes {
  modes::Scene scene;
  std::vector<int> who;
};

class Edits {
 public:
  explicit Edits(unsigned seed) : random_(seed) {}

  int below(int end) { return std::uniform_int_distribution(0, end - 1)(random_); }

  /// Named, or without a name between modes that are alike.
  modes::Mode any(bool named) {
    modes::Mode mode;
    mode.type = below(2) == 0 ? "surface" : "force";
    if (named) mode.name = "boundary " + std::to_string(names_++);
    mode.strength_n = modes::TransferFunction(0.5 + below(2));
    return mode;
  }

  /// Adds one, removes one, or changes one in its place.
  void change(KnownModes& of, bool named) {
    const int kind = below(4), count = static_cast<int>(of.who.size());
    const int at = below(count + 1);
    if (kind == 0 || count == 0) {
      of.scene.modes.insert(of.scene.modes.begin() + at, any(named));
      of.who.insert(of.who.begin() + at, next_++);
      return;
    }
    const int n = below(count);
    modes::Mode& mode = of.scene.modes[static_cast<std::size_t>(n)];
    if (kind == 1) {
      of.scene.modes.erase(of.scene.modes.begin() + n);
      of.who.erase(of.who.begin() + n);
    } else if (kind == 2) {
      mode.from = "tissue " + std::to_string(below(3));
    } else if (named) {
      mode.name = "renamed " + std::to_string(names_++);
    } else {
      mode.strength_n = modes::TransferFunction(1.5 + below(2));
    }
  }

 private:
  std::mt19937 random_;
  int names_ = 0, next_ = 0;
};

// A press that waits is never for another mode than the one that was shown; one with a name is always found.
TEST(ModeIds, FollowEachModeThroughEdits) {
  int kept_unnamed = 0;
  for (unsigned seed = 0; seed < 400; ++seed) {
    SCOPED_TRACE(seed);
    const bool named = seed % 2 == 0;
    Edits edits(seed);
    KnownModes now;
    ModeIds ids;
    std::vector<std::pair<unsigned, int>> shown;
    for (int step = 0; step < 12; ++step) {
      const modes::Scene before = now.scene;
      edits.change(now, named);
      ids.follow(before, now.scene);
      for (const auto& [id, who] : shown) {
        const auto place = ids.place_of(id);
        const auto there = std::ranges::find(now.who, who);
        if (place) {
          EXPECT_EQ(now.who[*place], who);
        } else if (named) {
          EXPECT_EQ(there, now.who.end());
        }
        kept_unnamed += !named && place ? 1 : 0;
      }
      shown.clear();
      for (std::size_t n = 0; n < now.who.size(); ++n) shown.emplace_back(ids.at(n), now.who[n]);
    }
  }
  EXPECT_GT(kept_unnamed, 1000);
}

TEST(ModeIds, AnotherSceneKeepsOnlyWhatItNames) {
  const auto scene = [](const std::string& name, const std::vector<std::string>& boundaries) {
    modes::Scene made;
    made.name = name;
    for (const std::string& boundary : boundaries) {
      made.modes.emplace_back();
      made.modes.back().type = "surface";
      made.modes.back().name = boundary;
    }
    return made;
  };
  ModeIds ids;
  const modes::Scene one = scene("one", {"Skin", "Bone", ""});
  ids.follow({}, one);
  const unsigned skin = ids.at(0), bone = ids.at(1);
  ids.follow(one, scene("two", {"Bone", "Gas", "Fat"}));
  EXPECT_EQ(ids.place_of(skin), std::nullopt);
  EXPECT_EQ(ids.place_of(bone), 0U);
}

}  // namespace
}  // namespace palpate::plugin

#include "plugin/paraview/client/model/scene_reader.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "io/fields/filtered.h"
#include "modes/scene/scene_json.h"
#include "plugin/paraview/client/model/session_controller.h"
#include "plugin/paraview/client/model/testing/application.h"
#include "plugin/paraview/client/model/testing/made_text.h"
#include "plugin/testing/opened_files.h"
#include "plugin/testing/registered_study.h"
#include "plugin/testing/test_clocks.h"
#include "plugin/testing/test_files.h"

namespace palpate::plugin {
namespace {

using testing::comes;

/// A study with a structure that a registration puts on the scan.
struct SceneReading : testing::WithApplication, ::testing::Test {
  SceneReading() {
    testing::write_contours(folder / "cube" / "cube.dcm", "1.2", "7", "Doe^Jane");
    testing::write_registration(folder / "registration" / "moved.dcm");
    model.open(modes::load_scene("ct-skin-and-bone"));
    session.set_scan(testing::registered_scan(), {});
  }
  SceneModel::Change keeping_out(double margin_mm) const {
    return [file = (folder / "cube" / "cube.dcm").string(), margin_mm](modes::Scene& scene) {
      scene.structures = {{.name = "Cube", .file = file, .segment = "Cube"}};
      std::erase_if(scene.modes, [](const modes::Mode& mode) { return mode.type == "keep_out"; });
      modes::Mode mode;
      mode.type = "keep_out";
      mode.name = "Keep out of the cube";
      mode.structure = "Cube";
      mode.margin_mm = margin_mm;
      mode.strength_n = modes::TransferFunction({{0, 1}});
      scene.modes.push_back(mode);
    };
  }
  std::shared_ptr<const io::DistanceField> felt_field() const {
    return session.live().felt().structures.front().distance;
  }
  /// How often each file is opened where it is read once.
  std::map<std::string, int> one_reading() const {
    testing::OpenedFiles opened({folder / "cube", folder / "registration"});
    modes::Scene scene = model.scene();
    keeping_out(2)(scene);
    (void)session.live().reading(scene, session.live().scan())();
    return opened.count();
  }
  double felt_margin_mm() const {
    for (const modes::Mode& mode : session.live().scene().modes) {
      if (mode.type == "keep_out") return mode.margin_mm;
    }
    return 0;
  }

  std::filesystem::path folder = testing::fresh_path("read_scenes");
  MadeText kept;
  SceneModel model{kept};
  SessionController session{model};
};

/// Whatever changes the scene: the thread that asks goes on at once, and the change is felt when all is read.
TEST_F(SceneReading, NoChangeReadsFilesOnTheThreadThatAsks) {
  testing::OpenedFiles opened({folder / "cube", folder / "registration"});
  const auto edit = [this](double margin_mm) {
    return [this, margin_mm] { model.edit(QStringLiteral("Keep out"), keeping_out(margin_mm)); };
  };
  const std::vector<std::pair<const char*, std::pair<std::function<void()>, double>>> changes{
      {"a structure that was not read", {edit(2), 2}},
      {"a margin as far as it was read", {edit(2.5), 2.5}},
      {"a margin that needs a field of another reach", {edit(6), 6}},
      {"undo", {[this] { model.undo(); }, 2.5}},
      {"undo to a scene without it", {[this] { model.undo(), model.undo(); }, 0}},
      {"redo", {[this] { model.redo(); }, 2}},
      {"a drag", {[this] { model.drag(keeping_out(11)); }, 11}},
      {"a script's scene",
       {[this] {
          modes::Scene scene = model.scene();
          keeping_out(15)(scene);
          kept.put("Scene", modes::to_json(scene));
        },
        15}}};
  const std::map<std::string, int> once = one_reading();
  for (const auto& [what, change] : changes) {
    SCOPED_TRACE(what);
    opened.count();
    change.first();
    const bool at_once = felt_margin_mm() == change.second;
    EXPECT_TRUE(!at_once || opened.count().empty()) << "it was read while the panel stood still";
    ASSERT_TRUE(comes([&] { return felt_margin_mm() == change.second; }));
    for (const auto& [file, times] : opened.count()) EXPECT_LE(times, once.at(file)) << file << " was read again";
    EXPECT_FALSE(model.is_waiting());
    EXPECT_EQ(session.live().felt().structures.size(), change.second > 0 ? 1U : 0U);
  }
}

/// A stroke on a structure that is felt already: its field is made by another thread, once.
TEST_F(SceneReading, AnEditOfWhatIsFeltIsMadeInTheBackground) {
  model.edit(QStringLiteral("Keep out"), keeping_out(2));
  ASSERT_TRUE(comes([&] { return felt_margin_mm() == 2; }));
  const auto before = felt_field();
  for (std::size_t count = 1; count <= 3; ++count) {
    model.edit(QStringLiteral("Add"), [](modes::Scene& scene) {
      std::vector<io::Edit>& edits = scene.structures.front().edits;
      edits.emplace_back(io::AddEdit{{.path_mm = {{110, 0, 3.0 * static_cast<double>(edits.size())}}, .radius_mm = 3}});
    });
    EXPECT_TRUE(model.is_waiting());
    ASSERT_TRUE(comes([&] { return !model.is_waiting(); }));
    ASSERT_EQ(session.live().felt().structures.size(), 1U);
    EXPECT_EQ(session.live().felt().structures.front().edits.size(), count);
  }
  EXPECT_NE(felt_field(), before);
  // What it was is kept: nothing is to be made for it.
  model.edit(QStringLiteral("As in the file"), [](modes::Scene& scene) { scene.structures.front().edits.clear(); });
  EXPECT_FALSE(model.is_waiting());
  EXPECT_EQ(felt_field(), before);
}

/// Not longer than their scan: fields are large.
TEST_F(SceneReading, WhatWasReadIsForgottenWithItsScan) {
  std::weak_ptr<const io::DistanceField> read;
  for (const double margin_mm : {2.0, 6.0, 11.0}) {
    model.edit(QStringLiteral("Keep out"), keeping_out(margin_mm));
    ASSERT_TRUE(comes([&] { return felt_margin_mm() == margin_mm; }));
    if (!read.lock()) read = felt_field();
  }
  EXPECT_FALSE(read.expired()) << "undo finds it again";
  session.set_scan(testing::registered_scan(), {});
  model.edit(QStringLiteral("Keep out"), keeping_out(20));
  ASSERT_TRUE(comes([&] { return felt_margin_mm() == 20; }));
  EXPECT_TRUE(read.expired());
}

/// Of the scene that is felt: a tick from before an edit names none of another scene's.
TEST_F(SceneReading, TheNearestStructureIsTold) {
  session.set_clock([](double period_s) { return std::make_unique<testing::UnhurriedClock>(period_s); });
  session.connect_stylus({.device = "simulated"});
  ASSERT_TRUE(comes([&] { return session.last().fresh; }));
  EXPECT_FALSE(session.last().nearest) << "the scene has no structure";
  model.edit(QStringLiteral("Keep out"), keeping_out(2));
  ASSERT_TRUE(comes([&] { return session.last().nearest.has_value(); }));
  EXPECT_EQ(session.last().nearest->structure, 0U);
  EXPECT_EQ(session.last().tick.scene_epoch, session.live().epoch());
  session.disconnect_stylus();
}

TEST_F(SceneReading, AFileThatIsGoneRefusesTheChangeAndSaysWhich) {
  std::filesystem::remove_all(folder / "cube");
  QString why;
  model.edit(QStringLiteral("Keep out"), keeping_out(2), [&why](const QString& said) { why = said; });
  ASSERT_TRUE(comes([&] { return !why.isEmpty(); }));
  EXPECT_NE(why.toStdString().find("Cube"), std::string::npos) << why.toStdString();
  EXPECT_EQ(felt_margin_mm(), 0);
  EXPECT_TRUE(model.scene().structures.empty());
}

/// Another frame of the scan comes while a structure is read for the one before: it is felt on the new one.
TEST_F(SceneReading, AChangeThatWaitsIsDoneOnTheFrameThatIsThereThen) {
  model.edit(QStringLiteral("Keep out"), keeping_out(2));
  ASSERT_TRUE(model.is_waiting());
  const auto frame = testing::registered_scan();
  session.set_scan(frame, {.number = 1, .count = 2});
  ASSERT_TRUE(comes([&] { return felt_margin_mm() == 2; }));
  EXPECT_EQ(session.live().scan(), frame);
  EXPECT_EQ(session.live().felt().structures.size(), 1U);
}

/// A state brings scan and scene together: what the scene needs is read in the background, and nothing is felt before.
TEST_F(SceneReading, AScanThatIsExpectedIsFeltWhenItsStructuresAreRead) {
  const std::map<std::string, int> once = one_reading();
  modes::Scene scene = model.scene();
  const std::pair<const char*, io::Filter> filters[] = {{"none", {}},
                                                        {"gaussian", {.type = io::find_filter_type("gaussian")}}};
  for (const auto& [name, filter] : filters) {
    for (const bool has_scan : {false, true}) {
      SCOPED_TRACE(::testing::Message() << name << (has_scan ? ", a scan before" : ", no scan before"));
      if (!has_scan) session.set_no_scan({});
      session.expect_scan();
      const double margin_mm = has_scan ? 6 : 2;  // of another reach, so that the field before does not serve
      keeping_out(margin_mm)(scene);
      scene.filter = filter;
      model.open(scene);
      testing::OpenedFiles opened({folder / "cube", folder / "registration"});
      const auto scan = testing::registered_scan();
      session.set_scan(scan, {});
      EXPECT_TRUE(session.expects_scan()) << "it was read while the panel stood still";
      EXPECT_NE(session.live().scan(), scan);
      session.feel();
      EXPECT_FALSE(session.last().feels);
      ASSERT_TRUE(comes([&] { return session.live().scan() == scan; }));
      EXPECT_FALSE(session.expects_scan());
      for (const auto& [file, times] : opened.count()) EXPECT_LE(times, once.at(file)) << file << " was read again";
      EXPECT_EQ(felt_margin_mm(), margin_mm);
      EXPECT_EQ(session.live().felt().structures.size(), 1U);
      EXPECT_EQ(io::filter_of(*session.live().felt_scan()), filter);
    }
  }
}

/// Of two scans the last is felt, and none if there is to be none.
TEST_F(SceneReading, AScanThatIsReadForGivesWayToTheNext) {
  modes::Scene scene = model.scene();
  keeping_out(2)(scene);
  session.expect_scan();
  model.open(scene);
  session.set_scan(testing::registered_scan(), {});
  const auto last = testing::registered_scan();
  session.set_scan(last, {});
  ASSERT_TRUE(comes([&] { return session.live().scan() == last; }));
  session.expect_scan();
  session.set_scan(testing::registered_scan(), {});
  session.set_no_scan({});
  EXPECT_FALSE(session.expects_scan());
  const auto later = std::chrono::steady_clock::now() + std::chrono::milliseconds(300);
  EXPECT_TRUE(comes([&] { return session.live().scan() || std::chrono::steady_clock::now() > later; }));
  EXPECT_EQ(session.live().scan(), nullptr);
}

/// A frame that comes without the scene's filter, from a server or because the filter was chosen meanwhile.
TEST_F(SceneReading, AFrameIsFilteredInTheBackground) {
  modes::Scene scene = model.scene();
  scene.filter.type = io::find_filter_type("gaussian");
  session.expect_scan();
  model.open(scene);
  session.set_scan(testing::registered_scan(), {});
  ASSERT_TRUE(comes([&] { return !session.expects_scan(); }));
  int changes = 0;
  QObject::connect(&session, &SessionController::felt_scan_changed, [&changes] { ++changes; });
  const auto frame = testing::registered_scan();
  session.set_scan(frame, {.number = 1, .count = 2});
  EXPECT_TRUE(session.expects_scan()) << "it was filtered while the panel stood still";
  EXPECT_NE(session.live().scan(), frame);
  EXPECT_EQ(changes, 0);
  ASSERT_TRUE(comes([&] { return session.live().scan() == frame; }));
  EXPECT_EQ(io::filter_of(*session.live().felt_scan()), scene.filter);
  EXPECT_EQ(changes, 1) << "what is drawn follows once";
  session.set_no_scan({});
  EXPECT_EQ(changes, 2);
}

/// Another scene is chosen while the scan is prepared for the one before: it is prepared for that, too.
TEST_F(SceneReading, AScanIsReadForTheSceneThatItMeets) {
  modes::Scene scene = model.scene();
  int read = 0;
  QObject::connect(&session, &SessionController::connection_changed, [&] { read += session.expects_scan() ? 1 : 0; });
  for (const char* const filter : {"gaussian", "median"}) {
    session.expect_scan();
    scene.filter.type = io::find_filter_type(filter);
    model.open(scene);
    read = 0;
    const auto scan = testing::registered_scan();
    session.set_scan(scan, {});
    model.edit(QStringLiteral("Keep out"), keeping_out(2));
    model.edit(QStringLiteral("Filter"),
               [](modes::Scene& now) { now.filter.type = io::find_filter_type("bilateral"); });
    ASSERT_TRUE(comes([&] { return session.live().scan() == scan; }));
    EXPECT_EQ(read, 2) << "it was read while the panel stood still";
    EXPECT_EQ(io::filter_of(*session.live().felt_scan()), model.scene().filter);
    EXPECT_EQ(session.live().felt().structures.size(), 1U);
  }
}

/// A state whose scan cannot be fetched: its scene is not waited for.
TEST_F(SceneReading, AScanThatDoesNotComeIsNoLongerExpected) {
  session.expect_scan();
  session.set_no_scan({});
  EXPECT_TRUE(session.expects_scan()) << "the one before made way";
  session.set_no_scan(QStringLiteral("the folder is gone"));
  EXPECT_FALSE(session.expects_scan());
}

/// A file that is gone: no scan is felt without what the scene asks for, and the reason names the structure.
TEST_F(SceneReading, AScanWhoseStructureIsGoneIsNotFelt) {
  modes::Scene scene = model.scene();
  keeping_out(2)(scene);
  std::filesystem::remove_all(folder / "cube");
  QString why;
  QObject::connect(&session, &SessionController::told, [&why](const QString& text, bool) { why += text; });
  session.expect_scan();
  model.open(scene);
  session.set_scan(testing::registered_scan(), {});
  ASSERT_TRUE(comes([&] { return why.contains(QStringLiteral("Cube")); }));
  EXPECT_EQ(session.live().scan(), nullptr);
  EXPECT_FALSE(session.expects_scan());
}

/// Another stylus, of another reach: the structures are at hand.
TEST_F(SceneReading, AStylusThatIsConnectedReadsNoFile) {
  model.edit(QStringLiteral("Keep out"), keeping_out(2));
  ASSERT_TRUE(comes([&] { return felt_margin_mm() == 2; }));
  testing::OpenedFiles opened({folder / "cube", folder / "registration"});
  const auto before = felt_field();
  session.connect_stylus({.device = "simulated"});
  ASSERT_TRUE(session.live().is_connected());
  EXPECT_TRUE(opened.count().empty());
  EXPECT_EQ(felt_field(), before);
}

}  // namespace
}  // namespace palpate::plugin

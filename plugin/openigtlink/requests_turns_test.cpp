// Requests of clients: folders, and which of several requests takes effect.

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "io/errors.h"
#include "plugin/openigtlink/names.h"
#include "plugin/openigtlink/requests.h"
#include "plugin/openigtlink/testing/asked_session.h"

namespace palpate::plugin::igtl {
namespace {

using testing::sent_n;
using testing::SharedSession;
using testing::TestClient;

/// A folder whose loading takes until it is let go.
struct SlowFolder {
  std::promise<void> begun, let_go;
  std::shared_future<void> until = let_go.get_future().share();

  std::atomic<int> loads{0};

  LoadedScan load() {
    if (++loads == 1) begun.set_value();
    until.wait();
    return {.volume = testing::ball_of_tissue(), .frame = {}};
  }
};

/// Whether the folder is being loaded, because a client asked for it.
bool begins(SlowFolder& slow, SharedSession& shared, TestClient& client) {
  shared.load = [&slow](const std::string&) { return slow.load(); };
  client.send_text(folder_name, "/scans/slow");
  auto begun = slow.begun.get_future();
  return shared.comes([&] { return begun.wait_for(std::chrono::seconds(0)) == std::future_status::ready; });
}

TEST(OpenIgtRequests, AFolderIsLoadedAndASceneGoesOn) {
  SharedSession shared;
  std::string asked;
  shared.load = [&](const std::string& folder) {
    asked = folder;
    return LoadedScan{.volume = testing::ball_of_tissue(), .frame = {}};
  };
  TestClient client(shared.server.port());
  const auto before = shared.session.scan();
  client.send_text(folder_name, "/scans/other");
  EXPECT_TRUE(shared.comes([&] { return shared.session.scan() != before; }));
  EXPECT_EQ(asked, "/scans/other");
  EXPECT_EQ(shared.session.scene().name, "CT: skin and bone");
  EXPECT_TRUE(shared.comes([&] { return sent_n(shared) > 0.3; }));
}

TEST(OpenIgtRequests, OfWhatComesWhileOneIsPreparedTheNewestIsFelt) {
  SharedSession shared;
  SlowFolder slow;
  TestClient client(shared.server.port());
  ASSERT_TRUE(begins(slow, shared, client));
  constexpr int scenes = 40;
  modes::Scene scene = modes::load_scene("ct-skin-and-bone");
  for (int n = 0; n < scenes; ++n) {
    scene.name = "scene " + std::to_string(n);
    client.send_text(scene_name, modes::to_json(scene));
    shared.look();
  }
  EXPECT_TRUE(shared.comes([&] { return shared.server.counts().taken == scenes + 1U; }));
  EXPECT_EQ(shared.server.counts().outrun, scenes - 1U) << "they wait where the newest takes the place of the others";
  slow.let_go.set_value();
  EXPECT_TRUE(shared.comes([&] { return shared.session.scene().name == "scene 39"; }));
}

TEST(OpenIgtRequests, WhatTheOwnerDoesMeanwhileStays) {
  SharedSession shared;
  std::promise<void> begun, let_go;
  auto until = let_go.get_future().share();
  std::atomic<int> loads{0};
  shared.load = [&, until](const std::string&) {
    if (++loads == 1) begun.set_value();
    until.wait();
    return LoadedScan{.volume = testing::ball_of_tissue(), .frame = {}};
  };
  TestClient client(shared.server.port());
  const auto before = shared.session.scan();
  client.send_text(folder_name, "/scans/slow");
  auto has_begun = begun.get_future();
  ASSERT_TRUE(shared.comes([&] { return has_begun.wait_for(std::chrono::seconds(0)) == std::future_status::ready; }));
  modes::Scene own = shared.session.scene();
  own.name = "the owner's";
  own.limits.force_n = 1;
  shared.session.set_scene(own);
  let_go.set_value();
  EXPECT_TRUE(shared.comes([&] { return shared.session.scan() != before; }));
  EXPECT_EQ(loads, 2) << "prepared again, of the owner's scene";
  EXPECT_EQ(shared.session.scene().name, "the owner's");
  EXPECT_EQ(shared.session.scene().limits.force_n, 1);
}

/// It is whole: taken later, it would undo what the owner has changed since.
TEST(OpenIgtRequests, ASceneThatIsOlderThanTheOwnersIsRefused) {
  SharedSession shared;
  TestClient client(shared.server.port());
  modes::Scene theirs = shared.session.scene(), own = theirs;
  theirs.name = "a client's";
  own.name = "the owner's";
  client.send_text(scene_name, modes::to_json(theirs));
  for (int n = 0; n < 10'000 && shared.server.counts().taken == 0; ++n) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  ASSERT_EQ(shared.server.counts().taken, 1U);
  shared.sharing->look();  // it begins to be prepared
  shared.session.set_scene(own);
  EXPECT_EQ(testing::text_of_status(shared, client, "refused"),
            "refused: the scene was changed at the stylus while this one was being prepared");
  EXPECT_EQ(shared.session.scene().name, "the owner's");
  // What is sent after it counts, and another frame of the scan is no change of the scene.
  client.send_text(scene_name, modes::to_json(theirs));
  for (int n = 0; n < 10'000 && shared.server.counts().taken == 1; ++n) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  shared.sharing->look();
  shared.session.set_scan(testing::ball_of_tissue());
  EXPECT_TRUE(shared.comes([&] { return shared.session.scene().name == "a client's"; }));
}

/// However long it waits for its turn. What the client itself asks for before it, and another frame of the scan, are no
/// changes of the owner.
TEST(OpenIgtRequests, ASceneThatWaitsIsRefusedIfTheOwnerChangesTheSceneMeanwhile) {
  enum class Owner { does_nothing, changes_before, changes_after, changes_and_undoes, takes_another_frame };
  for (const Owner owner : {Owner::does_nothing, Owner::changes_before, Owner::changes_after, Owner::changes_and_undoes,
                            Owner::takes_another_frame}) {
    SCOPED_TRACE(static_cast<int>(owner));
    SharedSession shared;
    SlowFolder slow;
    TestClient client(shared.server.port());
    ASSERT_TRUE(begins(slow, shared, client));
    const modes::Scene first = shared.session.scene();
    modes::Scene theirs = first, own = first;
    theirs.name = "a client's";
    own.name = "the owner's";
    const auto change_to = [&](const modes::Scene& scene) {
      shared.session.set_scene(scene);
      shared.look();
    };
    if (owner == Owner::changes_before) change_to(own);
    client.send(testing::ball_of_labels("liver", glm::dvec3(0), 20));
    client.send_text(scene_name, modes::to_json(theirs));
    EXPECT_TRUE(shared.comes([&] { return shared.server.counts().taken == 3; }));
    if (owner == Owner::changes_after || owner == Owner::changes_and_undoes) change_to(own);
    if (owner == Owner::changes_and_undoes) change_to(first);
    if (owner == Owner::takes_another_frame) shared.session.set_scan(testing::ball_of_tissue());
    slow.let_go.set_value();
    if (owner == Owner::changes_after) {
      EXPECT_EQ(testing::text_of_status(shared, client, "refused"),
                "refused: the scene was changed at the stylus while this one was being prepared");
      EXPECT_EQ(shared.session.scene().name, "the owner's");
      EXPECT_EQ(shared.session.scene().structures.size(), 1U) << "the label map goes on from the owner's scene";
    } else {
      EXPECT_TRUE(shared.comes([&] { return shared.session.scene().name == "a client's"; }));
    }
  }
}

/// As while the frames of a scan play: nothing is ready before the next one.
TEST(OpenIgtRequests, WhatIsOutOfDateAgainAndAgainIsRefusedInWords) {
  std::atomic<int> loads{0}, frames{0};
  SharedSession shared;
  shared.load = [&](const std::string&) {
    for (const int frame = ++loads; frames < frame;) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return LoadedScan{.volume = testing::ball_of_tissue(), .frame = {}};
  };
  TestClient client(shared.server.port());
  client.send_text(folder_name, "/scans/slow");
  std::optional<Status> status;
  EXPECT_TRUE(shared.comes([&] {
    if (frames < loads) {
      shared.session.set_scan(testing::ball_of_tissue());
      ++frames;
    }
    status = client.next_status("refused", 2);
    return status.has_value();
  }));
  frames = 1000;  // they stand
  ASSERT_TRUE(status);
  EXPECT_EQ(
      status->text,
      "refused: scan or scene changed 5 times while this was being prepared: stop the playback, and send it again");
  const auto before = shared.session.scan();
  client.send_text(folder_name, "/scans/slow");
  EXPECT_TRUE(shared.comes([&] { return shared.session.scan() != before; })) << "the next one is carried out";
  EXPECT_EQ(loads, 6);
}

/// The panel's thread would miss its heartbeat.
TEST(OpenIgtRequests, WhatIsBeingPreparedAtTheEndIsCancelledAndNotWaitedFor) {
  std::promise<void> begun, let_go;
  auto until = let_go.get_future().share();
  std::atomic<bool> was_cancelled{false};
  SharedSession shared;
  shared.sharing.reset();
  shared.sharing = std::make_unique<Sharing>(
      shared.session, shared.server, shared.received, shared.threads,
      changes_of(shared.session, [&](const std::string&, const io::Progress& progress) -> LoadedScan {
        begun.set_value();
        until.wait();
        was_cancelled = !progress(0.5);
        throw io::Cancelled();
      }));
  TestClient client(shared.server.port());
  client.send_text(folder_name, "/scans/slow");
  auto has_begun = begun.get_future();
  ASSERT_TRUE(shared.comes([&] { return has_begun.wait_for(std::chrono::seconds(0)) == std::future_status::ready; }));
  shared.sharing.reset();  // returns
  let_go.set_value();
  for (int n = 0; n < 10'000 && !was_cancelled; ++n) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_TRUE(was_cancelled);
}

TEST(OpenIgtRequests, FilesAreNamedByClientsOfThisMachineAlone) {
  const Server::Request near{.client = 1, .from_this_machine = true, .message = {}};
  const Server::Request far{.client = 1, .from_this_machine = false, .message = {}};
  EXPECT_NO_THROW(internal::check_file(near, "/scans/liver.nrrd"));
  EXPECT_THROW(internal::check_file(far, "/scans/liver.nrrd"), Refusal);
  modes::Scene felt, wanted;
  felt.structures = {{.name = "liver", .file = "/scans/liver.nrrd"}};
  wanted.structures = {{.name = "drawn", .file = ""}, {.name = "liver", .file = "/scans/liver.nrrd"}};
  EXPECT_NO_THROW(internal::check_files(far, wanted, felt)) << "contours name no file, and the liver's is felt already";
  wanted.structures.push_back({.name = "spleen", .file = "/scans/spleen.nrrd"});
  EXPECT_THROW(internal::check_files(far, wanted, felt), Refusal);
  EXPECT_NO_THROW(internal::check_files(near, wanted, felt));
}

}  // namespace
}  // namespace palpate::plugin::igtl

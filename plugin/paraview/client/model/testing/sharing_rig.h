#pragma once

/// The panel's models, shared with clients.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <memory>
#include <optional>
#include <utility>

#include "modes/scene/scene_json.h"
#include "plugin/openigtlink/names.h"
#include "plugin/openigtlink/testing/shared_session.h"
#include "plugin/openigtlink/testing/stepped_server.h"
#include "plugin/paraview/client/model/sharing_model.h"
#include "plugin/paraview/client/model/testing/application.h"
#include "plugin/paraview/client/model/testing/made_text.h"

namespace palpate::plugin::testing {

struct SharingTest : WithApplication, ::testing::Test {
  SharingTest() {
    session.set_clock([](double period_s) { return std::make_unique<plugin::testing::UnhurriedClock>(period_s); });
    model.open(modes::load_scene("ct-skin-and-bone"));
    QObject::connect(&sharing, &SharingModel::folder_wanted, [this](const QString& name) { folder = name; });
  }
  ~SharingTest() override {
    sharing.turn_off();
    session.disconnect_stylus();
  }
  void open_scan() {
    session.set_scan(igtl::testing::ball_of_tissue(), {});
    marks.set_scan("a scan");
  }
  /// The next message of that type and device, while events are handled.
  std::optional<igtl::Message> next(igtl::testing::TestClient& client, std::string_view type, std::string_view device) {
    std::optional<igtl::Message> found;
    comes([&] {
      const auto message = client.next(2);
      if (message && message->type == type && message->device == device) found = message;
      return found.has_value();
    });
    return found;
  }
  /// Turned on, with what every client gets first behind it.
  std::unique_ptr<igtl::testing::TestClient> a_client() {
    EXPECT_EQ(sharing.turn_on(0).toStdString(), "");
    auto client = std::make_unique<igtl::testing::TestClient>(sharing.port());
    EXPECT_TRUE(next(*client, "POINT", igtl::marks_name));
    return client;
  }
  /// A scene of a client's, of the usual limits.
  modes::Scene theirs() const {
    modes::Scene scene = modes::load_scene("ct-skin-and-bone");
    scene.name = "theirs";
    return scene;
  }
  /// Returns when it is long ago that the scene came.
  void send_and_wait(igtl::testing::TestClient& client, const modes::Scene& scene) {
    client.send_text(igtl::scene_name, modes::to_json(scene));
    client.send({.type = "GET_POINT", .device = igtl::marks_name, .content = {}});
    EXPECT_TRUE(next(client, "POINT", igtl::marks_name)) << "the answer to what was sent after the scene";
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(500);
    comes([&] { return std::chrono::steady_clock::now() > end; });
  }
  std::string next_status(igtl::testing::TestClient& client, const std::string& name) {
    std::string text;
    comes([&] {
      const auto message = next(client, "STATUS", igtl::program_name);
      if (!message) return true;
      const igtl::Status status = igtl::status_of(message->content);
      if (status.name == name) text = status.text;
      return !text.empty();
    });
    return text;
  }

  MadeText kept;
  SceneModel model{kept};
  MarksModel marks{kept};
  SessionController session{model};
  SharingModel sharing{session, model, marks};
  QString folder;
};

}  // namespace palpate::plugin::testing

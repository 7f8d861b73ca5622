// What clients are told of a session, against the ticks of that session.

#include "plugin/openigtlink/announcer.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "plugin/openigtlink/names.h"
#include "plugin/openigtlink/testing/shared_session.h"

namespace palpate::plugin::igtl {
namespace {

using testing::SharedSession;
using testing::TestClient;

/// The boundary pushes with more than the limit lets through, and a released stylus gets no force at all.
TEST(OpenIgtAnnouncer, AContactTellsTheForceThatTheHandGets) {
  for (const LiveSession::Start start : {LiveSession::Start::feeling, LiveSession::Start::released}) {
    SCOPED_TRACE(start == LiveSession::Start::feeling);
    modes::Scene scene = modes::load_scene("ct-skin-and-bone");
    scene.limits.force_n = 0.1;
    SharedSession shared(start, 0.0234, scene);
    TestClient client(shared.server.port());
    int held_back = 0;
    const auto compares = [&] {
      const auto message = client.next("STRING", contact_name, 20);
      if (!message) return false;
      const nlohmann::json contact = nlohmann::json::parse(string_of(message->content));
      const auto index = contact.at("tick").get<std::uint64_t>();
      TickRecord tick;
      if (!shared.session.ticks()->read(index, tick)) return false;
      EXPECT_EQ(tick.index, index);
      const double sent_n = glm::length(vector_of(tick.sent_n));
      EXPECT_NEAR(contact.at("force_n").get<double>(), sent_n, 1e-12);
      if (glm::length(vector_of(tick.force_n)) > sent_n + 0.05) ++held_back;
      return held_back == 3;
    };
    EXPECT_TRUE(shared.comes(compares));
  }
}

}  // namespace
}  // namespace palpate::plugin::igtl

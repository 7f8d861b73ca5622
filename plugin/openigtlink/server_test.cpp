// The server against clients that are slow, numerous, or break the protocol: each affects only itself.

#include "plugin/openigtlink/server.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>

#include "plugin/openigtlink/image.h"
#include "plugin/openigtlink/names.h"
#include "plugin/openigtlink/testing/stepped_server.h"

namespace palpate::plugin::igtl {
namespace {

using testing::Connection;
using testing::SteppedServer;
using testing::TestClient;
using testing::wire_of;

Message status_that_says(const std::string& text) {
  return {.type = "STATUS", .device = program_name, .content = content_of(Status{.text = text})};
}

/// What has come until so many requests were taken.
std::vector<Server::Request> requests_of(Server& server, std::uint64_t taken) {
  for (int n = 0; n < 500 && server.counts().taken < taken; ++n) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_EQ(server.counts().taken, taken);
  return server.take();
}

void wait_for_clients(Server& server, std::size_t count) {
  for (int n = 0; n < 500 && server.counts().clients != count; ++n) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  ASSERT_EQ(server.counts().clients, count);
}

TEST(OpenIgtServer, ANewClientGetsWhatIsKept) {
  SteppedServer stepped;
  stepped.server.offer("status", wire_of(status_that_says("kept")), true);
  stepped.server.offer("other", wire_of(status_that_says("not kept")));
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  TestClient client(stepped.server.port());
  const auto message = client.next();
  ASSERT_TRUE(message);
  EXPECT_EQ(status_of(message->content).text, "kept");
  EXPECT_FALSE(client.next(100));
}

// 200 MB are offered to a client that reads nothing: it gets the newest afterwards, and few of those before.
TEST(OpenIgtServer, ASlowClientGetsTheNewest) {
  SteppedServer stepped;
  TestClient slow(stepped.server.port());
  wait_for_clients(stepped.server, 1);
  constexpr int offers = 2000;
  const std::string padding(100'000, ' ');
  for (int n = 0; n < offers; ++n) {
    stepped.server.offer("frame", wire_of(status_that_says(std::to_string(n) + padding)));
    if (n % 20 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  int got = 0, last = -1;
  while (const auto message = slow.next(3000)) {
    const int number = std::stoi(status_of(message->content).text);
    EXPECT_GT(number, last) << "in order";
    last = number;
    ++got;
  }
  EXPECT_EQ(last, offers - 1);
  EXPECT_LT(got, offers / 2);
}

TEST(OpenIgtServer, AClientThatReadsNothingForTenSecondsIsCut) {
  std::array<int, 2> sockets{};
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, sockets.data()), 0);
  ServerCounts counts;
  Client client(sockets[0], 1, true, [](const Header&) { return std::size_t{0}; });
  const auto now = Client::Clock::now();
  EXPECT_FALSE(client.ends(now + std::chrono::hours(1), counts)) << "silent, with nothing to write: it may only listen";
  client.queue({"frame", std::make_shared<const Bytes>(10'000'000)}, counts);
  client.write(counts);
  EXPECT_FALSE(client.ends(now + std::chrono::seconds(9), counts));
  EXPECT_TRUE(client.ends(now + std::chrono::seconds(11), counts));
  EXPECT_EQ(counts.cut, 1U);
  ::close(sockets[1]);
}

TEST(OpenIgtServer, TheFirstThatSendsControlsUntilItIsGone) {
  SteppedServer stepped;
  TestClient second(stepped.server.port());  // also if it connects first
  {
    TestClient first(stepped.server.port());
    first.send_text(scene_name, "of the first");
    ASSERT_EQ(requests_of(stepped.server, 1).size(), 1U);
    second.send_text(scene_name, "of the second");
    const auto status = second.next_status("refused");
    ASSERT_TRUE(status);
    EXPECT_EQ(status->code, Status::Code::access_denied);
    EXPECT_EQ(status->text, "another client controls; this one can only read");
    EXPECT_TRUE(stepped.server.take().empty());
  }
  wait_for_clients(stepped.server, 1);
  second.send_text(scene_name, "of the second");
  const auto requests = requests_of(stepped.server, 2);
  ASSERT_EQ(requests.size(), 1U);
  EXPECT_EQ(string_of(requests.front().message.content), "of the second");
  EXPECT_TRUE(requests.front().from_this_machine);
}

TEST(OpenIgtServer, OfAFloodTheNewestIsTaken) {
  SteppedServer stepped;
  TestClient client(stepped.server.port());
  constexpr int floods = 2000;
  for (int n = 0; n < floods; ++n) client.send_text(scene_name, "scene " + std::to_string(n));
  const auto requests = requests_of(stepped.server, floods);
  ASSERT_EQ(requests.size(), 1U);
  EXPECT_EQ(string_of(requests.front().message.content), "scene " + std::to_string(floods - 1));
  EXPECT_EQ(stepped.server.counts().outrun, floods - 1U);
}

// A client that does not control asks: by a type that only begins like a question, it cannot have anything done.
TEST(OpenIgtServer, WhatOnlyBeginsLikeAQuestionIsNone) {
  SteppedServer stepped;
  TestClient first(stepped.server.port()), second(stepped.server.port());
  first.send_text(scene_name, "controls");
  EXPECT_EQ(requests_of(stepped.server, 1).size(), 1U);
  for (const char* const type : {"GET_", "STT_", "STP_", "XYZ_STRING"}) {
    second.send({.type = type, .device = scene_name, .content = string_content("{}")});
  }
  second.send_text(scene_name, "refused");
  ASSERT_TRUE(second.next_status("refused"));
  EXPECT_TRUE(stepped.server.take().empty());
  EXPECT_EQ(stepped.server.counts().taken, 1U);
}

// Label maps of a thousand names: the queue stays short.
TEST(OpenIgtServer, OfManyNamesTheNewestAreTaken) {
  SteppedServer stepped;
  TestClient client(stepped.server.port());
  for (int n = 0; n < 1000; ++n) {
    client.send({.type = "IMAGE", .device = "map " + std::to_string(n), .content = Bytes(100)});
  }
  const auto requests = requests_of(stepped.server, 1000);
  EXPECT_LE(requests.size(), 16U);
  EXPECT_EQ(requests.back().message.device, "map 999");
}

/// Sixteen label maps may wait, but not of any size: what waits, also in the hands of who took it, has a limit.
TEST(OpenIgtServer, RequestsTakeNoMoreMemoryThanTheirLimit) {
  SteppedServer stepped(10'000);
  TestClient client(stepped.server.port());
  const auto send = [&](const std::string& name, std::size_t size) {
    client.send({.type = "IMAGE", .device = name, .content = Bytes(size)});
  };
  send("first", 6000);
  send("second", 5000);
  const auto refused = client.next_status("refused");
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->code, Status::Code::overflow);
  EXPECT_EQ(refused->text, "IMAGE \"second\" has 5000 bytes, too many while 6000 bytes of others wait");
  send("third", 4000);
  auto taken = requests_of(stepped.server, 2);
  ASSERT_EQ(taken.size(), 2U);
  EXPECT_EQ(taken[1].message.device, "third");
  send("fourth", 1);
  ASSERT_TRUE(client.next_status("refused")) << "what was taken is still there";
  taken.erase(taken.begin());
  send("fifth", 6000);
  EXPECT_EQ(requests_of(stepped.server, 3).size(), 1U);
  send("fifth again", 5000);
  send("fifth again", 6000);
  taken = requests_of(stepped.server, 5);
  ASSERT_EQ(taken.size(), 1U) << "the newer one of a name takes the place of the older";
  EXPECT_EQ(taken.front().message.content.size(), 6000U);
  taken.clear();
  send("a large one", 20'000);
  const auto alone = requests_of(stepped.server, 6);
  ASSERT_EQ(alone.size(), 1U) << "alone it is taken";
  EXPECT_EQ(alone.front().message.content.size(), 20'000U);
}

TEST(OpenIgtServer, ALyingClientIsRefusedAndClosedAndOthersGoOn) {
  SteppedServer stepped;
  TestClient other(stepped.server.port()), liar(stepped.server.port());
  wait_for_clients(stepped.server, 2);
  Bytes wire = wire_of({.type = "IMAGE", .device = "liver", .content = {}});
  std::fill(wire.begin() + 42, wire.begin() + 50, std::uint8_t{0x11});
  liar.send(wire);
  const auto status = liar.next_status("refused");
  ASSERT_TRUE(status);
  EXPECT_EQ(status->code, Status::Code::overflow);
  EXPECT_TRUE(liar.is_closed_soon());
  stepped.server.offer("status", wire_of(status_that_says("goes on")));
  EXPECT_TRUE(other.next());
}

TEST(OpenIgtServer, ADamagedMessageIsAnsweredAndTheConnectionStays) {
  SteppedServer stepped;
  TestClient client(stepped.server.port());
  Bytes wire = wire_of({.type = "STRING", .device = scene_name, .content = string_content("{}")});
  wire.back() ^= 1U;
  client.send(wire);
  const auto status = client.next_status("refused");
  ASSERT_TRUE(status);
  EXPECT_EQ(status->code, Status::Code::checksum_error);
  client.send_text(scene_name, "{}");
  EXPECT_EQ(requests_of(stepped.server, 1).size(), 1U);
  EXPECT_EQ(stepped.server.counts().dropped, 1U);
}

TEST(OpenIgtServer, BeyondTheMostClientsAreTurnedAway) {
  SteppedServer stepped;
  std::vector<std::unique_ptr<Connection>> clients;
  for (std::size_t n = 0; n < most_clients; ++n) {
    clients.push_back(std::make_unique<Connection>(stepped.server.port()));
  }
  wait_for_clients(stepped.server, most_clients);
  TestClient late(stepped.server.port());
  EXPECT_TRUE(late.is_closed_soon());
  clients.pop_back();
  wait_for_clients(stepped.server, most_clients - 1);
  const Connection in_time(stepped.server.port());
  wait_for_clients(stepped.server, most_clients);
}

// Nobody is waited for: with clients that send half a message and stop, others get every frame.
TEST(OpenIgtServer, HalfMessagesHoldNobodyUp) {
  SteppedServer stepped;
  TestClient half_header(stepped.server.port()), half_body(stepped.server.port()), reader(stepped.server.port());
  wait_for_clients(stepped.server, 3);
  const Bytes wire =
      wire_of({.type = "STRING", .device = scene_name, .content = string_content(std::string(500, ' '))});
  half_header.send(ByteView(wire).first(30));
  half_body.send(ByteView(wire).first(300));
  for (int n = 0; n < 50; ++n) {
    stepped.server.offer("frame", wire_of(status_that_says(std::to_string(n))));
    const auto message = reader.next(2000);
    ASSERT_TRUE(message);
    EXPECT_EQ(status_of(message->content).text, std::to_string(n));
  }
  half_body.send(ByteView(wire).subspan(300));
  EXPECT_EQ(requests_of(stepped.server, 1).size(), 1U) << "its second half arrives";
}

TEST(OpenIgtServer, QueriesAreAnswered) {
  SteppedServer stepped;
  stepped.server.offer("status", wire_of(status_that_says("now")), true);
  TestClient client(stepped.server.port());
  ASSERT_TRUE(client.next());
  client.send({.type = "GET_STATUS", .device = "", .content = {}});
  const auto answered = client.next();
  ASSERT_TRUE(answered);
  EXPECT_EQ(status_of(answered->content).text, "now");
  client.send({.type = "GET_POINT", .device = "", .content = {}});
  const auto status = client.next_status("refused");
  ASSERT_TRUE(status);
  EXPECT_EQ(status->text, "GET_POINT: there is nothing to get");

  const auto frames_come = [&] {
    stepped.server.offer(frame_name,
                         wire_of({.type = "TRANSFORM", .device = "Stylus", .content = content_of(Transform{})}));
    return client.next("TRANSFORM", "Stylus", 200).has_value();
  };
  EXPECT_TRUE(frames_come());
  client.send({.type = "STP_TRANS", .device = "", .content = {}});
  ASSERT_TRUE(client.next("RTS_TRANS", ""));
  EXPECT_FALSE(frames_come());
  client.send({.type = "STT_TRANS", .device = "", .content = {}});
  const auto started = client.next("RTS_TRANS", "");
  ASSERT_TRUE(started);
  EXPECT_EQ(started->content, Bytes{0});
  EXPECT_TRUE(frames_come());
  client.send({.type = "STT_TDATA", .device = "", .content = {}});
  const auto unknown = client.next("RTS_TDATA", "");
  ASSERT_TRUE(unknown);
  EXPECT_EQ(unknown->content, Bytes{1});
}

/// A type's name has at most 12 bytes, so that a TRANSFORM is asked for by GET_TRANS. Of what is kept each is answered
/// that is of the type, and of the device if one is named.
TEST(OpenIgtServer, EachTypeThatIsKeptIsGotByItsQuery) {
  SteppedServer stepped;
  TestClient client(stepped.server.port());
  wait_for_clients(stepped.server, 1);
  const std::pair<const char*, const char*> kept[] = {
      {"TRANSFORM", "Needle"}, {"TRANSFORM", "Probe"}, {"STATUS", "a"}, {"STRING", "a"}, {"POINT", "b"}};
  for (const auto& [type, device] : kept) {
    stepped.server.offer(std::string(type) + " " + device,
                         wire_of({.type = type, .device = device, .content = Bytes(60)}), true);
  }
  const std::pair<const char*, const char*> queries[] = {
      {"GET_TRANS", "TRANSFORM"}, {"GET_STATUS", "STATUS"}, {"GET_STRING", "STRING"}, {"GET_POINT", "POINT"}};
  for (std::size_t n = 0; n < std::size(kept); ++n) ASSERT_TRUE(client.next());
  for (const auto& [query, type] : queries) {
    for (const char* const device : {"", "a", "b", "Needle", "Probe"}) {
      SCOPED_TRACE(std::string(query) + " " + device);
      client.send({.type = query, .device = device, .content = {}});
      bool any = false;
      for (const auto& one : kept) {
        if (std::string_view(one.first) != type || (*device != 0 && std::string_view(one.second) != device)) continue;
        any = true;
        const auto answer = client.next();
        ASSERT_TRUE(answer);
        EXPECT_EQ(answer->type, one.first);
        EXPECT_EQ(answer->device, one.second);
      }
      if (any) continue;
      const auto status = client.next();
      ASSERT_TRUE(status);
      ASSERT_EQ(status->type, "STATUS");
      EXPECT_EQ(status_of(status->content).text, std::string(query) + ": there is nothing to get");
    }
  }
}

TEST(OpenIgtServer, AddressesThatCannotBeListenedOnAreRefused) {
  const SteppedServer stepped;
  const int taken = stepped.server.port();
  EXPECT_THROW(Server({.port = taken}), Refusal);
  EXPECT_THROW(Server({.host = "203.0.113.7", .port = 0}), Refusal) << "no address of this machine";
  EXPECT_THROW(Server({.host = "no numbers", .port = 0}), Refusal);
  EXPECT_TRUE(stepped.server.is_local());
  EXPECT_FALSE(Server({.host = "0.0.0.0", .port = 0}).is_local());
}

}  // namespace
}  // namespace palpate::plugin::igtl

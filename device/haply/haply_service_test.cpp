// The driver and the service over a real socket of this machine, each in its own thread.

#include "device/haply/haply_service.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>

#include <chrono>
#include <cstdlib>
#include <functional>
#include <glm/geometric.hpp>
#include <string>
#include <thread>

#include "device/haply/haply.h"
#include "device/link/realtime.h"
#include "device/testing/haply_server.h"

namespace palpate::device {
namespace {

/// Ticks as a servo does, where that is allowed: on a busy machine one that is late by 20 ms takes the force away each
/// time, and the ramp begins anew.
class ServoHere {
 public:
  ServoHere() { make_thread_realtime(50); }
  ~ServoHere() {
    const sched_param none{};
    pthread_setschedparam(pthread_self(), SCHED_OTHER, &none);
  }
};

struct ServiceBench {
  ServoHere servo;
  HaplyServer server;
  std::unique_ptr<Stylus> stylus;

  explicit ServiceBench(const FakeHaply& service = {}) : server(service) {
    stylus = make_haply({.host = "127.0.0.1", .port = server.port(), .guarded = false});
  }
  /// Ticks with this force (N, device frame) until something holds, at most five seconds.
  bool comes(const Vec3& force, const std::function<bool()>& holds) {
    for (int ms = 0; ms < 5000 && !holds(); ++ms) {
      reading = stylus->read();
      stylus->write_force(force);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return holds();
  }
  bool pushes(const Vec3& force) {
    // Theirs: x right, y away from the user, z up.
    return comes(force, [&] { return glm::distance(server.acting(), Vec3(force.x, -force.z, force.y)) < 1e-4; });
  }
  Reading reading;
};

TEST(HaplyService, SpeaksBothFormatsOverTheSocket) {
  for (const int minor : {1, 5}) {
    FakeHaply service;
    service.version = {3, minor};
    service.spelling = minor == 1 ? "values" : "vector";
    service.place = {0.01, 0.02, 0.03};
    ServiceBench bench(service);
    bench.stylus->open();
    EXPECT_EQ(bench.stylus->specification().name, "Haply Inverse3");
    EXPECT_TRUE(bench.pushes(Vec3(0.1, 0.2, 0.3))) << minor;
    bench.reading = bench.stylus->read();
    EXPECT_LT(glm::distance(bench.reading.position, Vec3(0.01, 0.03, -0.02)), 1e-9);
    // On a busy machine the arm goes idle between two messages, and is told not to be ready until the next one.
    EXPECT_TRUE(bench.comes(Vec3(0), [&] { return bench.stylus->state() == State::idle; }));
    bench.stylus->close();
    EXPECT_TRUE(bench.comes(Vec3(0), [&] { return bench.server.acting() == Vec3(0); }));
  }
}

TEST(HaplyService, GoesIdleByItselfWhereNobodyAsks) {
  ServiceBench bench;
  const auto link = open_haply_service({.host = "127.0.0.1", .port = bench.server.port()});
  HaplyProtocol protocol({});
  protocol.connect(*link);
  std::vector<std::uint8_t> packet(protocol.packet_size());
  while (bench.server.acting() == Vec3(0)) {
    if (const std::size_t size = link->receive(packet, 0.005))
      protocol.receive(std::span(packet).first(size), link->now());
    if (const std::size_t due = protocol.step(Vec3(0, 1, 0), link->now(), packet))
      link->send(std::span(packet).first(due));
    EXPECT_TRUE(link->flush(1)) << "all has left";
  }
  while (bench.server.acting() != Vec3(0)) std::this_thread::yield();
}

/// Whatever the service does, the stylus ends in a fault, no force acts, and no tick waited for the socket.
TEST(HaplyService, WhateverItDoesEndsWithoutForceAndNoTickWaits) {
  const struct {
    const char* what;
    std::function<void(HaplyServer&)> cause;
  } cases[] = {{"drops the connection", [](HaplyServer& s) { s.drop(); }},
               {"stalls", [](HaplyServer& s) { s.stall(true); }},
               {"cuts its frames", [](HaplyServer& s) { s.cut_frames(true); }},
               {"says nonsense", [](HaplyServer& s) { s.with([](FakeHaply& f) { f.garbles = true; }); }},
               {"sends half messages", [](HaplyServer& s) { s.with([](FakeHaply& f) { f.halves = true; }); }},
               {"falls silent", [](HaplyServer& s) { s.with([](FakeHaply& f) { f.silent = true; }); }},
               {"loses the arm", [](HaplyServer& s) { s.with([](FakeHaply& f) { f.loses_device = true; }); }}};
  for (const auto& one : cases) {
    ServiceBench bench;
    bench.stylus->open();
    ASSERT_TRUE(bench.pushes(Vec3(0, 1, 0))) << one.what;
    one.cause(bench.server);
    double longest = 0;  // s of processor time in a tick: on a busy machine the clock tells of others
    const bool ended = bench.comes(Vec3(0, 1, 0), [&] {
      timespec begun{}, done{};
      clock_gettime(CLOCK_THREAD_CPUTIME_ID, &begun);
      bench.stylus->read();
      bench.stylus->write_force(Vec3(0, 1, 0));
      clock_gettime(CLOCK_THREAD_CPUTIME_ID, &done);
      longest = std::max(longest, static_cast<double>(done.tv_sec - begun.tv_sec) +
                                      1e-9 * static_cast<double>(done.tv_nsec - begun.tv_nsec));
      return bench.stylus->state() == State::fault;
    });
    EXPECT_TRUE(ended) << one.what;
    EXPECT_LT(longest, 2e-3) << one.what;
    EXPECT_TRUE(bench.comes(Vec3(0, 1, 0), [&] { return bench.server.acting() == Vec3(0); })) << one.what;
    bench.stylus->close();
  }
}

/// The guardian's zeros are zeros for as long as another session's force acts, which the service adds to its own.
TEST(HaplyService, ZerosAreSentUntilNoForceActs) {
  for (const bool other_acts : {false, true}) {
    FakeHaply service;
    const std::string force =
        R"({"inverse3": [{"commands": {"set_cursor_force": {"vector": {"x": 0, "y": 0.03, "z": 0}}}}]})";
    if (other_acts) service.answer(99, force, 1e12);  // it ends when the service does
    service.largest_n = 0;
    service.messages = 0;
    HaplyServer server(service);
    EXPECT_EQ(send_zeros_to_haply("049D@127.0.0.1:" + std::to_string(server.port())), !other_acts);
    server.with([&](FakeHaply& told) {
      EXPECT_EQ(told.largest_n, 0);
      EXPECT_GE(told.messages, other_acts ? 10 : 1);
    });
  }
}

TEST(HaplyService, ComesBackByConnectingAgain) {
  ServiceBench bench;
  bench.stylus->open();
  ASSERT_TRUE(bench.pushes(Vec3(0, 1, 0)));
  bench.server.drop();
  ASSERT_TRUE(bench.comes(Vec3(0, 1, 0), [&] { return bench.stylus->state() == State::fault; }));
  bench.stylus->open();
  EXPECT_TRUE(bench.pushes(Vec3(0, 0, 1)));
  EXPECT_EQ(bench.server.sessions(), 2);
}

TEST(HaplyService, TellsItsVersion) {
  FakeHaply service;
  service.version = {3, 1};
  const HaplyServer server(service);
  const auto link = open_haply_service({.host = "127.0.0.1", .port = server.port()});
  EXPECT_EQ(link->version().major, 3);
  EXPECT_EQ(link->version().minor, 1);
}

TEST(HaplyService, IsFoundWithItsSettings) {
  HaplyServer server;
  setenv("PALPATE_HAPLY", ("127.0.0.1:" + std::to_string(server.port())).c_str(), 1);
  const auto found = find_haply();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].address, "049D");
  EXPECT_THAT(found[0].note, ::testing::HasSubstr("gravity compensation on"));
  setenv("PALPATE_HAPLY", "nonsense", 1);
  EXPECT_EQ(haply_defaults().port, 10001);
  unsetenv("PALPATE_HAPLY");
}

}  // namespace
}  // namespace palpate::device

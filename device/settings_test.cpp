/// Every key of every kind's settings file sets what it is named after, and each limit is refused beyond itself.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <glm/geometric.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "device/device_type.h"
#include "device/falcon/falcon.h"
#include "device/force_dimension/force_dimension.h"
#include "device/haply/haply.h"
#include "device/haply/haply_service.h"
#include "device/messages.h"
#include "device/settings_file.h"
#include "device/testing/falcon_bench.h"
#include "device/testing/settings_rig.h"
#include "device/testing/wooden_haptics_bench.h"
#include "device/touch/touch.h"
#include "device/wooden_haptics/wooden_haptics.h"

namespace palpate::device {
namespace {

using settings_rig::file_of;
using settings_rig::Json;
using settings_rig::refusal_of;

/// Values that no default has.
const Json common{{"address", "one of many"}, {"maximum_force", 4.25},        {"stiffness_limit", 321.5},
                  {"guarded", false},         {"position_signs", {1, -1, 1}}, {"force_signs", {-1, 1, -1}}};

Json with(Json more) {
  Json json = common;
  json.update(more);
  return json;
}

template <typename Settings>
void expect_common(const Settings& settings) {
  EXPECT_EQ(settings.address, "one of many");
  EXPECT_EQ(settings.maximum_force, 4.25);
  EXPECT_EQ(settings.stiffness_limit, 321.5);
  EXPECT_FALSE(settings.guarded);
  EXPECT_EQ(settings.signs.position, Vec3(1, -1, 1));
  EXPECT_EQ(settings.signs.force, Vec3(-1, 1, -1));
}

/// A file without keys is that of a device as it comes: guarded, and with its axes as they are.
template <typename Settings>
void expect_defaults(const Settings& settings, const Settings& defaults) {
  EXPECT_EQ(settings.address, "");
  EXPECT_EQ(settings.maximum_force, defaults.maximum_force);
  EXPECT_EQ(settings.stiffness_limit, defaults.stiffness_limit);
  EXPECT_TRUE(settings.guarded);
  EXPECT_EQ(settings.signs.position, Vec3(1));
  EXPECT_EQ(settings.signs.force, Vec3(1));
}

TEST(Settings, EveryKeyOfEveryKindIsRead) {
  const FalconSettings falcon = read_falcon(file_of(with({{"firmware_file", "novint.bin"}, {"motor_gain", 12345.5}})));
  expect_common(falcon);
  EXPECT_EQ(falcon.firmware_file, "novint.bin");
  EXPECT_EQ(falcon.motor_gain, 12345.5);
  const HaplySettings haply = read_haply(file_of(with({{"host", "there"}, {"port", 1234}, {"preset", "mine"}})));
  expect_common(haply);
  EXPECT_EQ(haply.host, "there");
  EXPECT_EQ(haply.port, 1234);
  EXPECT_EQ(haply.preset, "mine");
  const ForceDimensionSettings omega = read_force_dimension(file_of(with({{"may_home", true}})));
  expect_common(omega);
  EXPECT_TRUE(omega.may_home);
  expect_common(read_touch(file_of(common)));
  const WoodenHapticsSettings arm = read_wooden_haptics(file_of(
      with({{"preset", "2015"}, {"continuous_current", 0.75}, {"short_reports", true}, {"stylus_button", true}})));
  expect_common(arm);
  EXPECT_EQ(arm.preset, "2015");
  EXPECT_EQ(arm.continuous_current, 0.75);
  EXPECT_TRUE(arm.short_reports);
  EXPECT_TRUE(arm.stylus_button);
}

TEST(Settings, AKeyThatIsAbsentKeepsItsDefault) {
  const std::string empty = file_of(Json::object());
  expect_defaults(read_falcon(empty), {.maximum_force = 8, .stiffness_limit = 1000});
  EXPECT_EQ(read_falcon(empty).motor_gain, 10000);
  expect_defaults(read_haply(empty), {.maximum_force = 3, .stiffness_limit = 400});
  EXPECT_EQ(read_haply(empty).preset, "arm_front_centered");
  expect_defaults(read_touch(empty), {.maximum_force = 0, .stiffness_limit = 0});
  expect_defaults(read_force_dimension(empty), {.maximum_force = 0, .stiffness_limit = 1500});
  EXPECT_FALSE(read_force_dimension(empty).may_home);
}

/// What a reader made of a file: the value of each member by its name.
template <typename Settings>
Json members_of(const Settings& s) {
  const auto list = [](const Vec3& v) { return Json::array({v.x, v.y, v.z}); };
  Json all{{"address", s.address}, {"maximum_force", s.maximum_force},         {"stiffness_limit", s.stiffness_limit},
           {"guarded", s.guarded}, {"position_signs", list(s.signs.position)}, {"force_signs", list(s.signs.force)}};
  if constexpr (std::is_same_v<Settings, FalconSettings>) {
    all.update(Json{{"firmware_file", s.firmware_file}, {"motor_gain", s.motor_gain}});
  } else if constexpr (std::is_same_v<Settings, HaplySettings>) {
    all.update(Json{{"host", s.host}, {"port", s.port}, {"events_port", s.events_port}, {"preset", s.preset}});
  } else if constexpr (std::is_same_v<Settings, ForceDimensionSettings>) {
    all.update(Json{{"may_home", s.may_home}});
  } else if constexpr (std::is_same_v<Settings, TouchSettings>) {
    all.update(Json{{"may_reset_encoders", s.may_reset_encoders}});
  } else {
    all.update(Json{{"short_reports", s.short_reports},
                    {"stylus_button", s.stylus_button},
                    {"continuous_current", s.continuous_current},
                    {"capstan_diameter", s.capstan_diameter},
                    {"body_diameter", s.body_diameter},
                    {"base_height", s.base_height},
                    {"lower_length", s.lower_length},
                    {"upper_length", s.upper_length},
                    {"origin", s.origin},
                    {"workspace_radius", s.workspace_radius},
                    {"torque_constant", s.torque_constant},
                    {"counts_per_turn", s.counts_per_turn},
                    {"encoder_sign", s.encoder_sign},
                    {"motor_aligned", s.motor_aligned},
                    {"home_counts", s.home_counts},
                    {"current_limit", s.current_limit}});
  }
  return all;
}

/// Whatever key a file has, it changes the member of its name, and no other.
TEST(Settings, EachKeyChangesItsOwnMemberAlone) {
  const auto check = [](auto read, const Json& base, const Json& values) {
    const Json before = members_of(read(file_of(base)));
    EXPECT_EQ(values.size(), before.size()) << "a value for each member";
    for (const auto& [key, value] : values.items()) {
      Json file = base, wanted = before;
      file[key] = wanted[key] = value;
      EXPECT_NE(wanted, before) << key;
      EXPECT_EQ(members_of(read(file_of(file))), wanted) << key;
    }
  };
  const Json none = Json::object();
  check(read_falcon, none, with({{"firmware_file", "novint.bin"}, {"motor_gain", 12345.5}}));
  check(read_haply, none, with({{"host", "there"}, {"port", 1234}, {"events_port", 4321}, {"preset", "mine"}}));
  check(read_force_dimension, none, with({{"may_home", true}}));
  check(read_touch, none, with({{"may_reset_encoders", true}}));
  check(read_wooden_haptics, {{"preset", "2015"}},
        with({{"short_reports", true},
              {"stylus_button", true},
              {"continuous_current", 0.75},
              {"capstan_diameter", {0.011, 0.012, 0.013}},
              {"body_diameter", {0.161, 0.122, 0.123}},
              {"base_height", 0.081},
              {"lower_length", 0.206},
              {"upper_length", 0.246},
              {"origin", {0.221, 0.001, 0.082}},
              {"workspace_radius", 0.101},
              {"torque_constant", {0.031, 0.032, 0.033}},
              {"counts_per_turn", {2001, 2002, 2003}},
              {"encoder_sign", {-1, 1, -1}},
              {"motor_aligned", {true, false, true}},
              {"home_counts", {11, 12, 13}},
              {"current_limit", 2.1}}));
}

/// What a refusal or a hint tells to write into a settings file is what the file may have.
TEST(Settings, AKeyThatIsAskedForIsTaken) {
  const std::map<std::string, std::function<void(const std::string&)>> readers{
      {"3D Systems Touch", read_touch}, {"Force Dimension", read_force_dimension}};
  const std::string before_key = "allow it in its settings file: ";
  int asked = 0;
  for (const MessageRow& row : messages::styluses) {
    for (const Message& message : row.messages) {
      const std::string text(message.text);
      const std::size_t at = text.find(before_key);
      if (at == std::string::npos) continue;
      const std::size_t key = at + before_key.size();
      const auto reader = readers.find(text.substr(0, text.find(':')));
      ASSERT_NE(reader, readers.end()) << text;
      const std::string file = file_of({{text.substr(key, text.find(',', key) - key), true}});
      EXPECT_EQ(refusal_of([&] { reader->second(file); }), "") << text;
      ++asked;
    }
  }
  EXPECT_EQ(asked, 2);
  const std::string_view hint = find_device_type("force_dimension")->file_hint;
  const std::size_t from = hint.find('"') + 1;
  const std::string hinted(hint.substr(from, hint.find('"', from) - from));
  EXPECT_TRUE(read_force_dimension(file_of({{hinted, true}})).may_home);
}

/// A key that no kind has, a value of another type, a sign that is none, no object, no JSON and no file: each is
/// refused by every kind, in its name and with the file's.
TEST(Settings, WhatIsNoSettingIsRefusedByEveryKind) {
  const std::pair<const char*, std::function<void(const std::string&)>> kinds[] = {
      {"Novint Falcon", read_falcon},
      {"Haply", read_haply},
      {"3D Systems Touch", read_touch},
      {"Force Dimension", read_force_dimension},
      {"WoodenHaptics", read_wooden_haptics}};
  const std::pair<Json, const char*> wrong[] = {
      {{{"color", 3}}, "'color' is not a setting"},
      {{{"maximum_force", "much"}}, "'maximum_force' has an invalid value: \"much\""},
      {{{"guarded", 3}}, "'guarded' has an invalid value"},
      {{{"position_signs", {1, 0, 1}}}, "'position_signs' is not three times 1 or -1"},
      {{{"force_signs", {1, 1, 0.5}}}, "'force_signs' is not three times 1 or -1"},
      {{{"force_signs", {-2, 1, 1}}}, "'force_signs' is not three times 1 or -1"},
      {{{"force_signs", {1, 1}}}, "'force_signs' has an invalid value"},
      {Json::array(), "it is not a JSON object"}};
  for (const auto& [name, read] : kinds) {
    for (const auto& [json, why] : wrong) {
      Json settings = json;
      if (settings.is_object() && name == std::string("WoodenHaptics")) settings["preset"] = "2015";
      const std::string file = file_of(settings);
      const std::string said = refusal_of([&, &read = read] { read(file); });
      EXPECT_THAT(said, ::testing::StartsWith(std::string(name) + ": " + file + ": ")) << why;
      EXPECT_THAT(said, ::testing::HasSubstr(why));
    }
    EXPECT_EQ(refusal_of([&, &read = read] { read("/absent.json"); }),
              std::string(name) + ": /absent.json cannot be read; name the file of its settings");
    const TestFiles files;
    EXPECT_NE(refusal_of([&, &read = read] { read(files.write("half.json", "{\"address\": ")); }), "");
  }
}

/// Each number at its limit and just beyond.
TEST(Settings, EachLimitIsReached) {
  const auto falcon = [](const char* key, double value) {
    return refusal_of([&] { read_falcon(file_of({{key, value}})); }).empty();
  };
  const auto arm = [](const Json& json) {
    Json settings{{"preset", "2015"}};
    settings.update(json);
    return refusal_of([&] { read_wooden_haptics(file_of(settings)); }).empty();
  };
  for (const char* const key : {"maximum_force", "stiffness_limit"}) {
    EXPECT_TRUE(falcon(key, 1e-9)) << key;
    EXPECT_FALSE(falcon(key, 0)) << key;
    EXPECT_FALSE(falcon(key, -1)) << key;
  }
  const std::pair<const char*, double> most[] = {{"workspace_radius", 1}, {"current_limit", 3}};
  for (const auto& [key, value] : most) {
    EXPECT_TRUE(arm({{key, value}})) << key;
    EXPECT_FALSE(arm({{key, value + 0.01}})) << key;
    EXPECT_FALSE(arm({{key, 0}})) << key;
  }
  for (const char* const key : {"workspace_radius", "maximum_force", "stiffness_limit"}) {
    EXPECT_TRUE(arm({{key, 1e-9}})) << key;
    EXPECT_FALSE(arm({{key, -1e-9}})) << key;
  }
  EXPECT_TRUE(arm({{"current_limit", 1.5}, {"continuous_current", 1.5}}));
  EXPECT_FALSE(arm({{"current_limit", 1.5}, {"continuous_current", 1.51}}));
  EXPECT_TRUE(arm({{"continuous_current", 1e-9}}));
  EXPECT_FALSE(arm({{"continuous_current", 0}}));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto of_axis = [&](const char* key, Json values, const Json& value) {
      values[axis] = value;
      return arm({{key, values}});
    };
    for (const int sign : {1, -1}) EXPECT_TRUE(of_axis("encoder_sign", {1, 1, 1}, sign));
    for (const int sign : {0, 2, -2}) EXPECT_FALSE(of_axis("encoder_sign", {1, 1, 1}, sign));
    for (const int counts : {-32768, 32767}) EXPECT_TRUE(of_axis("home_counts", {0, 0, 0}, counts));
    for (const int counts : {-32769, 32768}) EXPECT_FALSE(of_axis("home_counts", {0, 0, 0}, counts));
  }
}

/// No settings file raises a force or a stiffness beyond what its device can do, or what the chain allows. Each is
/// refused by its name, by every kind; 0 means the device's own figure where a device tells one.
TEST(Settings, NoLimitIsRaisedBeyondItsCeiling) {
  using Read = void (*)(const std::string&);
  const struct {
    const char* name;
    Read read;
    double force_n, stiffness_n_per_m;
    bool tells_force, tells_stiffness;
  } kinds[] = {{"Novint Falcon", [](const std::string& file) { read_falcon(file); }, 8, 3000, false, false},
               {"Haply", [](const std::string& file) { read_haply(file); }, 12, 3000, false, false},
               {"3D Systems Touch", [](const std::string& file) { read_touch(file); }, 7.9, 2350, true, true},
               {"Force Dimension", [](const std::string& file) { read_force_dimension(file); }, 12, 3000, true, false},
               {"WoodenHaptics", [](const std::string& file) { read_wooden_haptics(file); }, 12, 3000, false, false}};
  for (const auto& kind : kinds) {
    const auto said = [&](const char* key, double value) {
      Json json{{key, value}};
      if (kind.name == std::string("WoodenHaptics")) json["preset"] = "2015";
      return refusal_of([&] { kind.read(file_of(json)); });
    };
    const struct {
      const char* key;
      const char* words;
      double most;
      bool may_be_zero;
    } limits[] = {
        {"maximum_force", "the largest force lies between 0 and ", kind.force_n, kind.tells_force},
        {"stiffness_limit", "the stiffness limit lies between 0 and ", kind.stiffness_n_per_m, kind.tells_stiffness}};
    for (const auto& limit : limits) {
      for (const double within : {1e-9, limit.most}) EXPECT_EQ(said(limit.key, within), "") << kind.name;
      EXPECT_EQ(said(limit.key, 0) == "", limit.may_be_zero) << kind.name << limit.key;
      for (const double beyond : {-1e-9, 1.001 * limit.most, 1e5, 1e9}) {
        EXPECT_THAT(said(limit.key, beyond), ::testing::StartsWith(kind.name));
        EXPECT_THAT(said(limit.key, beyond), ::testing::HasSubstr(limit.words));
      }
    }
  }
}

/// Nor does a program that makes a stylus.
TEST(Settings, NoStylusIsMadeWithALimitBeyondItsCeiling) {
  EXPECT_EQ(refusal_of([] { make_touch({.maximum_force = 8}); }),
            "3D Systems Touch: the largest force lies between 0 and 7.9 N");
  EXPECT_EQ(refusal_of([] { make_touch({.stiffness_limit = 1e9}); }),
            "3D Systems Touch: the stiffness limit lies between 0 and 2350 N/m");
  EXPECT_EQ(refusal_of([] { make_force_dimension({.maximum_force = 1e5}); }),
            "Force Dimension: the largest force lies between 0 and 12 N");
  EXPECT_EQ(refusal_of([] { make_haply({.maximum_force = 1e5}); }), "Haply: the largest force lies between 0 and 12 N");
  EXPECT_EQ(refusal_of([] { make_falcon({.maximum_force = 12}); }),
            "Novint Falcon: the largest force lies between 0 and 8 N");
}

/// What is chosen beside a settings file goes before it; without one the kind's defaults hold.
TEST(Settings, WhatIsChosenGoesBeforeTheFile) {
  struct Noted {
    std::string address, firmware_file;
    int other = 0;
  };
  static Noted made;
  const auto make = +[](const Noted& settings) {
    made = settings;
    return std::unique_ptr<Stylus>();
  };
  const auto read = +[](const std::string& file) { return Noted{"of " + file, "its own", 2}; };
  const struct {
    DeviceChoice choice;
    Noted wanted;
  } cases[] = {{{}, {"default", "none", 1}},
               {{.address = "A"}, {"A", "none", 1}},
               {{.firmware = "F"}, {"default", "F", 1}},
               {{.settings = "S"}, {"of S", "its own", 2}},
               {{.address = "A", .settings = "S"}, {"A", "its own", 2}},
               {{.firmware = "F", .settings = "S"}, {"of S", "F", 2}}};
  for (const auto& one : cases) {
    make_with_settings<Noted>(one.choice, read, make, {"default", "none", 1});
    EXPECT_EQ(made.address, one.wanted.address);
    EXPECT_EQ(made.firmware_file, one.wanted.firmware_file);
    EXPECT_EQ(made.other, one.wanted.other);
  }
}

/// "HOST:PORT"; what is none leaves the service where it usually is.
TEST(Settings, TheHaplysServiceIsWhereTheEnvironmentSays) {
  const struct {
    const char* named;
    const char* host;
    int port;
  } places[] = {{"there:1", "there", 1},
                {"there:65535", "there", 65535},
                {"::1:4000", "::1", 4000},
                {"there:0", "localhost", 10001},
                {"there:65536", "localhost", 10001},
                {":4000", "localhost", 10001},
                {"there", "localhost", 10001},
                {"there:4000x", "localhost", 10001},
                {"there:", "localhost", 10001},
                {"there:-1", "localhost", 10001},
                {"", "localhost", 10001}};
  for (const auto& place : places) {
    setenv("PALPATE_HAPLY", place.named, 1);
    EXPECT_EQ(haply_defaults().host, place.host) << place.named;
    EXPECT_EQ(haply_defaults().port, place.port) << place.named;
    EXPECT_EQ(read_haply(file_of(Json::object())).port, place.port);
  }
  unsetenv("PALPATE_HAPLY");
  EXPECT_EQ(haply_defaults().port, 10001);
}

}  // namespace
}  // namespace palpate::device

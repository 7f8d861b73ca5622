// The wind tunnel as a scan: a 4D-flow study on disk, felt through the program, against the flow itself.
#include <gtest/gtest.h>

#include <filesystem>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "plugin/testing/command_rig.h"
#include "testdata/write_flow.h"

namespace palpate::plugin {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using testdata::Vec3;

std::string output_of(const std::string& arguments) {
  const testing::Outcome outcome = testing::palpate(arguments, false);
  EXPECT_EQ(outcome.exit, 0) << arguments;
  return outcome.output;
}

TEST(FlowStudy, IsFeltAsTheFlowItWasMadeOf) {
  const fs::path folder = testing::fresh_path("flow_study");
  testdata::FlowStudy study;
  study.grid.size = {52, 44, 20};
  study.grid.spacing = Vec3(2);
  study.times = 4;
  study.flow.free_stream = {0.8, 0, 0};
  testdata::write_flow_study(study, folder);

  const Json info = Json::parse(output_of("info --json " + folder.string()));
  ASSERT_EQ(info.at("series").size(), 4U);
  ASSERT_EQ(info.at("velocity_fields").size(), 1U);
  EXPECT_EQ(info.at("velocity_fields").at(0).at("unit"), "m/s");
  EXPECT_EQ(info.at("velocity_fields").at(0).at("frames_per_position"), 4);

  // Past the sphere, at the second time point: the free stream is at its strongest there.
  const Json felt = Json::parse(output_of("profile " + folder.string() +
                                          " --series 5 --frame 1 --scene flow --from=-45,25,3 --to=45,38,3 --json"));
  testdata::FlowPastSphere now = study.flow;
  now.free_stream = free_stream_at(study, 1);
  const testdata::FlowSource exact(now);
  const auto vector_of = [](const Json& json) { return Vec3(json.at(0), json.at(1), json.at(2)); };
  const std::size_t count = felt.at("force_n").size();
  ASSERT_GT(count, 100U);
  for (std::size_t n = count / 10; n < count; ++n) {
    const Vec3 velocity = exact.sample(vector_of(felt.at("proxy_mm").at(n)), io::FieldSet::vector).vector;
    const double speed = glm::length(velocity);
    ASSERT_GT(speed, 0.1);
    // The scene pushes with 0.3 N at 1 m/s, along the flow; its line acts across it alone.
    const double pushed = glm::dot(vector_of(felt.at("force_n").at(n)), velocity / speed);
    EXPECT_NEAR(pushed, 0.3 * speed, 0.02) << n;
  }
}

}  // namespace
}  // namespace palpate::plugin

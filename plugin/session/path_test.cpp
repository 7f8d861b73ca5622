#include "plugin/session/path.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <stdexcept>

#include "plugin/testing/test_files.h"

namespace palpate::plugin {
namespace {

std::filesystem::path write(const std::string& name, const std::string& text) {
  const auto file = testing::fresh_path(name);
  std::ofstream(file) << text;
  return file;
}

std::string refusal(const std::string& text) {
  try {
    read_path_csv(write("refused.csv", text));
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "accepted";
}

TEST(PathCsv, ReadsPointsWithHeaderCommentsAndCarriageReturns) {
  const auto path = read_path_csv(write("path.csv", "time_s,x_mm,y_mm,z_mm\r\n# down\n0, 1,-2.5,3e1\r\n0.5,1,2,3\n\n"));
  ASSERT_EQ(path.size(), 2U);
  EXPECT_EQ(path[0].position_mm, glm::dvec3(1, -2.5, 30));
  EXPECT_EQ(path[1].time_s, 0.5);
}

TEST(PathCsv, RefusesNamingFileAndLine) {
  EXPECT_THAT(refusal("0,1,2\n"),
              ::testing::AllOf(::testing::HasSubstr("refused.csv"), ::testing::HasSubstr("line 1")));
  EXPECT_THAT(refusal("0,1,2,3\n1,2,3,nan\n"), ::testing::HasSubstr("line 2"));
  EXPECT_THAT(refusal("0,1,2,3\n0,2,3,4\n"), ::testing::HasSubstr("line 2: time_s 0"));
  EXPECT_THAT(refusal("0,1,2,3,4\n"), ::testing::HasSubstr("line 1"));
  EXPECT_THAT(refusal("0,1,2,3\n"), ::testing::HasSubstr("at least two points"));
  EXPECT_THAT(refusal(""), ::testing::HasSubstr("at least two points"));
  EXPECT_THROW(read_path_csv("/no/such/path.csv"), std::runtime_error);
}

}  // namespace
}  // namespace palpate::plugin

#include "plugin/session/path.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <stdexcept>

#include "io/archive/testing/says.h"
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

TEST(PathWithButtons, IsReadByItsHeader) {
  const auto path = read_path_csv(write("buttons.csv", "time_s,x_mm,y_mm,z_mm,buttons\n0,1,2,3,0\n1,1,2,3,2\n"));
  ASSERT_EQ(path.size(), 2U);
  EXPECT_EQ(path[1].buttons, 2U);
  EXPECT_EQ(path[1].position_mm.z, 3);
  for (const char* const wrong : {"-1", "1.5", "65536"}) {
    const std::string text = std::string("time_s,x_mm,y_mm,z_mm,buttons\n0,1,2,3,0\n1,1,2,3,") + wrong + "\n";
    try {
      read_path_csv(write("no-buttons.csv", text));
      ADD_FAILURE() << wrong;
    } catch (const std::runtime_error& error) {
      EXPECT_TRUE(io::testing::says(error.what(),
                                    "{}, line {}: buttons {} is no bit mask: 0 is none, 1 the first, 2 the second"));
    }
  }
  EXPECT_THROW(read_path_csv(write("short.csv", "time_s,x_mm,y_mm,z_mm,buttons\n0,1,2,3\n1,1,2,3\n")),
               std::runtime_error);
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
  try {
    read_path_csv("/no/such/path.csv");
    FAIL() << "read";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "cannot open the path file /no/such/path.csv; check its name, and that you may read it");
  }
}

/// Each limit of a line reached from both sides.
TEST(PathCsv, TakesWhatIsJustWithinItsLimits) {
  const std::string head = "time_s,x_mm,y_mm,z_mm,buttons\n";
  EXPECT_EQ(refusal(head + "0,1,2,3,65535\n1e-9,1,2,3,0\n"), "accepted");
  EXPECT_THAT(refusal("-0.1,1,2,3\n1,1,2,3\n"), ::testing::HasSubstr("line 1: time_s -0.1"));
  EXPECT_THAT(refusal("0,1,2,3\n2,1,2,3\n1,1,2,3\n"), ::testing::HasSubstr("line 3: time_s 1"));
  for (const char* const wrong : {"inf", "-inf", "nan", "1x", "", "1 2"}) {
    for (const char* const line : {"{},1,2,3", "5,{},2,3", "5,1,{},3", "5,1,2,{}"}) {
      std::string text = line;
      text.replace(text.find("{}"), 2, wrong);
      EXPECT_THAT(refusal("0,1,2,3\n" + text + "\n"), ::testing::HasSubstr("line 2")) << text;
    }
  }
  EXPECT_THAT(refusal("0,1,2,3\ntime_s,x_mm,y_mm,z_mm\n1,1,2,3\n"), ::testing::HasSubstr("line 2"));
}

}  // namespace
}  // namespace palpate::plugin

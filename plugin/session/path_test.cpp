#include "plugin/session/path.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

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
    for (const int comments : {0, 1, 4}) {
      std::string text = "time_s,x_mm,y_mm,z_mm,buttons\n0,1,2,3,0\n";
      for (int n = 0; n < comments; ++n) text += n % 2 == 0 ? "# and then\n" : "\n";
      text += std::string("1,1,2,3,") + wrong + "\n";
      const auto file = write("no-buttons.csv", text);
      try {
        read_path_csv(file);
        ADD_FAILURE() << wrong;
      } catch (const std::runtime_error& error) {
        EXPECT_EQ(error.what(),
                  fmt::format("{}, line {}: buttons {} is no bit mask: 0 is none, 1 the first, 2 the second",
                              file.string(), 3 + comments, wrong));
      }
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

/// Whatever the numbers, the spaces, the comments and the line ends of a table, it reads back to the last bit; and what
/// is wrong is named by its line.
TEST(PathCsv, ReadsBackWhatWasWritten) {
  std::mt19937_64 random(3);
  const auto one_of = [&](const std::vector<std::string>& all) { return all[random() % all.size()]; };
  for (int table = 0; table < 100; ++table) {
    const bool with_buttons = table % 2 == 0;
    const std::string end = one_of({"\n", "\r\n"});
    std::string text = with_buttons     ? "time_s,x_mm,y_mm,z_mm,buttons" + end
                       : table % 3 == 0 ? " time_s,x_mm,y_mm,z_mm" + end
                                        : "";
    std::vector<PathPoint> wanted;
    std::vector<std::size_t> lines;  // of each point, from 1
    std::uniform_real_distribution<double> number(-200, 200), step(1e-3, 2);
    double time_s = table % 5 == 0 ? 0 : step(random);
    const std::size_t points = 2 + random() % 9;
    std::string spoiled = text;
    const std::size_t bad = random() % points;
    for (std::size_t n = 0; n < points; ++n, time_s += step(random)) {
      if (!text.empty()) {
        for (auto more = random() % 3; more > 0; --more) {
          const std::string between = one_of({"# 1,2,3,4", "", "   \t", "  # x"}) + end;
          text += between;
          spoiled += between;
        }
      }
      const PathPoint point{time_s,
                            {number(random), number(random), number(random)},
                            with_buttons ? static_cast<std::uint32_t>(random() % 65536) : 0};
      std::string line;
      for (const double cell : {point.time_s, point.position_mm.x, point.position_mm.y, point.position_mm.z}) {
        line += (line.empty() ? "" : ",") + one_of({"", " ", "\t "}) + fmt::format("{}", cell) + one_of({"", "  "});
      }
      if (with_buttons) line += fmt::format(", {}", point.buttons);
      wanted.push_back(point);
      lines.push_back(static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')) + 1);
      text += line + end;
      spoiled += (n == bad ? line + ",1" : line) + end;
    }
    const std::vector<PathPoint> read = read_path_csv(write("random.csv", text));
    ASSERT_EQ(read.size(), wanted.size()) << text;
    for (std::size_t n = 0; n < read.size(); ++n) {
      ASSERT_EQ(read[n].time_s, wanted[n].time_s);
      ASSERT_EQ(read[n].position_mm, wanted[n].position_mm);
      ASSERT_EQ(read[n].buttons, wanted[n].buttons);
    }
    const auto file = write("spoiled.csv", spoiled);
    try {
      read_path_csv(file);
      FAIL() << spoiled;
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(error.what(), fmt::format("{}, line {}: not four finite numbers; expected time_s,x_mm,y_mm,z_mm",
                                          file.string(), lines[bad]));
    }
  }
}

}  // namespace
}  // namespace palpate::plugin

// Marks of the panel and of clients: those that one side changes change on the other, and none is lost.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "plugin/openigtlink/names.h"
#include "plugin/paraview/client/model/testing/sharing_rig.h"

namespace palpate::plugin {
namespace {

using igtl::testing::TestClient;
using testing::comes;
using testing::SharingTest;

/// A list of marks may be older than the last press here: what it leaves out stays.
TEST_F(SharingTest, MarksGoBothWaysAndNoneIsLost) {
  open_scan();
  FeltMark felt;
  felt.name = "Mark 1";
  felt.boundary = "skin";
  felt.position_mm = {1, 2, 3};
  felt.value = 40;
  marks.edit(QStringLiteral("Mark"), [&](Marks& now) { now.points.push_back(felt); });
  ASSERT_EQ(sharing.turn_on(0).toStdString(), "");
  TestClient client(sharing.port());
  std::vector<igtl::Point> points;
  ASSERT_TRUE(comes([&] {
    if (const auto sent = next(client, "POINT", igtl::marks_name)) points = igtl::points_of(sent->content);
    return points.size() == 1;
  }));
  EXPECT_EQ(points[0].name, "Mark 1");
  EXPECT_EQ(points[0].group, "skin");
  EXPECT_LT(glm::distance(points[0].position, glm::dvec3(-1, -2, 3)), 1e-4) << "RAS";
  client.send(
      {.type = "POINT",
       .device = igtl::marks_name,
       .content = igtl::content_of(std::vector<igtl::Point>{{.name = "from Slicer", .position = {-4, -5, 6}}})});
  ASSERT_TRUE(comes([&] { return marks.marks().points.size() == 2; }));
  EXPECT_EQ(marks.marks().points[0].boundary, "skin");
  EXPECT_EQ(marks.marks().points[0].value, 40);
  EXPECT_EQ(marks.marks().points[1].name, "from Slicer");
  EXPECT_TRUE(std::isnan(marks.marks().points[1].value)) << "nobody felt there: 0 HU would be water";
  EXPECT_LT(glm::distance(marks.marks().points[1].position_mm, glm::dvec3(4, 5, 6)), 1e-4);
  // One that is moved there is no longer where it was felt.
  points[0].position.x += 1;
  client.send({.type = "POINT", .device = igtl::marks_name, .content = igtl::content_of(points)});
  ASSERT_TRUE(comes([&] { return marks.marks().points[0].position_mm.x < 0.5; }));
  EXPECT_EQ(marks.marks().points[0].boundary, "");
  EXPECT_TRUE(std::isnan(marks.marks().points[0].value));
  EXPECT_EQ(marks.marks().points.size(), 2U);
  for (const FeltMark& one : marks_of_text(kept.text("Marks")).at("a scan").points) {
    EXPECT_TRUE(std::isnan(one.value)) << one.name << ": so it is kept, too";
  }
}

/// Two may have one name, and a long name comes back cut: each keeps what was felt there.
TEST_F(SharingTest, MarksThatAreOnlySentBackStayAsTheyWereFelt) {
  open_scan();
  const std::string long_name = std::string(63, 'n') + "\u00e4 and more";
  marks.edit(QStringLiteral("Mark"), [&](Marks& now) {
    for (const std::string& name : {std::string("edge"), std::string("edge"), long_name}) {
      const auto n = static_cast<double>(now.points.size());
      FeltMark felt;
      felt.name = name;
      felt.boundary = "skin";
      felt.position_mm = {n, 0, 0};
      felt.value = 40 + n;
      felt.force_n = 1 + n;
      now.points.push_back(felt);
    }
  });
  ASSERT_EQ(sharing.turn_on(0).toStdString(), "");
  TestClient client(sharing.port());
  std::vector<igtl::Point> points;
  ASSERT_TRUE(comes([&] {
    if (const auto sent = next(client, "POINT", igtl::marks_name)) points = igtl::points_of(sent->content);
    return points.size() == 3;
  }));
  std::vector<igtl::Point> back(points.rbegin(), points.rend());
  back.push_back({.name = "last", .position = {0, 1, 0}});
  client.send({.type = "POINT", .device = igtl::marks_name, .content = igtl::content_of(back)});
  ASSERT_TRUE(comes([&] { return marks.marks().points.size() == 4; }));
  for (std::size_t n = 0; n < 3; ++n) {
    const FeltMark& felt = marks.marks().points[n];
    EXPECT_EQ(felt.name, n < 2 ? "edge" : long_name);
    EXPECT_EQ(felt.boundary, "skin");
    EXPECT_EQ(felt.position_mm.x, static_cast<double>(n));
    EXPECT_EQ(felt.value, 40 + static_cast<double>(n));
    EXPECT_EQ(felt.force_n, 1 + static_cast<double>(n));
  }
  // Each that is moved there is the one that is moved here.
  back[0].position.x = -10;
  back[1].position.x = -11;
  client.send({.type = "POINT", .device = igtl::marks_name, .content = igtl::content_of(back)});
  ASSERT_TRUE(comes([&] { return marks.marks().points[2].position_mm.x == 10; }));
  EXPECT_EQ(marks.marks().points.size(), 4U);
  EXPECT_EQ(marks.marks().points[2].name, long_name);
  EXPECT_EQ(marks.marks().points[1].position_mm.x, 11);
  EXPECT_EQ(marks.marks().points[0].value, 40);
}

TEST_F(SharingTest, AMarkWithoutANameGetsOneThatIsFree) {
  open_scan();
  marks.edit(QStringLiteral("Mark"), [](Marks& now) { now.points.push_back({.name = "Mark 1"}); });
  ASSERT_EQ(sharing.turn_on(0).toStdString(), "");
  TestClient client(sharing.port());
  client.send({.type = "POINT",
               .device = igtl::marks_name,
               .content = igtl::content_of(std::vector<igtl::Point>{{.position = {1, 0, 0}}})});
  ASSERT_TRUE(comes([&] { return marks.marks().points.size() == 2; }));
  EXPECT_EQ(marks.marks().points[1].name, "Mark 2");
  // The same list again is no step; the one after it tells that it came.
  const std::size_t steps = kept.steps.size();
  std::vector<igtl::Point> known{{.name = "Mark 2", .position = {1, 0, 0}}};
  client.send({.type = "POINT", .device = igtl::marks_name, .content = igtl::content_of(known)});
  known.push_back({.name = "last", .position = {0, 1, 0}});
  client.send({.type = "POINT", .device = igtl::marks_name, .content = igtl::content_of(known)});
  ASSERT_TRUE(comes([&] { return marks.marks().points.size() == 3; }));
  EXPECT_EQ(kept.steps.size(), steps + 1);
}

}  // namespace
}  // namespace palpate::plugin

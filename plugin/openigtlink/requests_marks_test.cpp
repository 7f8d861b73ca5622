// Marks of clients and of the stylus in a session of `palpate serve`, over scans and lists.

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "plugin/openigtlink/names.h"
#include "plugin/openigtlink/testing/asked_session.h"
#include "plugin/recording/marks.h"

namespace palpate::plugin::igtl {
namespace {

using testing::sent_n;
using testing::SharedSession;
using testing::TestClient;

struct Whose {
  std::string frame_of_reference, id, name;
  double middle_mm = 0;  // where the scan's middle lies
};

std::shared_ptr<const io::Volume> ball_of(const Whose& whose) {
  const io::Geometry geometry = testdata::make_geometry({.size = glm::ivec3(60), .center = {0, 0, whose.middle_mm}});
  io::Volume volume = testdata::scan(testdata::make_sphere(25), geometry);
  volume.frame_of_reference_uid = whose.frame_of_reference;
  volume.patient_id = whose.id;
  volume.patient_name = whose.name;
  return std::make_shared<const io::Volume>(std::move(volume));
}

/// The names of the marks that a client gets who comes now.
std::vector<std::string> names_there(const SharedSession& shared) {
  TestClient late(shared.server.port());
  std::vector<std::string> names;
  const auto message = late.next("POINT", marks_name);
  if (!message) return {"no list came"};
  for (const Point& point : points_of(message->content)) names.push_back(point.name);
  return names;
}

using Names = std::vector<std::string>;

bool is_soon(SharedSession& shared, const Names& names) {
  return shared.comes([&] { return names_there(shared) == names; });
}

void send_marks(TestClient& client, const std::vector<Point>& marks) {
  client.send({.type = "POINT", .device = marks_name, .content = content_of(marks)});
}

/// A session on the first of two scans; a client sends a mark, and then the folder of the second.
struct TwoScans {
  TwoScans(const Whose& first, const Whose& second) {
    shared.session.set_scan(ball_of(first));
    shared.load = [second](const std::string&) { return LoadedScan{.volume = ball_of(second), .frame = {}}; };
    shared.look();
    send_marks(client, {{.name = "vessel", .position = {1, 2, 3}}});
    EXPECT_TRUE(is_soon(shared, {"vessel"}));
  }
  void send_folder() {
    const auto before = shared.session.scan();
    client.send_text(folder_name, "/scans/second");
    EXPECT_TRUE(shared.comes([&] { return shared.session.scan() != before; }));
    shared.look();
  }

  SharedSession shared;
  TestClient client{shared.server.port()};
};

const Whose one{"1.2", "7", "Doe^Jane"};

/// A place in one patient is none in another.
TEST(OpenIgtMarksOfScans, MarksGoWithTheirPatientAndStayOnOtherScansOfIt) {
  const std::pair<Whose, bool> cases[] = {{one, true},
                                          {{"1.2", "7", "Doe^Jane", -5}, true},
                                          {{"1.3", "7", "Doe^Jane"}, false},
                                          {{"1.2", "8", "Doe^Jane"}, false},
                                          {{"1.2", "7", "Roe^Jane"}, false},
                                          {{"", "7", "Doe^Jane"}, false}};
  for (const auto& [second, stays] : cases) {
    SCOPED_TRACE(second.frame_of_reference + " " + second.id + " " + second.name);
    TwoScans scans(one, second);
    scans.send_folder();
    EXPECT_EQ(names_there(scans.shared), stays ? Names{"vessel"} : Names{});
  }
}

/// Where nothing says whose the scans are, another one may be of anybody. Another scene on the same scan is no other
/// scan.
TEST(OpenIgtMarksOfScans, OfScansWithoutAFrameOfReferenceEachIsAnother) {
  TwoScans scans({"", "", ""}, {"", "", ""});
  modes::Scene scene = scans.shared.session.scene();
  scene.name = "another";
  scans.shared.session.set_scene(scene);
  scans.shared.look();
  EXPECT_EQ(names_there(scans.shared), Names{"vessel"});
  scans.send_folder();
  EXPECT_EQ(names_there(scans.shared), Names{});
}

/// A client need not wait until the folder is read.
TEST(OpenIgtMarksOfScans, MarksThatAreSentAfterTheFolderAreOfItsScan) {
  TwoScans scans(one, {"1.3", "8", "Roe^Jane"});
  scans.client.send_text(folder_name, "/scans/second");
  send_marks(scans.client, {{.name = "stone", .position = {4, 5, 6}}});
  EXPECT_TRUE(is_soon(scans.shared, {"stone"}));
  EXPECT_EQ(scans.shared.session.scan()->patient_id, "8");
}

/// A press is of one scan: one that ended on the scan before and was not read yet, or that goes on, makes no mark.
TEST(OpenIgtMarksOfScans, APressOnThePatientBeforeMakesNoMark) {
  for (const bool goes_on : {false, true}) {
    SCOPED_TRACE(goes_on);
    SharedSession shared;
    ASSERT_TRUE(shared.comes([&] { return sent_n(shared) > 0.3; }));
    shared.session.press(mark_button);
    std::this_thread::sleep_for(std::chrono::milliseconds(40));
    if (!goes_on) {
      shared.session.press(0);
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    shared.session.set_scan(ball_of({"1.3", "8", "Roe^Jane"}));
    shared.look_for(std::chrono::milliseconds(200));
    shared.session.press(0);
    shared.look_for(std::chrono::milliseconds(200));
    EXPECT_EQ(names_there(shared), Names{});
    shared.session.press(mark_button);
    shared.look_for(std::chrono::milliseconds(50));
    shared.session.press(0);
    EXPECT_TRUE(is_soon(shared, {"Mark 1"})) << "the next press is of this one";
  }
}

/// Clients may give two marks one name. The list comes back as it went, and one of them is moved.
TEST(OpenIgtMarksOfScans, TwoOfOneNameAreMovedOneByOne) {
  SharedSession shared;
  TestClient client(shared.server.port());
  std::vector<Point> marks{{.name = "edge", .position = {1, 0, 0}}, {.name = "edge", .position = {2, 0, 0}}};
  send_marks(client, marks);
  ASSERT_TRUE(is_soon(shared, {"edge", "edge"}));
  marks[1].position.x = 5;
  std::swap(marks[0], marks[1]);
  marks.push_back({.name = "last", .position = {0, 1, 0}});
  send_marks(client, marks);
  ASSERT_TRUE(is_soon(shared, {"edge", "edge", "last"}));
  TestClient late(shared.server.port());
  const auto message = late.next("POINT", marks_name);
  ASSERT_TRUE(message);
  const std::vector<Point> there = points_of(message->content);
  EXPECT_EQ(there.at(0).position.x, 1);
  EXPECT_EQ(there.at(1).position.x, 5);
}

}  // namespace
}  // namespace palpate::plugin::igtl

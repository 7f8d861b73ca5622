// Lists of marks that clients send.

#include "plugin/openigtlink/marks.h"

#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "plugin/openigtlink/say.h"

namespace palpate::plugin::igtl {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

Point at(const std::string& name, double x) {
  return {.name = name, .position = {x, 0, 0}};
}

/// "name x" of each.
std::vector<std::string> in_words(const std::vector<Point>& marks) {
  std::vector<std::string> words;
  for (const Point& mark : marks) words.push_back(mark.name + " " + std::to_string(static_cast<int>(mark.position.x)));
  return words;
}

std::vector<std::string> changed(const std::vector<Point>& known, const std::vector<Point>& sent) {
  return in_words(changed_marks(known, sent));
}

TEST(OpenIgtMarks, NewAndMovedOnesChangeAndWhatIsLeftOutStays) {
  const std::vector<Point> known{at("Mark 1", 1), at("vessel", 2)};
  EXPECT_THAT(changed(known, {}), IsEmpty());
  EXPECT_THAT(changed(known, known), IsEmpty());
  EXPECT_THAT(changed(known, {at("Mark 1", 1.0005)}), IsEmpty()) << "rounded on the wire";
  EXPECT_THAT(changed(known, {at("stone", 3), at("vessel", 4)}), ElementsAre("vessel 4", "stone 3"));
  EXPECT_THAT(changed({}, known), ElementsAre("Mark 1 1", "vessel 2"));
}

/// A list that is sent again changes nothing, whatever is in it.
TEST(OpenIgtMarks, TheLastOfSeveralOfOneNameCounts) {
  const std::vector<Point> twice{at("a", 1), at("a", 2)};
  EXPECT_THAT(changed({}, twice), ElementsAre("a 2"));
  EXPECT_THAT(changed({at("a", 2)}, twice), IsEmpty());
}

TEST(OpenIgtMarks, OneWithoutANameGetsOneThatNoOtherHas) {
  const std::vector<Point> known{at("Mark 1", 1)};
  EXPECT_THAT(changed(known, {at("", 2), at("Mark 2", 3), at("", 4)}), ElementsAre("Mark 3 2", "Mark 2 3", "Mark 4 4"));
  EXPECT_THAT(changed(known, {at("", 1)}), IsEmpty()) << "it is there";
}

TEST(OpenIgtMarks, ThereIsAnEndToThem) {
  std::vector<Point> most;
  for (std::size_t n = 0; n < most_marks; ++n) most.push_back(at("m" + std::to_string(n), 1));
  EXPECT_EQ(changed_marks({}, most).size(), most_marks);
  EXPECT_THROW(changed_marks(most, {at("one more", 1)}), Refusal);
  EXPECT_THAT(changed(most, {at("m7", 2)}), ElementsAre("m7 2"));
  most.push_back(at("pressed", 1));  // a press is never refused
  EXPECT_THAT(changed(most, {at("m7", 2)}), ElementsAre("m7 2"));
}

}  // namespace
}  // namespace palpate::plugin::igtl

// Lists of marks that clients send.

#include "plugin/openigtlink/marks.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "plugin/openigtlink/say.h"

namespace palpate::plugin::igtl {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

Point at(const std::string& name, double x) {
  return {.name = name, .position = {x, 0, 0}};
}

std::string in_words(const Point& mark) {
  return mark.name + " " + std::to_string(static_cast<int>(mark.position.x));
}

/// "name x" of each.
std::vector<std::string> changed(const std::vector<Point>& known, const std::vector<Point>& sent) {
  std::vector<std::string> words;
  for (const ChangedMark& one : changed_marks(known, sent)) words.push_back(in_words(one.mark));
  return words;
}

std::vector<Point> with_changes(std::vector<Point> marks, const std::vector<Point>& sent) {
  for (const ChangedMark& one : changed_marks(marks, sent)) {
    (one.at < marks.size() ? marks[one.at] : marks.emplace_back()) = one.mark;
  }
  return marks;
}

/// As a client gets the marks and sends them back.
std::vector<Point> echo_of(const std::vector<Point>& marks) {
  return points_of(content_of(marks));
}

/// Some have the same first 64 bytes, and some are cut there inside a letter.
const std::string long_name(70, 'n');
const std::string cut_name = std::string(63, 'n') + "\u00e4 and more", other_cut = std::string(63, 'n') + "\u00f6";

/// Marks of few names and few places, no two alike for a client.
std::vector<Point> random_marks(std::mt19937& random, const std::vector<std::string>& names) {
  std::vector<Point> marks;
  std::set<std::string> taken;
  const auto upto = [&](std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n)(random); };
  for (std::size_t n = upto(6); n > 0; --n) {
    const Point mark = at(names[upto(names.size() - 1)], static_cast<double>(upto(5)));
    if (taken.insert(in_words(echo_of({mark}).front())).second) marks.push_back(mark);
  }
  return marks;
}

std::vector<std::string> all_in_words(const std::vector<Point>& marks) {
  std::vector<std::string> words;
  for (const Point& mark : marks) words.push_back(in_words(mark));
  return words;
}

TEST(OpenIgtMarks, NewAndMovedOnesChangeAndWhatIsLeftOutStays) {
  const std::vector<Point> known{at("Mark 1", 1), at("vessel", 2)};
  EXPECT_THAT(changed(known, {}), IsEmpty());
  EXPECT_THAT(changed(known, known), IsEmpty());
  EXPECT_THAT(changed(known, {at("Mark 1", 1.0005)}), IsEmpty()) << "rounded on the wire";
  EXPECT_THAT(changed(known, {at("stone", 3), at("vessel", 4)}), ElementsAre("vessel 4", "stone 3"));
  EXPECT_THAT(changed({}, known), ElementsAre("Mark 1 1", "vessel 2"));
}

/// None of them is lost: what was felt at one place says nothing of another.
TEST(OpenIgtMarks, SeveralOfOneNameAreSeveralMarks) {
  const std::vector<Point> twice{at("a", 1), at("a", 2)}, turned{at("a", 2), at("a", 1)};
  EXPECT_THAT(changed({}, twice), ElementsAre("a 1", "a 2"));
  EXPECT_THAT(changed({}, {at("a", 1), at("a", 1)}), ElementsAre("a 1"));
  EXPECT_THAT(changed(twice, turned), IsEmpty());
  EXPECT_THAT(changed(twice, {at("a", 3), at("a", 2)}), ElementsAre("a 3"));
  EXPECT_EQ(all_in_words(with_changes(twice, {at("a", 3), at("a", 2)})), all_in_words({at("a", 3), at("a", 2)}));
  EXPECT_THAT(changed({at("a", 2)}, twice), ElementsAre("a 1")) << "a new one: the known one is where it was";
}

TEST(OpenIgtMarks, ALongNameComesBackCutAndIsTheSame) {
  for (const std::string& name : {long_name, cut_name}) {
    const std::vector<Point> known{at(name, 1)};
    std::vector<Point> sent = echo_of(known);
    ASSERT_NE(sent[0].name, name);
    EXPECT_THAT(changed(known, sent), IsEmpty());
    sent[0].position.x = 2;
    EXPECT_THAT(changed(known, sent), ElementsAre(name + " 2")) << "it keeps its name";
  }
  // A cut letter is no letter: neither kept nor sent.
  EXPECT_EQ(echo_of({at(cut_name, 1)})[0].name, std::string(63, 'n'));
}

/// Over names that are alike, long or missing, in any order.
TEST(OpenIgtMarks, AListThatIsSentAgainChangesNothingAndNoMarkIsLost) {
  std::mt19937 random(1);
  const std::vector<std::string> names{"edge", "vessel", long_name, cut_name, other_cut};
  std::vector<std::string> names_sent = names;
  names_sent.emplace_back();
  for (int n = 0; n < 3000; ++n) {
    const std::vector<Point> known = random_marks(random, names);
    std::vector<Point> back = echo_of(known);
    std::ranges::shuffle(back, random);
    ASSERT_THAT(changed(known, back), IsEmpty()) << ::testing::PrintToString(all_in_words(known));
    const std::vector<Point> sent = echo_of(random_marks(random, names_sent));
    SCOPED_TRACE(::testing::PrintToString(all_in_words(known)) + " and " +
                 ::testing::PrintToString(all_in_words(sent)));
    const std::vector<Point> now = with_changes(known, sent);
    ASSERT_THAT(changed(now, sent), IsEmpty());
    ASSERT_THAT(changed(now, echo_of(now)), IsEmpty());
    const std::vector<std::string> words_sent = all_in_words(sent), words_now = all_in_words(echo_of(now));
    for (const Point& one : sent) {
      if (one.name.empty()) continue;
      ASSERT_THAT(words_now, Contains(in_words(one)));
    }
    for (std::size_t k = 0; k < known.size(); ++k) {
      const Point as_sent = echo_of({known[k]}).front();
      ASSERT_EQ(now[k].name, known[k].name);
      const bool is_named = std::ranges::count(sent, as_sent.name, &Point::name) > 0;
      const bool is_there = std::ranges::count(words_sent, in_words(as_sent)) > 0;
      if (!is_there && is_named) continue;  // it may be moved
      ASSERT_EQ(in_words(now[k]), in_words(known[k]));
    }
  }
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

#include "plugin/cli/solve_json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <new>
#include <nlohmann/json.hpp>
#include <random>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "solver/analytical.h"
#include "solver/descent.h"
#include "solver/exact.h"

namespace palpate::plugin {
namespace {

using Json = nlohmann::json;
using ::testing::HasSubstr;

constexpr std::array<const solver::SolverType*, 4> all_choices = {nullptr, &solver::analytical_solver,
                                                                  &solver::exact_solver, &solver::descent_solver};

/// The answer as JSON; one line, an object, and of either kind.
Json answer(std::string_view line, const SolveOptions& options = {}) {
  const SolvedLine result = solve_line(line, options);
  EXPECT_EQ(result.json.find_first_of("\r\n"), std::string::npos) << result.json;
  const Json json = Json::parse(result.json, nullptr, false);
  EXPECT_TRUE(json.is_object()) << result.json;
  EXPECT_TRUE(json.contains("id")) << result.json;
  EXPECT_EQ(json.contains("error"), !result.solved) << result.json;
  EXPECT_EQ(json.contains("proxy"), result.solved) << result.json;
  return json;
}

std::string error(std::string_view line, const SolveOptions& options = {}) {
  return answer(line, options).value("error", "no error");
}

const std::string pressed_plane = R"({"id":"a","stiffness":400,"probe":[0.001,0,-0.002],"primitives":[)"
                                  R"({"type":"plane","strength":2,"position":[0,0,0],"direction":[0,0,1]}]})";

/// Three planes and a line that are oblique to each other, by the probe.
const std::string oblique =
    R"({"id":7,"stiffness":400,"probe":[0.001,-0.0005,-0.002],"previous":[0,0,0],"primitives":[)"
    R"({"type":"plane","strength":0.5,"position":[0,0,0],"direction":[0.1,0,1]},)"
    R"({"type":"plane","strength":0.3,"position":[0,0,0],"direction":[0,0.7,0.7]},)"
    R"({"type":"line","strength":0.2,"position":[0,0,0],"direction":[1,2,3]},)"
    R"({"type":"point","strength":0.1,"position":[0.0001,0,0]},)"
    R"({"type":"force","strength":0.05,"direction":[0,1,0]}]})";

/// pressed_plane with a text in it replaced.
std::string with(const std::string& from, const std::string& to) {
  std::string line = pressed_plane;
  return line.replace(line.find(from), from.size(), to);
}

TEST(SolveJson, ThePlaneOfTheHelpTextForEverySolverThatFits) {
  for (const solver::SolverType* const choice : std::span(all_choices).first(3)) {
    const Json json = answer(pressed_plane, {.solver = choice});
    std::vector<std::string> keys;
    for (const auto& [key, value] : json.items()) keys.push_back(key);
    EXPECT_THAT(keys, ::testing::UnorderedElementsAre("id", "proxy", "force", "forces", "solver", "error_bound",
                                                      "iterations", "time_ns"));
    // Held on the plane: it takes 400 N/m x 2 mm of its 2 N.
    EXPECT_EQ(json["id"], "a");
    EXPECT_NEAR(json["proxy"][0].get<double>(), 0.001, 1e-17);
    EXPECT_NEAR(json["proxy"][2].get<double>(), 0, 1e-17);
    EXPECT_NEAR(json["force"][2].get<double>(), 0.8, 1e-14);
    ASSERT_EQ(json["forces"].size(), 1U);
    EXPECT_NEAR(json["forces"][0][2].get<double>(), 0.8, 1e-14);
    EXPECT_EQ(json["solver"], choice == &solver::exact_solver ? "exact" : "analytical");
    EXPECT_LT(json["error_bound"].get<double>(), 1e-14);
    EXPECT_TRUE(json["iterations"].is_number_integer());
    EXPECT_GE(json["time_ns"].get<std::int64_t>(), 0);
  }
}

TEST(SolveJson, TheForcesGivenBalanceTheForceFed) {
  const Json json = answer(oblique);
  ASSERT_EQ(json["forces"].size(), 5U);
  EXPECT_EQ(json["solver"], "exact");
  for (const std::size_t axis : {0U, 1U, 2U}) {
    double sum = 0;
    for (const auto& force : json["forces"]) sum += force[axis].get<double>();
    EXPECT_NEAR(sum, json["force"][axis].get<double>(), 1e-13);
  }
}

TEST(SolveJson, ForcedSolversSayWhatDoesNotFit) {
  EXPECT_EQ(error(oblique, {.solver = &solver::analytical_solver}),
            "the analytical solver does not fit this configuration");
  const std::string hard = with(R"("strength":2)", R"("strength":"inf")");
  EXPECT_EQ(error(hard, {.solver = &solver::descent_solver}), "the descent solver does not fit this configuration");
  EXPECT_EQ(answer(hard)["force"][2].get<double>(), 0.8);
}

TEST(SolveJson, DescentStartsFromThePreviousProxyAndStaysWithinItsBound) {
  const Json exact = answer(oblique, {.solver = &solver::exact_solver});
  const Json descent = answer(oblique, {.solver = &solver::descent_solver});
  EXPECT_EQ(descent["solver"], "descent");
  double squares = 0;
  for (const std::size_t axis : {0U, 1U, 2U}) {
    squares += std::pow(descent["proxy"][axis].get<double>() - exact["proxy"][axis].get<double>(), 2);
  }
  EXPECT_LE(std::sqrt(squares), descent["error_bound"].get<double>() + exact["error_bound"].get<double>());
  const std::string nothing = R"({"stiffness":400,"probe":[0,0,0],"previous":[0.1,0,0],"primitives":[]})";
  EXPECT_GT(answer(nothing, {.solver = &solver::descent_solver})["iterations"], 50);
}

/// What the header says of what is missing: the previous proxy is then the probe, the solver the chain, which gives the
/// exact answer where descent, that starts at the previous proxy, does not; and nothing else is read.
TEST(SolveJson, WhatIsMissingHasItsDefault) {
  const auto without_time = [](const std::string& line, const SolveOptions& options) {
    Json json = answer(line, options);
    json.erase("time_ns");
    return json;
  };
  const std::string begin = R"({"id":1,"stiffness":400,"probe":[0.001,-0.0005,-0.002],)",
                    end = R"("primitives":[{"type":"plane","strength":0.5,"position":[0,0,0],"direction":[0.1,0,1]},)"
                          R"({"type":"line","strength":0.2,"position":[0,0,0],"direction":[1,2,3]},)",
                    point = R"({"type":"point","strength":0.1,"position":[0.0001,0,0]},)",
                    force = R"({"type":"force","strength":0.05,"direction":[0,1,0]}]})";
  for (const solver::SolverType* const choice : all_choices) {
    const SolveOptions options{.solver = choice};
    const Json least = without_time(begin + end + point + force, options);
    EXPECT_EQ(without_time(begin + R"("previous":[0.001,-0.0005,-0.002],)" + end + point + force, options), least);
    const std::string point_with_direction =
        R"({"type":"point","strength":0.1,"position":[0.0001,0,0],"direction":[0,0,1],"color":"red"},)";
    const std::string force_with_position =
        R"({"type":"force","strength":0.05,"direction":[0,1,0],"position":[7,8,9]}],"units":"SI"})";
    EXPECT_EQ(without_time(begin + end + point_with_direction + force_with_position, options), least);
  }
  const SolveOptions defaults;
  EXPECT_EQ(defaults.solver, nullptr);
  EXPECT_EQ(defaults.repeat, 1);
  EXPECT_EQ(without_time(oblique, defaults), without_time(oblique, {.solver = nullptr, .repeat = 1}));
  EXPECT_EQ(answer(oblique, defaults)["solver"], "exact");
  EXPECT_EQ(answer(pressed_plane, defaults)["solver"], "analytical");
}

TEST(SolveJson, RepeatingChangesNothingButTheTime) {
  for (const solver::SolverType* const choice : all_choices) {
    Json once = answer(oblique, {.solver = choice, .repeat = 1});
    Json often = answer(oblique, {.solver = choice, .repeat = 20});
    once.erase("time_ns");
    often.erase("time_ns");
    EXPECT_EQ(once, often);
  }
}

/// An answer without a bound is refused, and the reason is the hard constraint that is farthest from it.
TEST(SolveJson, WithoutABoundTheConstraintThatLacksMostIsNamed) {
  const solver::SolverType boundless{.name = "boundless",
                                     .solve = [](const solver::Balance&, std::span<solver::Vec3>, solver::Scratch*,
                                                 const solver::RunOptions&) noexcept {
                                       return solver::Solution{.outcome = solver::Outcome::solved,
                                                               .error_bound = std::numeric_limits<double>::infinity()};
                                     }};
  const auto refusal_of = [&](const std::string& hard) {
    const std::string soft = R"({"type":"point","strength":9,"position":[8,8,8]})";
    return error(R"({"stiffness":400,"probe":[0,0,0],"primitives":[)" + hard + soft + "]}", {.solver = &boundless});
  };
  const std::string met = R"({"type":"plane","strength":"inf","position":[0,0,-50],"direction":[0,0,2]},)";
  const std::string line = R"({"type":"line","strength":"inf","position":[0,0.25,70],"direction":[0,0,3]},)";
  const std::string point = R"({"type":"point","strength":"inf","position":[0,0.3,0.4]},)";
  const std::string plane = R"({"type":"plane","strength":"inf","position":[5,0,0.75],"direction":[0,0,4]},)";
  EXPECT_EQ(refusal_of(met), "no answer with a finite error bound was found");
  EXPECT_THAT(refusal_of(met + line), ::testing::AllOf(HasSubstr("primitive 1: "), HasSubstr(" 0.25 m")));
  EXPECT_THAT(refusal_of(met + line + point), ::testing::AllOf(HasSubstr("primitive 2: "), HasSubstr(" 0.5 m")));
  EXPECT_THAT(refusal_of(plane + line + point), ::testing::AllOf(HasSubstr("primitive 0: "), HasSubstr(" 0.75 m")));
}

/// A solver that finds no memory for itself: its line is answered, too, and is not solved.
TEST(SolveJson, WhereMemoryEndsALineIsAnswered) {
  const solver::SolverType full{
      .name = "full", .make_scratch = [](std::size_t) -> std::unique_ptr<solver::Scratch> { throw std::bad_alloc(); }};
  EXPECT_EQ(error(pressed_plane, {.solver = &full}), "out of memory");
}

/// Of all solves the fastest is told: together they take as many times that as there are of them, and more.
TEST(SolveJson, EachRepeatTakesTheTimeThatIsTold) {
  constexpr int repeat = 500;
  for (const solver::SolverType* const choice : all_choices) {
    const auto begun = std::chrono::steady_clock::now();
    const Json json =
        answer(oblique, {.solver = choice == &solver::analytical_solver ? nullptr : choice, .repeat = repeat});
    const std::chrono::nanoseconds all = std::chrono::steady_clock::now() - begun;
    EXPECT_GE(json["time_ns"].get<std::int64_t>(), 0);
    EXPECT_LE(json["time_ns"].get<std::int64_t>(), all.count() / repeat);
  }
}

TEST(SolveJson, NumbersReadBackAsTheSameDoubles) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> exponent(-300, 49);
  for (int n = 0; n < 2000; ++n) {
    const double x = std::pow(10, exponent(random));
    // With no primitives the proxy is the probe, to the last bit.
    const Json line{{"id", x}, {"stiffness", 1}, {"probe", {x, -x, 0}}, {"primitives", Json::array()}};
    const Json json = answer(line.dump());
    EXPECT_EQ(json["id"].get<double>(), x);
    EXPECT_EQ(json["proxy"][0].get<double>(), x);
    EXPECT_EQ(json["proxy"][1].get<double>(), -x);
  }
}

TEST(SolveJson, TheIdIsEchoedWhereItCanBeRead) {
  EXPECT_EQ(answer(with(R"("id":"a",)", ""))["id"], nullptr);
  EXPECT_EQ(answer(with(R"("a")", "null"))["id"], nullptr);
  EXPECT_EQ(answer(with(R"("a")", "18446744073709551615"))["id"], 18446744073709551615U);
  EXPECT_EQ(answer(with(R"("a")", "-3"))["id"], -3);
  EXPECT_EQ(answer(with(R"("a")", R"("\u00e9\n\u2028\"")"))["id"], "\u00e9\n\u2028\"");
  // Of a line that breaks off, or has a flaw before its id.
  EXPECT_EQ(answer(R"({"id":"cut","stiffness":4)")["id"], "cut");
  EXPECT_EQ(answer(R"({"stiffness":-4,"probe":[0,0,0],"primitives":[],"id":5})")["id"], 5);
  // Not of an object inside.
  EXPECT_EQ(answer(R"({"note":{"id":3},"stiffness":)")["id"], nullptr);
  EXPECT_THAT(error(with(R"("a")", "[1]")), HasSubstr("id is neither"));
}

TEST(SolveJson, NamesPrimitiveAndFieldOfEveryFlaw) {
  struct Case {
    const char* from;
    const char* to;
    const char* words;
  };
  const Case cases[] = {
      {R"("stiffness":400,)", "", "stiffness is missing"},
      {"400", R"("400")", "stiffness is not a number"},
      {"400", "null", "stiffness is not a number"},
      {"400", "0", "stiffness is not positive (0)"},
      {"400", "-1", "stiffness is not positive (-1)"},
      {"400", "1e60", "stiffness is out of range (1e+60): at most 1e+50, at least 1e-50"},
      {"400", "1e400", "not JSON: number overflow parsing '1e400'"},
      {"400", "NaN", "not JSON: "},
      {"400", "Infinity", "not JSON: "},
      {R"("probe":[0.001,0,-0.002],)", "", "probe is missing"},
      {"[0.001,0,-0.002]", "[0,0]", "probe is not an array of three numbers"},
      {"[0.001,0,-0.002]", "[0,0,0,0]", "probe is not an array of three numbers"},
      {"[0.001,0,-0.002]", R"([0,0,"0"])", "probe is not an array of three numbers"},
      {"[0.001,0,-0.002]", R"({"x":0})", "probe is not an array of three numbers"},
      {"[0.001,0,-0.002]", "[0,1e51,0]", "probe is out of range (1e+51): at most 1e+50"},
      {R"("primitives")", R"("previous":3,"primitives")", "previous is not an array of three numbers"},
      {R"("primitives")", R"("Primitives")", "primitives is missing"},
      {R"("primitives":[)", R"("primitives":{"x":[)", "not JSON: "},
      {R"("primitives")", R"("stiffness":1,"primitives")", R"("stiffness" is given twice)"},
      {R"({"type":"plane")", R"(7,{"type":"plane")", "primitive 0: not an object"},
      {R"("type":"plane",)", "", "primitive 0: type is missing"},
      {R"("plane")", "1", "primitive 0: type is not a string"},
      {R"("plane")", R"("plan")", R"(primitive 0: type "plan" is unknown; there are force, plane, line and point)"},
      {R"("strength":2,)", "", "primitive 0: strength is missing"},
      {R"("strength":2)", R"("strength":-1)", "primitive 0: strength is negative (-1)"},
      {R"("strength":2)", R"("strength":"-inf")", R"(primitive 0: strength is neither a number nor "inf")"},
      {R"("strength":2)", R"("strength":true)", R"(primitive 0: strength is neither a number nor "inf")"},
      {R"("strength":2)", R"("strength":1e51)", "primitive 0: strength is out of range (1e+51): at most 1e+50"},
      {R"("plane","strength":2)", R"("force","strength":"inf")", "primitive 0: strength is not finite (inf)"},
      {R"("position":[0,0,0],)", "", "primitive 0: position is missing"},
      {R"("position":[0,0,0])", R"("position":[0,0,null])", "primitive 0: position is not an array of three numbers"},
      {R"("position":[0,0,0])", R"("position":[0,0,-1e51])", "primitive 0: position is out of range (1e+51): at most"},
      {R"(,"direction":[0,0,1])", "", "primitive 0: direction is missing"},
      {"[0,0,1]", "[0,0,0]", "primitive 0: direction has no length (0)"},
      {"[0,0,1]", "[0,0,1e300]", "primitive 0: direction is out of range (1e+300)"},
  };
  for (const auto& [from, to, words] : cases) {
    EXPECT_THAT(error(with(from, to)), ::testing::StartsWith(words)) << from << " -> " << to;
    for (const solver::SolverType* const choice : all_choices) {
      EXPECT_EQ(error(with(from, to), {.solver = choice}), error(with(from, to)));
    }
  }
  const std::string third = R"({"type":"point","strength":1,"position":[0,0,0]},)";
  EXPECT_EQ(error(with(R"({"type":"plane","strength":2)", third + third + R"({"type":"plane","strength":-1)")),
            "primitive 2: strength is negative (-1)");
  EXPECT_THAT(error(R"({"stiffness":400,"probe":[0,0,0],"primitives":[)"
                    R"({"type":"point","strength":"inf","position":[0,0,0]},)"
                    R"({"type":"point","strength":"inf","position":[0,0,1]}]})"),
              ::testing::MatchesRegex("primitive [01]: has infinite strength, but .* hard constraints.*"));
}

TEST(SolveJson, AnswersWhatIsNotABalance) {
  using namespace std::string_literals;
  EXPECT_EQ(error(""), "the line is empty");
  EXPECT_EQ(error(" \t\r"), "the line is empty");
  EXPECT_THAT(error("hello"), HasSubstr("not JSON"));
  EXPECT_THAT(error("[]"), HasSubstr("not a JSON object but of type array"));
  EXPECT_THAT(error("null"), HasSubstr("not a JSON object"));
  EXPECT_THAT(error("{}"), HasSubstr("stiffness is missing"));
  EXPECT_THAT(error("\0{}"s), HasSubstr("not JSON"));
  EXPECT_THAT(error("{\"id\":\"\xff\xfe\"}"), HasSubstr("not JSON"));
  EXPECT_THAT(error("{} {}"), HasSubstr("not JSON"));
  EXPECT_THAT(error(std::string(1000000, '[')), HasSubstr("nested more than 16 deep"));
  std::string objects;
  for (int n = 0; n < 100000; ++n) objects += R"({"id":)";
  EXPECT_THAT(error(objects), HasSubstr("nested more than 16 deep"));
  EXPECT_THAT(error(std::string(longest_line + 1, ' ')), HasSubstr("longer than"));
  EXPECT_THAT(error("\"" + std::string(1000000, 'x')), ::testing::SizeIs(::testing::Le(400)));
  EXPECT_TRUE(solve_line(pressed_plane + "\r").solved);
}

/// A line with some of its bytes, its numbers or its pieces changed, doubled or lost.
std::string mutated(std::string line, std::mt19937_64& random) {
  static const std::vector<std::string> numbers = {"0",
                                                   "-0.0",
                                                   "0.001",
                                                   "-0.002",
                                                   "0.5",
                                                   "1",
                                                   "3",
                                                   "-1",
                                                   "400",
                                                   "1e-17",
                                                   "1e-320",
                                                   "1e-300",
                                                   "1e-50",
                                                   "-1e-50",
                                                   "1e49",
                                                   "1e308",
                                                   "-1e308",
                                                   "1e400",
                                                   "\"inf\"",
                                                   "null",
                                                   "[]",
                                                   "NaN",
                                                   "123456789012345678901"};
  const auto below = [&random](std::size_t count) { return static_cast<std::size_t>(random() % count); };
  for (std::size_t n = below(4) == 0 ? 1 + below(8) : 1; n > 0 && !line.empty(); --n) {
    const std::size_t at = below(line.size());
    switch (below(8)) {
      case 0:
        line[at] = static_cast<char>(random());
        break;
      case 1:
        line.erase(at, 1 + below(20));
        break;
      case 2:
        line.insert(at, line.substr(below(line.size()), below(40)));
        break;
      case 3:
        line.resize(at);
        break;
      default: {  // a number, so that most lines are still JSON
        const std::size_t from = line.find_first_of("0123456789", at);
        if (from == std::string::npos) break;
        const std::size_t to = std::min(line.find_first_not_of("0123456789.e", from), line.size());
        line.replace(from, to - from, numbers[below(numbers.size())]);
      }
    }
  }
  return line;
}

TEST(SolveJson, EveryMutatedLineIsAnswered) {
  std::mt19937_64 random(20070322);
  const std::array seeds = {pressed_plane, oblique, with(R"("strength":2)", R"("strength":"inf")")};
  int solved = 0;
  int refused = 0;
  for (int n = 0; n < 40000; ++n) {
    const std::string line = mutated(seeds[random() % seeds.size()], random);
    const solver::SolverType* const choice = all_choices[random() % all_choices.size()];
    const Json json = answer(line, {.solver = choice});
    if (HasFailure()) FAIL() << line;
    json.contains("error") ? ++refused : ++solved;
    if (json.contains("proxy")) {
      for (const double x : json["proxy"].get<std::vector<double>>()) ASSERT_TRUE(std::isfinite(x)) << line;
      ASSERT_TRUE(json["error_bound"].is_number()) << line;
    }
  }
  // Of both kinds, or little would have been tried.
  EXPECT_GT(solved, 4000);
  EXPECT_GT(refused, 4000);
}

}  // namespace
}  // namespace palpate::plugin

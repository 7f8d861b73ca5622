/// The exit code for each way in which a command can end, and its message.

#include "plugin/options/run_program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <array>
#include <functional>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include "plugin/app/errors.h"
#include "plugin/messages/messages.h"

namespace palpate::plugin {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

struct Ended {
  int exit = -1;
  std::string out, err;
};

Ended run_with(const std::function<void()>& command, const std::vector<std::string>& words = {"try"}) {
  CLI::App program{"A program.", "palpate"};
  int number = 0;
  CLI::App* const tried = program.add_subcommand("try", "Tries it");
  tried->add_option("--number", number, "a number")->check(CLI::PositiveNumber);
  tried->callback(command);
  std::vector<std::string> all{"palpate"};
  all.insert(all.end(), words.begin(), words.end());
  std::vector<char*> arguments;
  for (std::string& word : all) arguments.push_back(word.data());
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  Ended ended;
  ended.exit = run_program(program, static_cast<int>(arguments.size()), arguments.data());
  ended.out = ::testing::internal::GetCapturedStdout();
  ended.err = ::testing::internal::GetCapturedStderr();
  return ended;
}

TEST(RunProgram, EachEndHasItsExitCode) {
  const Text why = say("no-stylus-is-held");
  EXPECT_EQ(run_with([] {}).exit, 0);
  EXPECT_EQ(run_with([&] { throw InputRefused(why); }).exit, 1);
  EXPECT_EQ(run_with([&] { throw WrongUsage(why); }).exit, 2);
  EXPECT_EQ(run_with([] { throw std::runtime_error("a file"); }).exit, 1);
  EXPECT_EQ(run_with([] { throw std::invalid_argument("a scene"); }).exit, 1);
  EXPECT_EQ(run_with([] { throw std::logic_error("a slip"); }).exit, 3);
  EXPECT_EQ(run_with([] { throw std::bad_alloc(); }).exit, 3);
  EXPECT_EQ(run_with([] {}, {}).exit, 2) << "no command";
  EXPECT_EQ(run_with([] {}, {"other"}).exit, 2);
  EXPECT_EQ(run_with([] {}, {"try", "--number", "-1"}).exit, 2);
  EXPECT_EQ(run_with([] {}, {"try", "--word"}).exit, 2);
  EXPECT_EQ(run_with([] {}, {"--help"}).exit, 0);
}

/// The help tells these codes.
TEST(RunProgram, SaysWhyOnStderrAndTheCodesInItsHelp) {
  const Ended refused = run_with([] { throw InputRefused(say("no-stylus-is-held")); });
  EXPECT_EQ(refused.err, "palpate: " + std::string(say("no-stylus-is-held")) + "\n");
  EXPECT_EQ(refused.out, "");
  EXPECT_THAT(run_with([] { throw std::logic_error("a slip"); }).err, HasSubstr("a slip"));
  EXPECT_THAT(run_with([] {}, {"--help"}).out,
              HasSubstr("Exit: 0 done, 1 something in the input was refused, 2 wrong usage, 3 internal fault."));
}

}  // namespace
}  // namespace palpate::plugin

/// Ends a program of tests whose test hangs: linked into every one. A test may take PALPATE_TEST_SECONDS (60) of a
/// machine that has nothing else to do, longer by as much as more threads want to run than there are processors, and by
/// the time that it waited for a processor.

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <cstring>
#include <ctime>

#include "solver/text/testing/crowd.h"

namespace {

double limit = 60;       // s
std::time_t begun = 0;   // s, of the test that runs
double waited = 0;       // s, before it began
char running[256] = "";  // its name

std::time_t now() {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);
  return time.tv_sec;
}

void say(const char* text) {
  if (write(STDERR_FILENO, text, std::strlen(text)) < 0) _exit(EXIT_FAILURE);
}

void look(int) {
  const double took = static_cast<double>(now() - begun) - (palpate::waited_for_a_processor() - waited);
  const double left = limit * palpate::crowd() - took;
  if (left > 0) {
    alarm(static_cast<unsigned>(left) + 1);
    return;
  }
  say("ended: it takes too long: ");
  say(running);
  say("\n");
  _exit(EXIT_FAILURE);
}

class Limit : public testing::EmptyTestEventListener {
  void OnTestStart(const testing::TestInfo& test) override {
    std::strncpy(running, (std::string(test.test_suite_name()) + "." + test.name()).c_str(), sizeof running - 1);
    begun = now();
    waited = palpate::waited_for_a_processor();
    alarm(static_cast<unsigned>(limit) + 1);
  }
  void OnTestEnd(const testing::TestInfo&) override { alarm(0); }
};

const bool there = [] {
  if (const char* seconds = std::getenv("PALPATE_TEST_SECONDS")) limit = std::atof(seconds);
  if (limit <= 0) return false;
  struct sigaction action {};
  action.sa_handler = look;
  action.sa_flags = SA_RESTART;
  sigaction(SIGALRM, &action, nullptr);
  testing::UnitTest::GetInstance()->listeners().Append(new Limit);
  return true;
}();

}  // namespace

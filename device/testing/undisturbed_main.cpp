// GoogleTest's main for programs of tests with real threads and real processes.

#include <gtest/gtest.h>

#include <vector>

#include "device/testing/undisturbed.h"

int main(int count, char** arguments) {
  std::vector<char*> given(arguments, arguments + count + 1);  // GoogleTest takes its own away
  ::testing::InitGoogleTest(&count, arguments);
  const palpate::device::StallMeter meter;
  return palpate::device::judged(RUN_ALL_TESTS(), meter, given.data());
}

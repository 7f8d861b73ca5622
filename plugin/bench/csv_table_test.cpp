// Rows of a slow measurement are printed at once, even if stdout is not a terminal.
#include "plugin/bench/csv_table.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <string>

namespace palpate::plugin {
namespace {

/// Stdout goes into a pipe meanwhile.
class PipedOutput {
 public:
  PipedOutput() {
    std::fflush(stdout);
    before_ = ::dup(STDOUT_FILENO);
    EXPECT_EQ(::pipe2(ends_.data(), O_NONBLOCK | O_CLOEXEC), 0);
    ::dup2(ends_[1], STDOUT_FILENO);
  }
  PipedOutput(const PipedOutput&) = delete;
  PipedOutput& operator=(const PipedOutput&) = delete;
  ~PipedOutput() {
    std::fflush(stdout);
    ::dup2(before_, STDOUT_FILENO);
    for (const int file : {before_, ends_[0], ends_[1]}) ::close(file);
  }
  /// What has come by now.
  std::string text() const {
    std::array<char, 4096> bytes{};
    const ssize_t size = ::read(ends_[0], bytes.data(), bytes.size());
    return size > 0 ? std::string(bytes.data(), static_cast<std::size_t>(size)) : std::string();
  }

 private:
  int before_ = -1;
  std::array<int, 2> ends_{};
};

TEST(CsvTable, EachRowIsSeenAtOnce) {
  std::string header, first, second;
  {
    const PipedOutput output;
    CsvTable table("a,b");
    header = output.text();
    table.add("1,2");
    first = output.text();
    table.add("3,4");
    second = output.text();
  }
  EXPECT_EQ(header, "\na,b\n");
  EXPECT_EQ(first, "1,2\n");
  EXPECT_EQ(second, "3,4\n");
}

}  // namespace
}  // namespace palpate::plugin

#pragma once

/// An archive that misbehaves, which a test starts as a program (odd_archive_main.cpp).

#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <string>

#include "io/archive/archive.h"
#include "io/archive/fetch.h"
#include "io/archive/testing/process.h"
#include "io/fresh_folder.h"

namespace palpate::io::testing {

class OddArchive {
 public:
  explicit OddArchive(const std::string& behavior)
      : archive_(settings()),
        process_({ODD_ARCHIVE, behavior, std::to_string(archive_.listen_port)}),
        folder_(temporary_folder()) {
    const std::string port = process_.read_line();
    archive_.port = port.empty() ? 0 : std::stoi(port);
  }
  Archive& archive() { return archive_; }
  Process& process() { return process_; }
  std::filesystem::path folder() const {
    return blocked_ ? std::filesystem::path("/dev/null/fetched") : folder_.path() / "fetched";
  }
  /// From now on the folder cannot be made.
  void no_folder() { blocked_ = true; }
  std::size_t entries() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::recursive_directory_iterator(folder_.path()), {}));
  }

  /// The message of a fetch that is refused; checks that the fetch leaves no files.
  std::string refused_fetch(const FetchLimits& limits = {}) {
    std::string said = "no refusal";
    try {
      fetch(archive_, {"1.2.3"}, folder(), limits);
    } catch (const ArchiveError& error) {
      said = error.what();
    }
    EXPECT_EQ(entries(), 0U) << "something was left in the folder";
    EXPECT_FALSE(is_listening(archive_.listen_port));
    return said;
  }
  std::string refused_echo() {
    try {
      echo(archive_);
    } catch (const ArchiveError& error) {
      return error.what();
    }
    return "no refusal";
  }

 private:
  static Archive settings() {
    Archive archive;
    archive.name = "odd";
    archive.host = "127.0.0.1";
    archive.called = "ODD";
    archive.calling = "PALPATE";
    archive.uses_get = true;
    archive.listen_address = "127.0.0.1";
    archive.listen_port = free_port();
    archive.silence_s = 2;
    return archive;
  }
  Archive archive_;
  Process process_;
  FreshFolder folder_;
  bool blocked_ = false;
};

}  // namespace palpate::io::testing

#include <cstdlib>
#include <string>

#include "io/testing/provoked_scans.h"

namespace palpate::io::testing {
namespace {

/// A file that begins like an archive but is not one.
std::string of_damaged_archive() {
  return said_of([](const TestFolder& folder) {
    write_bytes(folder / "study.zip", std::string("PK\3\4", 4) + std::string(600, '\x55'));
  });
}

/// Where the folder to unpack to is not there.
std::string of_no_room() {
  const char* const before = std::getenv("TMPDIR");
  const std::string kept = before != nullptr ? before : "";
  const TestFolder folder;
  write_bytes(folder / "study.zip", std::string("PK\3\4", 4) + std::string(600, '\x55'));
  ::setenv("TMPDIR", "/proc", 1);
  const std::string said = said_of(folder.path());
  before != nullptr ? ::setenv("TMPDIR", kept.c_str(), 1) : ::unsetenv("TMPDIR");
  return said;
}

}  // namespace

std::vector<Provoked> provoke_archives() {
  return {{"archive-cannot-be-unpacked", of_damaged_archive()}, {"archive-does-not-fit-on-the-disk", of_no_room()}};
}

}  // namespace palpate::io::testing

#include "plugin/app/archive_settings.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

#include "plugin/testing/test_files.h"

namespace palpate::plugin {
namespace {

/// An archive of which every setting is another text or number.
io::Archive any_archive(std::mt19937& random) {
  const auto text = [&](const std::string& what) { return what + std::to_string(random() % 100'000); };
  const auto number = [&](int most) { return 1 + static_cast<int>(random() % static_cast<unsigned>(most)); };
  io::Archive archive;
  archive.name = text("name");
  archive.host = text("host");
  archive.port = number(65535);
  archive.called = text("CALLED");
  archive.calling = text("CALLING");
  archive.uses_get = random() % 2 == 0;
  archive.listen_address = "10.0.0." + std::to_string(number(250));
  archive.listen_port = number(65535);
  archive.silence_s = number(3600);
  if (random() % 3 == 0) return archive;
  archive.tls = {.used = true, .authorities = text("/authorities"), .certificate = text("/certificate")};
  archive.tls.key = text("/key");
  if (random() % 2 == 0) archive.tls.name = text("tls");
  return archive;
}

/// What a user has entered is there again, to the last setting.
TEST(ArchiveSettings, AreReadAsTheyWereWritten) {
  const auto folder = std::filesystem::absolute(testing::fresh_path("archive_settings"));
  setenv("XDG_CONFIG_HOME", folder.c_str(), 1);
  std::mt19937 random(1);
  for (int n = 0; n < 40; ++n) {
    std::vector<io::Archive> archives(static_cast<std::size_t>(n % 5));
    for (io::Archive& archive : archives) archive = any_archive(random);
    write_archives(archives);
    EXPECT_EQ(read_archives(), archives);
  }
  unsetenv("XDG_CONFIG_HOME");
}

}  // namespace
}  // namespace palpate::plugin

// Each message of the module's tables, in its final form.

#include "io/messages.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <vector>

#include "io/fields/gradient.h"
#include "io/fields/volume_fields.h"
#include "io/fresh_folder.h"
#include "io/series.h"
#include "io/testing/provoked_scans.h"
#include "solver/text/testing/sanitized.h"

namespace palpate::io {
namespace {

using palpate::testing::expect_all_shown;
using palpate::testing::NotShown;
using palpate::testing::output_of;
using palpate::testing::Provoked;
using palpate::testing::said_when;

// Not a test of its own: what it prints is looked at below.
TEST(MessagesOfSeries, DISABLED_FindNothing) {
  std::puts(said_when([] { find_series(std::array<std::filesystem::path, 1>{"/dev/null"}); }).c_str());
}

std::string without_dictionary() {
  return output_of("DCMDICTPATH=/absent " + std::filesystem::read_symlink("/proc/self/exe").string() +
                   " --gtest_also_run_disabled_tests --gtest_filter=*FindNothing");
}

std::vector<Provoked> provoke_fields_and_folders() {
  auto scan = std::make_shared<Volume>();
  scan->geometry.dimensions = {2, 2, 1};
  scan->geometry.slice_positions = {glm::dvec3(0)};
  scan->voxels = std::vector<std::int16_t>(4);
  const testing::TestFolder full;
  testing::write_bytes(full / "a", "a");
  return {
      {"dcmtk-data-dictionary-is-missing", without_dictionary()},
      {"scan-offers-its-value", said_when([&] { VolumeFields(scan, FieldSet::vector, 1); })},
      {"scale-of-the-gradient", said_when([&] { GradientKernel(scan, 0); })},
      {"gradient-scale-too-large", said_when([&] { GradientKernel(scan, 500); })},
      {"exists-and-is-not-an-empty-folder", said_when([&] { FreshFolder(full.path()); })},
      {"cannot-make-a-folder", said_when([] { FreshFolder("/proc/out"); })},
  };
}

TEST(MessagesOfSeries, EachIsShown) {
  std::vector<Provoked> provoked = provoke_fields_and_folders();
  for (const auto& some : {testing::provoke_files(), testing::provoke_headers(), testing::provoke_pixels()}) {
    provoked.insert(provoked.end(), some.begin(), some.end());
  }
  for (const Provoked& one : testing::provoke_archives()) provoked.push_back(one);
  std::vector<NotShown> not_shown{{"archive-holds-too-many-files", "a million files take a minute"}};
  if (is_sanitized) {
    not_shown.push_back({"needs-more-memory-than-there", "sanitizers end a program that asks for too much"});
  }
  expect_all_shown({messages::series}, provoked, not_shown, PALPATE_SOURCES);
}

TEST(MessagesOfArchives, EachIsShown) {
  const std::array not_shown{NotShown{"archive-the-openssl-that-is-installed-cannot", "an OpenSSL of ten years ago"}};
  expect_all_shown({messages::archives}, {}, not_shown, PALPATE_SOURCES);
}

TEST(MessagesOfStructures, EachIsShown) {
  const std::array not_shown{NotShown{"label-map-names-no-scan", "every label map says it: the views show it"}};
  expect_all_shown({messages::structures}, {}, not_shown, PALPATE_SOURCES);
}

}  // namespace
}  // namespace palpate::io

// Fetched files are deleted when their run ends, however it ends, and kept if requested.

#include "plugin/app/fetched.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "plugin/app/errors.h"
#include "plugin/testing/test_files.h"

namespace palpate::plugin {
namespace {

namespace fs = std::filesystem;

class Fetched : public ::testing::Test {
 protected:
  void SetUp() override {
    cache_ = testing::fresh_path("cache");
    setenv("XDG_CACHE_HOME", cache_.c_str(), 1);
  }
  void TearDown() override { unsetenv("XDG_CACHE_HOME"); }

  /// As io::fetch() leaves it: a series of 1000 bytes.
  static fs::path fetch_into(const fs::path& folder, const std::string& series = "series-001") {
    fs::create_directories(folder / series);
    std::ofstream(folder / series / "image-000001.dcm") << std::string(1000, 'x');
    return folder / series;
  }

  fs::path cache_;
};

TEST_F(Fetched, LiesInAPrivateFolderAndGoesWithItsRun) {
  {
    FetchedRun run;
    EXPECT_FALSE(fs::exists(fetched_folder())) << "nothing is made before something is fetched";
    const fs::path first = run.next_folder(), second = run.next_folder();
    EXPECT_NE(first, second);
    EXPECT_EQ(fs::status(first.parent_path()).permissions(), fs::perms::owner_all);
    EXPECT_EQ(fs::status(fetched_folder()).permissions(), fs::perms::owner_all);
    fetch_into(first);
    const fs::path open = fetch_into(second);
    EXPECT_TRUE(run.holds(open));
    EXPECT_FALSE(run.holds(cache_ / "elsewhere"));
    EXPECT_EQ(fetched_on_disk().series, 2U);
    EXPECT_EQ(fetched_on_disk().bytes, 2000U);
  }
  EXPECT_EQ(fetched_on_disk().series, 0U);
  EXPECT_FALSE(fs::exists(fetched_folder()));
}

TEST_F(Fetched, IsRefusedWhereItCannotLie) {
  std::ofstream(cache_) << "a file";
  FetchedRun run;
  try {
    run.next_folder();
    ADD_FAILURE() << "it was taken";
  } catch (const InputRefused& refused) {
    EXPECT_NE(std::string(refused.what()).find("/palpate/fetched cannot be written ("), std::string::npos);
    EXPECT_NE(std::string(refused.what()).find("): make room, or get the right to write to the folder"),
              std::string::npos);
  }
}

TEST_F(Fetched, StaysWhereItIsKept) {
  fetch_into(fetched_folder());  // as `palpate fetch` does
  {
    FetchedRun run;
    run.set_kept(true);
    fetch_into(run.next_folder());
    fetch_into(run.next_folder());
  }
  EXPECT_EQ(fetched_on_disk().series, 3U);
  EXPECT_TRUE(fs::exists(fetched_folder() / "series-003/image-000001.dcm"));
  EXPECT_FALSE(fs::exists(fetched_folder() / "run-001"));
}

TEST_F(Fetched, OfARunThatCrashedIsDeletedByTheNext) {
  fetch_into(fetched_folder() / "run-001/fetch-001");
  FetchedRun living;
  fetch_into(living.next_folder());
  EXPECT_EQ(fetched_on_disk().series, 1U);
  FetchedRun other;
  const fs::path folder = other.next_folder();
  EXPECT_EQ(fetched_on_disk().series, 1U) << "a run that lasts keeps what it has";
  EXPECT_FALSE(living.holds(folder));
}

TEST_F(Fetched, IsEmptiedButForWhatIsInUse) {
  fetch_into(fetched_folder());
  fetch_into(fetched_folder() / "run-007/fetch-001");  // crashed
  FetchedRun living, other;
  const fs::path used = fetch_into(living.next_folder());
  fetch_into(living.next_folder());
  const fs::path others = fetch_into(other.next_folder());
  living.empty({cache_ / "elsewhere", used / "image-000001.dcm"});
  EXPECT_TRUE(fs::exists(used / "image-000001.dcm"));
  EXPECT_TRUE(fs::exists(others));
  EXPECT_EQ(fetched_on_disk().series, 2U);
  living.empty({});
  empty_fetched();  // `palpate archive empty`, while both still run
  EXPECT_EQ(fetched_on_disk().series, 1U);
  EXPECT_TRUE(fs::exists(others));
}

}  // namespace
}  // namespace palpate::plugin

#include "testdata/invesalius.h"

#include <gtest/gtest.h>

#include <fstream>
#include <glm/geometric.hpp>
#include <stdexcept>

#include "io/fresh_folder.h"

namespace palpate::testdata {
namespace {

constexpr double tissue = -300;  // HU: between air and skin
constexpr double bone = 700;

class Cranium : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(invesalius_cranium)) {
      GTEST_SKIP() << "needs the real head of Debian's invesalius-examples, which is not at " << invesalius_cranium;
    }
    volume_ = read_invesalius(invesalius_cranium);
  }
  io::Volume volume_;
};

TEST_F(Cranium, HasTheSizeSpacingAndUnitOfTheScan) {
  EXPECT_EQ(volume_.geometry.dimensions, glm::ivec3(256, 256, 108));
  EXPECT_DOUBLE_EQ(volume_.geometry.spacing_i, 0.9570312);
  EXPECT_DOUBLE_EQ(volume_.geometry.spacing_j, 0.9570312);
  EXPECT_LT(glm::length(volume_.geometry.step - io::Vec3(0, 0, 1.5)), 1e-9);
  EXPECT_EQ(volume_.unit, "HU");
}

TEST_F(Cranium, VertexIsSuperior) {
  // The head closes towards the vertex: the top slices hold ever less tissue, and the topmost less than half of the
  // jaw's.
  const auto tissue_in = [&](int k) {
    int count = 0;
    for (int j = 0; j < 256; ++j) {
      for (int i = 0; i < 256; ++i) {
        count += volume_.value_at(i, j, k) > tissue;
      }
    }
    return count;
  };
  EXPECT_LT(tissue_in(107), tissue_in(100));
  EXPECT_LT(tissue_in(100), tissue_in(90));
  EXPECT_LT(tissue_in(107), tissue_in(54) / 2);
  EXPECT_GT(volume_.geometry.to_patient({0, 0, 107}).z, volume_.geometry.to_patient({0, 0, 0}).z);
}

TEST_F(Cranium, NoseIsAnterior) {
  // The nose is what stands out furthest on one side of the middle, as a narrow ridge; the back of the head is broad.
  const auto width_at_first_tissue = [&](bool from_front) {
    for (int n = 0; n < 256; ++n) {
      const int j = from_front ? n : 255 - n;
      int longest = 0;
      for (int k = 20; k < 70; ++k) {
        int run = 0;
        for (int i = 0; i < 256; ++i) {
          run = volume_.value_at(i, j, k) > tissue ? run + 1 : 0;
          longest = std::max(longest, run);
        }
      }
      if (longest >= 5) {
        const int deeper = from_front ? j + 6 : j - 6;  // a few mm in
        int widest = 0;
        for (int k = 20; k < 70; ++k) {
          int first = 256;
          int last = -1;
          for (int i = 0; i < 256; ++i) {
            if (volume_.value_at(i, deeper, k) > tissue) {
              first = std::min(first, i);
              last = i;
            }
          }
          widest = std::max(widest, last - first);
        }
        return widest;
      }
    }
    return 0;
  };
  EXPECT_LT(width_at_first_tissue(true), 50);
  EXPECT_GT(width_at_first_tissue(false), 60);
  // Air-filled sinuses and the airway lie in the front half of the face, the thick occiput in the back: more air inside
  // the skull's outline in front.
  const auto air_within = [&](int first_row, int last_row) {
    int count = 0;
    for (int k = 20; k < 60; ++k) {
      for (int j = first_row; j < last_row; ++j) {
        for (int i = 108; i < 148; ++i) {
          bool bone_before = false;
          bool bone_after = false;
          for (int d = 1; d < 60; ++d) {
            bone_before = bone_before || volume_.value_at(i - d, j, k) > bone;
            bone_after = bone_after || volume_.value_at(i + d, j, k) > bone;
          }
          count += bone_before && bone_after && volume_.value_at(i, j, k) < -500;
        }
      }
    }
    return count;
  };
  EXPECT_GT(air_within(0, 128), 4 * air_within(128, 256));
}

TEST(Invesalius, RefusesWhatIsNoProject) {
  EXPECT_THROW(read_invesalius("/nowhere/Cranium.inv3"), std::runtime_error);
  const io::FreshFolder folder = io::temporary_folder();
  const auto file = folder.path() / "not-a-project.inv3";
  std::ofstream(file) << "not a tar";
  try {
    read_invesalius(file);
    ADD_FAILURE() << "read a file that is no archive";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find(file.string()), std::string::npos);
  }
}

}  // namespace
}  // namespace palpate::testdata

// When images form one stack, several, or frames of one: both sides of each limit, on images that have only positions
// and labels.
#include "io/dicom/stack_parts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <numeric>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "io/dicom/frames.h"
#include "io/dicom/lattice.h"
#include "io/dicom/series_source.h"

namespace palpate::io::internal {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// Files of one image each, in the order of their heights as their numbers say.
class Images {
 public:
  explicit Images(std::string modality = "MR", double thickness = 1)
      : modality_(std::move(modality)), thickness_(thickness) {}

  FileHeader& add(double height) {
    FileHeader header;
    header.path = "/scan/" + std::to_string(headers_.size());
    header.modality = modality_;
    header.thickness = thickness_;
    header.instance_number = height;
    Plane plane;
    plane.placement = place_at(height);
    header.planes = {plane};
    headers_.push_back(header);
    return headers_.back();
  }
  void add(double height, Label label, const std::string& value) {
    add(height).planes[0].labels[static_cast<std::size_t>(label)] = value;
  }
  /// Pixels of 0.5 mm by 0.8 mm, on planes through the z axis.
  static Placement place_at(double height) {
    Placement place;
    place.position = {5, -6, height};
    place.direction_i = {1, 0, 0};
    place.direction_j = {0, 1, 0};
    place.spacing_i = 0.8;
    place.spacing_j = 0.5;
    return place;
  }
  SeriesSource source() const {
    SeriesSource source;
    source.files = std::make_shared<const std::vector<FileHeader>>(headers_);
    return source;
  }
  std::vector<SeriesSource::Slice> slices() const {
    std::vector<SeriesSource::Slice> all;
    for (std::uint32_t n = 0; n < headers_.size(); ++n) all.push_back({n, 0});
    return all;
  }
  PartedStack parted() const { return part_stack(source(), slices()); }
  std::size_t parts() const { return parted().parts.size(); }
  FrameSplit split() const { return split_into_frames(source(), slices()); }

 private:
  std::string modality_;
  double thickness_;
  std::vector<FileHeader> headers_;
};

Lattice lattice_with(const std::vector<double>& steps) {
  Images images;
  double height = -7;
  images.add(height);
  for (const double step : steps) images.add(height += step);
  return lattice_of(images.source(), images.slices(), Images::place_at(0), 0.01);
}

TEST(LatticeLaws, IsEvenWhereFourOfFiveStepsAreTheUsualOneOrUpToFourTimesThat) {
  const Lattice even = lattice_with({2, 2, 2, 2, 2});
  EXPECT_THAT(even.heights, ElementsAre(-7, -5, -3, -1, 1, 3));
  EXPECT_EQ(even.step, 2);
  EXPECT_TRUE(even.even);
  EXPECT_TRUE(lattice_with({2, 2.19, 2, 2.19, 2}).even) << "to a tenth";
  EXPECT_TRUE(lattice_with({2, 2.21, 2, 2, 2}).even) << "one of five";
  EXPECT_FALSE(lattice_with({2, 2.21, 2, 2.21, 2}).even) << "two of five";
  EXPECT_TRUE(lattice_with({2, 8, 2, 8.19, 2}).even) << "three slices missing";
  EXPECT_FALSE(lattice_with({2, 10, 2, 10, 2}).even) << "four slices missing";
  EXPECT_FALSE(lattice_with({}).even);
  EXPECT_EQ(lattice_with({}).step, 0);
  EXPECT_THAT(lattice_with({2, 0.009, 2, 0.011}).heights,
              ElementsAre(-7, -5, ::testing::DoubleNear(-2.991, 1e-9), ::testing::DoubleNear(-2.98, 1e-9)));
}

/// Ten slices 4 mm apart, and as many between them, `apart` mm farther on, of another acquisition.
Images by_turns(double apart, const std::string& modality = "MR", double thickness = 1) {
  Images images(modality, thickness);
  for (int n = 0; n < 10; ++n) {
    images.add(4.0 * n, Label::acquisition, "1");
    images.add(4.0 * n + apart, Label::acquisition, "2");
  }
  return images;
}

// Half of the step to three twentieths of it; what lies otherwise was scanned twice.
TEST(StackParts, PassesDivideTheirStepEvenly) {
  for (const double evenly : {2.0, 1.72, 2.28}) EXPECT_EQ(by_turns(evenly).parts(), 1U) << evenly;
  for (const double not_so : {1.68, 2.32, 1.0, 0.2}) EXPECT_EQ(by_turns(not_so).parts(), 2U) << not_so;
}

// A pass is none that is complete by itself: whose slices are as thick as two thirds of its step.
TEST(StackParts, PassesOfThickSlicesAreStacksOfTheirOwn) {
  EXPECT_EQ(by_turns(2, "MR", 2.6).parts(), 1U);
  EXPECT_EQ(by_turns(2, "MR", 2.7).parts(), 2U);
  EXPECT_EQ(by_turns(2, "CT", 2.6).parts(), 1U);
  // Where nothing is said of thickness, CT's table moves on; of MR it is told.
  EXPECT_EQ(by_turns(2, "CT", 0).parts(), 2U);
  const PartedStack doubtful = by_turns(2, "MR", 0).parted();
  EXPECT_THAT(doubtful.parts, SizeIs(1));
  ASSERT_THAT(doubtful.doubts, SizeIs(1));
  EXPECT_THAT(std::string(doubtful.doubts[0]), ::testing::HasSubstr("acquisition 1 and acquisition 2"));
  EXPECT_THAT(by_turns(2, "MR", 1).parted().doubts, IsEmpty());
}

/// Which time of equal ones a slice has, by its rank in the order of acquisition.
using TimeOf = std::function<int(int rank, int slice)>;

/// Slices in the order in which passes take them.
std::vector<int> in_passes(int slices, int passes, std::mt19937& random) {
  std::vector<int> first(static_cast<std::size_t>(passes)), order;
  std::iota(first.begin(), first.end(), 0);
  std::ranges::shuffle(first, random);
  const bool downwards = random() % 2 == 0;
  for (const int pass : first) {
    const auto begin = static_cast<std::ptrdiff_t>(order.size());
    for (int slice = pass; slice < slices; slice += passes) order.push_back(slice);
    if (downwards) std::reverse(order.begin() + begin, order.end());
  }
  return order;
}

// A stack of MR that was taken in passes, every second or third slice after the other. Times of whole seconds tie
// within a pass, across its end, or all over; numbers follow the places, or the acquisition. Slices that overlap are
// taken so, too. Passes come in any order, and each upwards or downwards.
TEST(StackParts, AnMrStackOfPassesIsOneHoweverItsTimesTie) {
  std::mt19937 random(7);
  std::vector<int> drawn(64);
  for (int& one : drawn) one = static_cast<int>(random() % 3);
  const std::vector<std::pair<const char*, std::function<TimeOf(int slices, int passes)>>> ties{
      {"all equal", [](int, int) { return [](int, int) { return 0; }; }},
      {"by twos", [](int, int) { return [](int rank, int) { return rank / 2; }; }},
      {"by fives", [](int, int) { return [](int rank, int) { return rank / 5; }; }},
      {"by thirds", [](int slices, int) { return [=](int rank, int) { return 3 * rank / slices; }; }},
      {"by passes", [](int, int passes) { return [=](int, int slice) { return slice % passes; }; }},
      {"the last pass twice",
       [](int slices, int passes) {
         return [=](int rank, int slice) { return slice % passes + (rank > slices - 6 ? 1 : 0); };
       }},
      {"at random", [&](int, int) { return [&](int rank, int) { return drawn[static_cast<std::size_t>(rank)]; }; }}};
  for (const int slices : {12, 29, 55}) {
    for (const int passes : {1, 2, 3, 4, 7}) {
      if (3 * passes > slices) continue;
      for (const auto& [name, tie] : ties) {
        const TimeOf time_of = tie(slices, passes);
        for (const double thickness : {2.0, 2.5, 3.0, 4.0, 5.0}) {
          for (const bool by_place : {false, true}) {
            for (const auto time : {&FileHeader::content_time, &FileHeader::acquisition_time}) {
              Images images("MR", thickness);
              int rank = 0;
              for (const int slice : in_passes(slices, passes, random)) {
                FileHeader& file = images.add(2.5 * slice);
                file.*time = std::to_string(101000 + time_of(rank, slice));
                file.instance_number = by_place ? slice : rank;
                ++rank;
              }
              EXPECT_EQ(images.parts(), 1U) << name << ", " << slices << " in " << passes << " passes, " << thickness
                                            << " mm, numbers " << (by_place ? "by place" : "by time");
            }
          }
        }
      }
    }
  }
}

// What reaches beyond the other on either side is mixed where a quarter of its slices lies on the other's.
TEST(StackParts, TimesThatOverlapByAQuarterAreApart) {
  for (const int common : {2, 3, 5}) {
    Images images;
    for (int s = 0; s < 2; ++s) {
      for (int n = 0; n < 10; ++n) images.add(4.0 * (n + s * (10 - common))).acquisition_time = s == 0 ? "1" : "2";
    }
    EXPECT_EQ(images.parts(), common >= 3 ? 2U : 1U) << common;
  }
}

// A few images that a rule tells apart do not keep it from telling the others, as long as they are a fifth at most.
TEST(StackParts, SmallPartsGoWithTheFirst) {
  for (const int second : {3, 4}) {
    Images images;
    for (int n = 0; n < 4; ++n) images.add(4.0 * n, Label::acquisition, "1");
    for (int n = 0; n < second; ++n) images.add(4.0 * n + 1, Label::acquisition, "2");
    for (int n = 0; n < 2; ++n) images.add(4.0 * n + 30, Label::acquisition, "3");
    const PartedStack parted = images.parted();
    ASSERT_EQ(parted.parts.size(), second == 4 ? 2U : 1U);
    if (second == 4) {
      EXPECT_EQ(parted.parts[0].slices.size(), 6U);
    }
  }
}

TEST(StackParts, StacksBesideEachOtherAreAPixelApart) {
  for (const bool along_i : {false, true}) {
    for (const auto& [pixels, parts] : {std::pair{0.9, 1U}, {1.1, 2U}, {5.0, 2U}}) {
      Images images;
      for (int n = 0; n < 10; ++n) images.add(4.0 * n);
      for (int n = 0; n < 10; ++n) {
        Vec3& position = images.add(4.0 * n).planes[0].placement->position;
        (along_i ? position.x : position.y) += pixels * 0.5;  // of the finer spacing
      }
      EXPECT_EQ(images.parts(), parts) << pixels;
    }
  }
}

// Echoes that lie a quarter of a step apart at most, at their first and at their last slice, follow a head.
TEST(StackParts, FramesOfOneVolumeLieNearlyAtTheSamePlaces) {
  const auto volumes = [](double first, double last) {
    Images images;
    for (int n = 0; n < 10; ++n) {
      images.add(4.0 * n, Label::echo_time, "10");
      images.add(4.0 * n + first + (last - first) * n / 9, Label::echo_time, "20");
    }
    const PartedStack parted = images.parted();
    EXPECT_THAT(parted.parts, SizeIs(2)) << first << ' ' << last;
    return parted.parts.back().volume - parted.parts.front().volume + 1;
  };
  EXPECT_EQ(volumes(0.9, 0.9), 1);
  EXPECT_EQ(volumes(1.1, 1.1), 2);
  EXPECT_EQ(volumes(0.5, 1.1), 2);
  EXPECT_EQ(volumes(1.1, 0.5), 2);
}

// Which labels tell frames of one volume apart where a head has moved between them, and which tell volumes.
TEST(StackParts, KindsAndTimesMayBeFramesSidesAndKernelsAreNot) {
  const std::vector<std::pair<Label, bool>> labels{{Label::laterality, false},  {Label::image_type, false},
                                                   {Label::kernel, false},      {Label::echo_time, true},
                                                   {Label::b_value, true},      {Label::velocity_encoding, true},
                                                   {Label::time_point, true},   {Label::diffusion_direction, true},
                                                   {Label::trigger_time, true}, {Label::acquisition, true}};
  ASSERT_EQ(labels.size(), label_count);
  for (const auto& [label, may_be_frames] : labels) {
    Images images;
    for (int n = 0; n < 10; ++n) {
      images.add(4.0 * n, label, "1");
      images.add(4.0 * n + 0.7, label, "2");
    }
    const PartedStack parted = images.parted();
    ASSERT_THAT(parted.parts, SizeIs(2)) << static_cast<int>(label);
    EXPECT_EQ(parted.parts[0].volume == parted.parts[1].volume, may_be_frames) << static_cast<int>(label);
  }
}

/// Eight slices of a short echo, and the first `others` of them of a long one as well.
FrameSplit echoes(int others) {
  Images images;
  for (int n = 0; n < 8; ++n) images.add(2.0 * n, Label::echo_time, "10");
  for (int n = 0; n < others; ++n) images.add(2.0 * n, Label::echo_time, "20");
  return images.split();
}

// A label is one of frames where half of the places have it; a frame has more than half of the slices.
TEST(Frames, AreOfMoreThanHalfOfTheSlices) {
  EXPECT_THAT(echoes(5).names, ElementsAre("echo time 10 ms", "echo time 20 ms"));
  EXPECT_THAT(echoes(5).left_over, IsEmpty());
  EXPECT_THAT(echoes(4).names, ElementsAre("echo time 10 ms"));
  EXPECT_THAT(echoes(4).left_over, SizeIs(4));
  EXPECT_THAT(echoes(3).names, ElementsAre(""));
  EXPECT_THAT(echoes(3).left_over, SizeIs(3));
  EXPECT_FALSE(echoes(3).ranked);
}

TEST(Frames, LabelsAreSaidInTheirUnits) {
  EXPECT_EQ(label_text(Label::image_type, "M\\PHASE"), "M PHASE");
  EXPECT_EQ(label_text(Label::kernel, "B30f"), "kernel B30f");
  EXPECT_EQ(label_text(Label::laterality, "L"), "side L");
  EXPECT_EQ(label_text(Label::echo_time, "4.6"), "echo time 4.6 ms");
  EXPECT_EQ(label_text(Label::b_value, "800"), "b = 800 s/mm2");
  EXPECT_EQ(label_text(Label::diffusion_direction, "1\\0\\0"), "direction 1 0 0");
  EXPECT_EQ(label_text(Label::velocity_encoding, "0\\0\\1"), "velocity along 0 0 1");
  EXPECT_EQ(label_text(Label::time_point, "3"), "time point 3");
  EXPECT_EQ(label_text(Label::trigger_time, "120"), "trigger delay 120 ms");
  EXPECT_EQ(label_text(Label::acquisition, "2"), "acquisition 2");
}

}  // namespace
}  // namespace palpate::io::internal

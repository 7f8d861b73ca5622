// Positions of segments, contours and registrations that are impossible for a patient: refused in words, before any
// computation. Within the bound, the same outline is felt anywhere.
#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <string>

#include "io/errors.h"
#include "io/structures/distance_field.h"
#include "io/structures/registration.h"
#include "io/structures/structure.h"
#include "io/testing/test_image.h"
#include "io/testing/test_segmentation.h"

namespace palpate::io {
namespace {

using internal::group;
using internal::put;
using internal::succeed;
using internal::TestFolder;

constexpr std::array absurd_numbers{"1e308", "-1e308", "-1e155", "1e30", "3e9", "2e5", "-100100"};
constexpr std::array reachable_numbers{"0", "-90000", "512.25"};

std::string short_number(double number) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.9g", number);
  return text.data();
}

std::string absurd_place(const std::string& number, int axis, int k) {
  std::array<std::string, 3> place{"0", "0", std::to_string(2 * k)};
  if (axis < 2) place.at(static_cast<std::size_t>(axis)) = number;
  if (axis == 2) place[2] = short_number(std::stod(number) + 2 * k);
  return place[0] + "\\" + place[1] + "\\" + place[2];
}

StructureCatalogue boxes_at(const std::string& number, int axis, const TestFolder& folder) {
  internal::TestSegmentation segmentation;
  for (int k = 0; k < 5; ++k) {
    segmentation.frames.push_back({1, 2.0 * k, [](int i, int j) { return i > 2 && i < 9 && j > 1 && j < 7 ? 1 : 0; }});
  }
  segmentation.edit = [&](DcmDataset& dataset) {
    for (int k = 0; k < 5; ++k) {
      DcmItem* frame = nullptr;
      succeed(dataset.findOrCreateSequenceItem(DCM_PerFrameFunctionalGroupsSequence, frame, k));
      succeed(group(*frame, DCM_PlanePositionSequence)
                  .putAndInsertString(DCM_ImagePositionPatient, absurd_place(number, axis, k).c_str()));
    }
  };
  internal::write(segmentation, folder / "seg.dcm");
  return find_structures(std::array{folder.path()});
}

void put_items(DcmItem& into, const DcmTagKey& sequence, const auto& fill) {
  DcmItem* item = nullptr;
  succeed(into.findOrCreateSequenceItem(sequence, item, -2));
  fill(*item);
}

/// One point of each contour is elsewhere, or with `all` each of them.
StructureCatalogue squares_at(const std::string& number, int axis, bool all) {
  const TestFolder folder;
  internal::TestImage image;
  image.edit = [&](DcmDataset& dataset) {
    dataset.findAndDeleteElement(DCM_PixelData);
    put(dataset, DCM_SOPClassUID, "1.2.840.10008.5.1.4.1.1.481.3");
    put_items(dataset, DCM_StructureSetROISequence,
              [](DcmItem& roi) { succeed(roi.putAndInsertString(DCM_ROINumber, "1")); });
    put_items(dataset, DCM_ROIContourSequence, [&](DcmItem& roi) {
      succeed(roi.putAndInsertString(DCM_ReferencedROINumber, "1"));
      for (int k = 0; k < 5; ++k) {
        std::string points;
        for (const glm::dvec2& corner : {glm::dvec2(-5, -5), {5, -5}, {5, 5}, {-5, 5}}) {
          glm::dvec3 at(corner, 2.0 * k);
          if (all || (corner.x > 0 && corner.y > 0)) at[axis] += std::stod(number);
          for (int n = 0; n < 3; ++n) points += (points.empty() ? "" : "\\") + short_number(at[n]);
        }
        put_items(roi, DCM_ContourSequence, [&](DcmItem& contour) {
          succeed(contour.putAndInsertString(DCM_ContourGeometricType, "CLOSED_PLANAR"));
          succeed(contour.putAndInsertString(DCM_ContourData, points.c_str()));
        });
      }
    });
  };
  internal::write(image, folder / "rt.dcm");
  return find_structures(std::array{folder.path()});
}

TEST(AbsurdPlaces, OfSegmentsAreRefusedInWords) {
  for (const char* const number : absurd_numbers) {
    for (int axis = 0; axis < 3; ++axis) {
      const TestFolder folder;
      const StructureCatalogue found = boxes_at(number, axis, folder);
      ASSERT_EQ(found.skipped.size(), 1U) << number << " along " << axis;
      EXPECT_TRUE(found.skipped[0].reason ==
                  "a frame of it lies farther from the scanner than 100 m, or its pixels are too small for any patient")
          << found.skipped[0].reason;
    }
  }
}

TEST(AbsurdPlaces, OfContoursAreRefusedInWords) {
  for (const char* const number : absurd_numbers) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const bool all : {false, true}) {
        const StructureCatalogue found = squares_at(number, axis, all);
        ASSERT_EQ(found.structures.size(), 1U) << number << " along " << axis;
        EXPECT_EQ(std::string(found.structures[0].unfit), "a point of it lies farther from the scanner than 100 m");
      }
    }
  }
}

TEST(AbsurdPlaces, OfRegistrationsAreRefusedInWords) {
  for (const char* const number : absurd_numbers) {
    for (int axis = 0; axis < 3; ++axis) {
      const TestFolder folder;
      internal::TestImage image;
      image.edit = [&](DcmDataset& dataset) {
        dataset.findAndDeleteElement(DCM_PixelData);
        put(dataset, DCM_SOPClassUID, "1.2.840.10008.5.1.4.1.1.66.1");
        put(dataset, DCM_FrameOfReferenceUID, "1.1");
        put_items(dataset, DCM_RegistrationSequence, [&](DcmItem& part) {
          succeed(part.putAndInsertString(DCM_FrameOfReferenceUID, "1.2"));
          put_items(part, DCM_MatrixRegistrationSequence, [&](DcmItem& registration) {
            put_items(registration, DCM_MatrixSequence, [&](DcmItem& matrix) {
              std::string rows;
              for (int n = 0; n < 16; ++n) {
                rows += std::string(n == 0 ? "" : "\\") + (n == 4 * axis + 3 ? number : n % 5 == 0 ? "1" : "0");
              }
              succeed(matrix.putAndInsertString(DCM_FrameOfReferenceTransformationMatrix, rows.c_str()));
            });
          });
        });
      };
      internal::write(image, folder / "reg.dcm");
      const auto registrations = find_structures(std::array{folder.path()}).registrations;
      const Joined joined = join(registrations, "1.2", "1.1", "");
      EXPECT_FALSE(joined.motion) << number << " along " << axis;
      EXPECT_EQ(std::string(joined.why_not), "the registration reg.dcm moves it farther than 100 m: export it again");
    }
  }
}

// Truth: the box and the square themselves, and that a shift changes no distance.
TEST(PlacesWithinTheBound, ChangeNothing) {
  for (const char* const number : reachable_numbers) {
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 shift(0);
      shift[axis] = std::stod(number);
      const TestFolder folder;
      const Structure box = boxes_at(number, axis, folder).structures.at(0);
      EXPECT_EQ(measure(box).voxels, 6U * 5U * 5U) << number << " along " << axis;
      const Structure square = squares_at(number, axis, true).structures.at(0);
      EXPECT_EQ(std::string(square.unfit), "");
      EXPECT_NEAR(measure(square).volume_mm3, 10 * 10 * 10, 1e-3);
      const auto field = load_distance(square);
      EXPECT_NEAR(field->sample(shift + Vec3(0, 3, 4)).mm, 2, 0.05) << number << " along " << axis;
      EXPECT_NEAR(field->sample(shift + Vec3(8, 0, 4)).mm, -3, 0.05) << number << " along " << axis;
    }
  }
}

}  // namespace
}  // namespace palpate::io

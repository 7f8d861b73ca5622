// Registrations written by DCMTK, against matrices multiplied here.
#include "io/structures/registration.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "io/structures/structure.h"
#include "io/testing/test_image.h"

namespace palpate::io {
namespace {

using internal::put;
using internal::succeed;
using internal::TestFolder;
using internal::TestImage;

using Matrix = std::array<double, 16>;  // row by row

Matrix times(const Matrix& a, const Matrix& b) {
  Matrix product{};
  for (std::size_t row = 0; row < 4; ++row) {
    for (std::size_t column = 0; column < 4; ++column) {
      for (std::size_t n = 0; n < 4; ++n) product[4 * row + column] += a[4 * row + n] * b[4 * n + column];
    }
  }
  return product;
}

Vec3 times(const Matrix& m, const Vec3& p) {
  Vec3 moved(0);
  for (int row = 0; row < 3; ++row) {
    const auto at = static_cast<std::size_t>(4 * row);
    moved[row] = m[at] * p.x + m[at + 1] * p.y + m[at + 2] * p.z + m[at + 3];
  }
  return moved;
}

/// A turn about z, by an angle whose sine and cosine are 0.6 and 0.8, and a shift.
constexpr Matrix about_z{0.8, -0.6, 0, 10, 0.6, 0.8, 0, -20, 0, 0, 1, 30, 0, 0, 0, 1};
/// A quarter turn about x, and a shift.
constexpr Matrix about_x{1, 0, 0, 1, 0, 0, -1, 2, 0, 1, 0, 3, 0, 0, 0, 1};
/// The way back from about_z: its turn transposed, and that turn of its shift, negative.
constexpr Matrix back_about_z{0.8, 0.6, 0, 4, -0.6, 0.8, 0, 22, 0, 0, 1, -30, 0, 0, 0, 1};

std::string in_digits(const Matrix& matrix) {
  std::string text;
  for (const double number : matrix) {
    std::array<char, 32> digits{};
    std::snprintf(digits.data(), digits.size(), "%.6g", number);
    if (!text.empty()) text.append("\\");
    text.append(digits.data());
  }
  return text;
}

struct TestPart {
  std::string frame;
  std::vector<std::string> matrices;
};

DcmItem& new_registration_item(DcmItem& item, const DcmTagKey& sequence) {
  DcmItem* added = nullptr;
  succeed(item.findOrCreateSequenceItem(sequence, added, -2));
  return *added;
}

void write(const std::filesystem::path& file, const std::string& registered, const std::vector<TestPart>& parts,
           const std::string& patient = "7", const std::string& sop_class = "1.2.840.10008.5.1.4.1.1.66.1") {
  TestImage image;
  image.edit = [&](DcmDataset& dataset) {
    dataset.findAndDeleteElement(DCM_PixelData);
    put(dataset, DCM_SOPClassUID, sop_class);
    put(dataset, DCM_FrameOfReferenceUID, registered);
    put(dataset, DCM_PatientID, patient);
    for (const TestPart& part : parts) {
      if (sop_class.ends_with("66.3")) {
        DcmItem& item = new_registration_item(dataset, DCM_DeformableRegistrationSequence);
        succeed(item.putAndInsertString(DCM_SourceFrameOfReferenceUID, part.frame.c_str()));
        continue;
      }
      DcmItem& item = new_registration_item(dataset, DCM_RegistrationSequence);
      succeed(item.putAndInsertString(DCM_FrameOfReferenceUID, part.frame.c_str()));
      DcmItem& registration = new_registration_item(item, DCM_MatrixRegistrationSequence);
      for (const std::string& matrix : part.matrices) {
        DcmItem& one = new_registration_item(registration, DCM_MatrixSequence);
        succeed(one.putAndInsertString(DCM_FrameOfReferenceTransformationMatrix, matrix.c_str()));
        succeed(one.putAndInsertString(DCM_FrameOfReferenceTransformationMatrixType, "RIGID"));
      }
    }
  };
  internal::write(image, file);
}

std::vector<Registration> found_in(const TestFolder& folder) {
  return find_structures(std::array{folder.path()}).registrations;
}

Joined joined_in(const TestFolder& folder, const std::string& from, const std::string& to) {
  return join(found_in(folder), from, to, "7");
}

void expect_moves_as(const Joined& joined, const Matrix& matrix) {
  ASSERT_TRUE(joined.motion.has_value()) << joined.why_not;
  for (const Vec3& at : {Vec3(0), Vec3(100, 0, 0), Vec3(-3, 50, 7), Vec3(12, -9, 300)}) {
    const Vec3 moved = (*joined.motion)(at), wanted = times(matrix, at);
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(moved[axis], wanted[axis], 1e-9) << axis;
  }
}

TEST(Registrations, MoveWhatIsRegisteredToTheOtherAndBack) {
  const TestFolder folder;
  write(folder / "reg.dcm", "1.1",
        {{"1.1", {"1\\0\\0\\0\\0\\1\\0\\0\\0\\0\\1\\0\\0\\0\\0\\1"}}, {"1.2", {in_digits(about_z)}}});
  ASSERT_EQ(found_in(folder).size(), 1U);
  expect_moves_as(joined_in(folder, "1.2", "1.1"), about_z);
  expect_moves_as(joined_in(folder, "1.1", "1.2"), back_about_z);
  EXPECT_EQ(joined_in(folder, "1.2", "1.1").file, folder / "reg.dcm");
}

TEST(Registrations, ApplyTheirMatricesOneAfterTheOther) {
  const TestFolder folder;
  write(folder / "reg.dcm", "1.1", {{"1.2", {in_digits(about_z), in_digits(about_x)}}});
  expect_moves_as(joined_in(folder, "1.2", "1.1"), times(about_x, about_z));
}

TEST(Registrations, JoinTwoFramesByAThird) {
  const TestFolder folder;
  write(folder / "reg.dcm", "1.1", {{"1.2", {in_digits(about_x)}}, {"1.3", {in_digits(about_z)}}});
  expect_moves_as(joined_in(folder, "1.2", "1.3"), times(back_about_z, about_x));
}

TEST(Registrations, OfOtherFramesAndOtherPatientsDoNotCount) {
  const TestFolder folder;
  write(folder / "reg.dcm", "1.1", {{"1.2", {in_digits(about_z)}}}, "somebody else");
  write(folder / "another.dcm", "1.1", {{"1.4", {in_digits(about_x)}}});
  EXPECT_EQ(found_in(folder).size(), 2U);
  const Joined joined = joined_in(folder, "1.2", "1.1");
  EXPECT_FALSE(joined.motion.has_value());
  EXPECT_EQ(joined.why_not, "");
}

// An ID that is not said, as of what was made anonymous, contradicts none.
TEST(Registrations, CountUnlessTwoPatientsAreNamed) {
  struct Ids {
    std::string of_registration, own;
    bool counts = false;
  };
  for (const Ids& ids : {Ids{"7", "7", true}, {"7", "8", false}, {"7", "", true}, {"", "7", true}, {"", "", true}}) {
    Registration one{
        .file = "reg.dcm", .frame_of_reference_uid = "1.1", .patient_id = ids.of_registration, .parts = {}};
    one.parts.push_back({.frame_of_reference_uid = "1.2", .motion = {}, .unfit = {}});
    const Joined joined = join(std::array{one}, "1.2", "1.1", ids.own);
    EXPECT_EQ(joined.motion.has_value(), ids.counts) << '"' << ids.of_registration << "\", \"" << ids.own << '"';
    EXPECT_TRUE(joined.why_not.empty());
  }
}

std::string refusal_to_register(const std::vector<std::string>& matrices) {
  const TestFolder folder;
  write(folder / "reg.dcm", "1.1", {{"1.2", matrices}});
  const Joined joined = joined_in(folder, "1.2", "1.1");
  return joined.motion ? std::string("not refused") : std::string(joined.why_not);
}

TEST(Registrations, AreRefusedInWords) {
  constexpr const char* bent = "the registration reg.dcm scales or shears it: resample it on the scan";
  EXPECT_EQ(refusal_to_register({"1.01\\0\\0\\0\\0\\1.01\\0\\0\\0\\0\\1.01\\0\\0\\0\\0\\1"}), bent);
  EXPECT_EQ(refusal_to_register({"1\\0.01\\0\\0\\0\\1\\0\\0\\0\\0\\1\\0\\0\\0\\0\\1"}), bent);
  EXPECT_EQ(refusal_to_register({"-1\\0\\0\\0\\0\\1\\0\\0\\0\\0\\1\\0\\0\\0\\0\\1"}), bent) << "a mirror";
  EXPECT_EQ(refusal_to_register({"1\\0\\0\\0\\0\\1\\0\\0\\0\\0\\1\\0\\0\\0\\0.001\\1"}), bent) << "a projection";
  constexpr const char* none = "the registration reg.dcm has no matrix of 16 numbers: export it again";
  EXPECT_EQ(refusal_to_register({"1\\0\\0"}), none);
  EXPECT_EQ(refusal_to_register({}), none);
  const TestFolder folder;
  write(folder / "reg.dcm", "1.1", {{"1.2", {}}}, "7", "1.2.840.10008.5.1.4.1.1.66.3");
  EXPECT_EQ(joined_in(folder, "1.2", "1.1").why_not, "the registration reg.dcm deforms it: resample it on the scan");
}

TEST(Registrations, ThatDisagreeAreRefusedInWords) {
  const TestFolder folder;
  write(folder / "a.dcm", "1.1", {{"1.2", {in_digits(about_z)}}});
  write(folder / "b.dcm", "1.1", {{"1.2", {in_digits(about_z)}}});
  expect_moves_as(joined_in(folder, "1.2", "1.1"), about_z);
  Matrix other = about_z;
  other[3] += 0.5;
  write(folder / "b.dcm", "1.1", {{"1.2", {in_digits(other)}}});
  EXPECT_EQ(joined_in(folder, "1.2", "1.1").why_not,
            "the registrations a.dcm and b.dcm put it on different places: take one of them away");
}

/// A turn about one of the patient's axes through the origin.
Matrix turned_about(int axis, double angle) {
  Matrix matrix{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  const auto a = static_cast<std::size_t>((axis + 1) % 3), b = static_cast<std::size_t>((axis + 2) % 3);
  matrix[5 * a] = matrix[5 * b] = std::cos(angle);
  matrix[4 * a + b] = -std::sin(angle);
  matrix[4 * b + a] = std::sin(angle);
  return matrix;
}

// They agree if no point within a meter is moved apart by more than a tenth of a millimeter: an angle of 1e-4.
TEST(Registrations, ThatDifferByAnAngleDisagreeWhereItShowsWithinAMeter) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const auto& [angle, agree] :
         {std::pair{5e-5, true}, {-5e-5, true}, {2e-4, false}, {-2e-4, false}, {0.01, false}, {0.5, false}}) {
      const TestFolder folder;
      write(folder / "a.dcm", "1.1", {{"1.2", {in_digits(turned_about(axis, 0))}}});
      write(folder / "b.dcm", "1.1", {{"1.2", {in_digits(turned_about(axis, angle))}}});
      EXPECT_EQ(joined_in(folder, "1.2", "1.1").motion.has_value(), agree) << axis << ' ' << angle;
    }
  }
}

// A square of 20 mm in two planes, and its edge.
TEST(Registrations, MoveContoursAndWhatIsFeltOfThem) {
  const TestFolder folder;
  TestImage image;
  image.edit = [](DcmDataset& dataset) {
    dataset.findAndDeleteElement(DCM_PixelData);
    put(dataset, DCM_SOPClassUID, "1.2.840.10008.5.1.4.1.1.481.3");
    DcmItem& roi = new_registration_item(dataset, DCM_StructureSetROISequence);
    roi.putAndInsertString(DCM_ROINumber, "1");
    DcmItem& drawn = new_registration_item(dataset, DCM_ROIContourSequence);
    drawn.putAndInsertString(DCM_ReferencedROINumber, "1");
    for (const std::string z : {"0", "3", "6", "9", "12", "15", "18"}) {
      DcmItem& item = new_registration_item(drawn, DCM_ContourSequence);
      item.putAndInsertString(DCM_ContourGeometricType, "CLOSED_PLANAR");
      const std::string points = "-10\\-10\\" + z + "\\10\\-10\\" + z + "\\10\\10\\" + z + "\\-10\\10\\" + z;
      item.putAndInsertString(DCM_ContourData, points.c_str());
    }
  };
  internal::write(image, folder / "rt.dcm");
  write(folder / "reg.dcm", "1.1", {{"1.2", {in_digits(times(about_x, about_z))}}});
  const StructureCatalogue found = find_structures(std::array{folder.path()});
  ASSERT_EQ(found.structures.size(), 1U);
  Structure structure = found.structures.front();
  const StructureMeasures before = measure(structure);
  structure.motion = *join(found.registrations, "1.2", "1.1", "7").motion;
  const StructureMeasures after = measure(structure);
  EXPECT_NEAR(after.volume_mm3, before.volume_mm3, 1e-6 * before.volume_mm3);
  const Matrix whole = times(about_x, about_z);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(after.centroid_mm[axis], times(whole, before.centroid_mm)[axis], 1e-3);
  }
  const auto field = load_distance(structure);
  for (const double x : {-12.0, -10.5, -9.5, -8.0, 8.0, 9.5, 10.5, 12.0}) {
    EXPECT_NEAR(field->sample(times(whole, Vec3(x, 0, 9))).mm, 10 - std::abs(x), 0.15) << x;
  }
}

}  // namespace
}  // namespace palpate::io

// What the headers of NIfTI, NRRD and MetaImage may say, field by field, and what of it is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "io/errors.h"
#include "io/load.h"
#include "io/series.h"
#include "io/structures/structure.h"
#include "io/testing/file_bytes.h"
#include "io/testing/test_image.h"
#include "io/testing/voxel_files.h"

namespace palpate::io::internal {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::SizeIs;

/// Why a named file is refused; "read" if it is not.
std::string verdict_on(const std::string& name, const std::string& bytes) {
  const TestFolder folder;
  write_bytes(folder / name, bytes);
  const Catalogue found = find_series(std::array{folder / name});
  if (!found.series.empty()) return "read";
  return found.skipped.empty() ? "nothing" : std::string(found.skipped[0].reason);
}

const std::string no_lattice =
    "its voxels are on no lattice that can be felt (no size, or axes that are sheared): resample it with axes at right "
    "angles";

// --- NIfTI -----------------------------------------------------------------------------------------------------------

/// A header of either version in either byte order, of int16 voxels. Each field is named by its two places (nifti1.h,
/// nifti2.h).
class EitherNifti {
 public:
  EitherNifti(int version, bool big) : version_(version), big_(big), bytes_(version == 1 ? 352 : 544, '\0') {
    put(0, static_cast<std::int32_t>(bytes_.size() - 4));
    bytes_.replace(version == 1 ? 344 : 4, 4, std::string(version == 1 ? "n+1\0" : "n+2\0", 4));
    size(0, 3).size(1, nx).size(2, ny).size(3, nz);
    put(version == 1 ? 70 : 12, std::int16_t{4});
    put(version == 1 ? 72 : 14, std::int16_t{16});
    begin(static_cast<double>(bytes_.size())).units(2);
    for (std::size_t n = 0; n < 8; ++n) real(76 + 4 * n, 104 + 8 * n, 1);  // pixdim
  }
  EitherNifti& real(std::size_t of_1, std::size_t of_2, double value) {
    if (version_ == 1) put(of_1, static_cast<float>(value));
    if (version_ == 2) put(of_2, value);
    return *this;
  }
  EitherNifti& code(std::size_t of_1, std::size_t of_2, int value) {
    if (version_ == 1) put(of_1, static_cast<std::int16_t>(value));
    if (version_ == 2) put(of_2, static_cast<std::int32_t>(value));
    return *this;
  }
  EitherNifti& size(std::size_t axis, int value) {
    if (version_ == 1) put(40 + 2 * axis, static_cast<std::int16_t>(value));
    if (version_ == 2) put(16 + 8 * axis, static_cast<std::int64_t>(value));
    return *this;
  }
  EitherNifti& type(int value) {
    put(version_ == 1 ? 70 : 12, static_cast<std::int16_t>(value));
    return *this;
  }
  EitherNifti& units(int value) {
    if (version_ == 1) put(123, static_cast<std::uint8_t>(value));
    if (version_ == 2) put(500, static_cast<std::int32_t>(value));
    return *this;
  }
  /// vox_offset
  EitherNifti& begin(double at) {
    if (version_ == 1) put(108, static_cast<float>(at));
    if (version_ == 2) put(168, static_cast<std::int64_t>(at));
    return *this;
  }
  EitherNifti& sform(const Rows& rows) {
    for (std::size_t n = 0; n < 12; ++n) real(280 + 4 * n, 400 + 8 * n, rows[n / 4][n % 4]);
    return code(254, 348, 1);
  }
  EitherNifti& quaternion(const Vec3& q, const Vec3& first) {
    for (int n = 0; n < 3; ++n) {
      const auto at = static_cast<std::size_t>(n);
      real(256 + 4 * at, 352 + 8 * at, q[n]).real(268 + 4 * at, 376 + 8 * at, first[n]);
    }
    return code(252, 344, 1);
  }
  EitherNifti& description(const std::string& text) {
    bytes_.replace(version_ == 1 ? 148 : 240, text.size(), text);
    return *this;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  template <typename T>
  void put(std::size_t at, T value) {
    std::ranges::copy(as_bytes(value, big_), bytes_.begin() + static_cast<std::ptrdiff_t>(at));
  }
  int version_;
  bool big_;
  std::string bytes_;
};

struct Form {
  int version = 1;
  bool big = false, gzipped = false;
};

/// Calls `work` for both versions and byte orders, packed and not.
template <typename Work>
void in_every_form(const Work& work) {
  for (int n = 0; n < 8; ++n) {
    const Form form{1 + n % 2, (n & 2) != 0, (n & 4) != 0};
    SCOPED_TRACE(::testing::Message() << "NIfTI-" << form.version << (form.big ? ", big-endian" : "")
                                      << (form.gzipped ? ", packed" : ""));
    work(form);
  }
}

/// With some bytes between header and voxels.
fs::path written_to(const TestFolder& folder, const Form& form, const EitherNifti& header,
                    const std::string& between = {}) {
  const std::string bytes = header.bytes() + between + voxels<std::int16_t>(form.big);
  const fs::path file = folder / (form.gzipped ? "a.nii.gz" : "a.nii");
  write_bytes(file, form.gzipped ? packed(bytes, 31) : bytes);
  return file;
}

TEST(NiftiHeader, EachFieldOfBothVersionsCounts) {
  const Vec3 axis(2.0 / 7, 3.0 / 7, 6.0 / 7), first(10, 20, 30);
  const double angle = 0.8;
  const auto turned = [&](const Vec3& v) {  // Rodrigues' formula
    return v * std::cos(angle) + glm::cross(axis, v) * std::sin(angle) +
           axis * glm::dot(axis, v) * (1 - std::cos(angle));
  };
  in_every_form([&](const Form& form) {
    for (const double qfac : {1.0, -1.0}) {
      EitherNifti header(form.version, form.big);
      header.quaternion(axis * std::sin(angle / 2), 1000.0 * first).units(3 + 8);  // micrometers and seconds
      header.real(76, 104, qfac).real(80, 112, 2000).real(84, 120, 3000).real(88, 128, 4000);
      header.real(112, 176, 0.5).real(116, 184, 7).real(124, 192, 240).real(128, 200, -160);
      const TestFolder folder;
      const fs::path file = written_to(folder, form, header);
      expect_all(
          only_volume(file),
          [&](int a, int b, int c) { return ras_to_lps * (first + turned(Vec3(2 * a, 3 * b, qfac * 4 * c))); },
          [](int a, int b, int c) { return 0.5 * stored(a, b, c) + 7; });
      const auto window = find_series(std::array{file}).series.at(0).window;
      ASSERT_TRUE(window);
      EXPECT_EQ(window->level, 40);
      EXPECT_EQ(window->width, 400);
    }
  });
}

TEST(NiftiHeader, WithoutAFormItHasNoPlace) {
  in_every_form([](const Form& form) {
    for (const int sform : {0, 1}) {
      for (const int qform : {0, 1}) {
        EitherNifti header(form.version, form.big);
        header.sform(oblique()).quaternion({0, 0, 0}, {1, 2, 3});
        header.code(254, 348, sform).code(252, 344, qform);
        const TestFolder folder;
        const fs::path file = written_to(folder, form, header);
        if (sform == 0 && qform == 0) {
          EXPECT_EQ(std::string(find_series(std::array{file}).skipped.at(0).reason),
                    "it does not say where it lies in the patient (neither sform nor qform): save it with its place");
          continue;
        }
        expect_all(
            only_volume(file),
            [&](int a, int b, int c) {
              return ras_to_lps * (sform == 1 ? place_of(oblique(), a, b, c) : Vec3(a + 1, b + 2, c + 3));
            },
            stored);
      }
    }
  });
}

/// vox_offset: what is less than the header's end, or no number, is its end. Between header and voxels anything may
/// lie.
TEST(NiftiHeader, VoxelsBeginWhereItSays) {
  in_every_form([](const Form& form) {
    const auto expect_at = [&](double said, std::size_t between) {
      EitherNifti header(form.version, form.big);
      header.sform(oblique()).begin(said);
      const TestFolder folder;
      const fs::path file = written_to(folder, form, header, std::string(between, '\7'));
      SCOPED_TRACE(said);
      expect_all(
          only_volume(file), [&](int a, int b, int c) { return ras_to_lps * place_of(oblique(), a, b, c); }, stored);
    };
    const double end = form.version == 1 ? 352 : 544;
    for (const double said : {-1.0, 0.0, 16.0, end - 1, end}) expect_at(said, 0);
    for (const std::size_t between : {1U, 2U, 16U, 1000U, 5U << 20U}) {
      expect_at(end + static_cast<double>(between), between);
    }
    if (form.version == 1) {
      expect_at(std::numeric_limits<double>::quiet_NaN(), 0);
      expect_at(std::numeric_limits<double>::infinity(), 0);
    }
  });
}

/// scl_slope and scl_inter: without a slope that is a number other than 0 nothing is scaled.
TEST(NiftiHeader, AScaleThatIsNoNumberIsNone) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  in_every_form([&](const Form& form) {
    for (const double slope : {0.0, nan, infinity, 2.0, -0.5}) {
      for (const double offset : {0.0, 7.0, nan, infinity}) {
        EitherNifti header(form.version, form.big);
        header.sform(oblique()).real(112, 176, slope).real(116, 184, offset);
        const TestFolder folder;
        const bool is_scaled = std::isfinite(slope) && slope != 0;
        const double by = is_scaled ? slope : 1, plus = is_scaled && std::isfinite(offset) ? offset : 0;
        expect_all(
            only_volume(written_to(folder, form, header)),
            [&](int a, int b, int c) { return ras_to_lps * place_of(oblique(), a, b, c); },
            [&](int a, int b, int c) { return by * stored(a, b, c) + plus; });
      }
    }
  });
}

TEST(NiftiHeader, AnAxisHasAtLeastOneVoxel) {
  in_every_form([](const Form& form) {
    for (std::size_t axis = 1; axis <= 3; ++axis) {
      for (const int size : {-1, 0, 1}) {
        EitherNifti header(form.version, form.big);
        header.sform(oblique()).size(axis, size);
        const TestFolder folder;
        const Catalogue found = find_series(std::array{written_to(folder, form, header)});
        ASSERT_EQ(found.series.size(), size == 1 ? 1U : 0U);
        if (size < 1) {
          EXPECT_EQ(std::string(found.skipped.at(0).reason), no_lattice);
        } else {
          EXPECT_EQ(found.series[0].geometry.dimensions[static_cast<int>(axis) - 1], 1);
        }
      }
    }
  });
}

TEST(NiftiHeader, OtherTypesOfVoxelsAreRefused) {
  // Bits, complex numbers of three sizes, floating point of 128 bits, and what is no type.
  in_every_form([](const Form& form) {
    for (const int type : {0, 1, 32, 1536, 1792, 2048, 3, 255}) {
      EitherNifti header(form.version, form.big);
      const TestFolder folder;
      const Catalogue found = find_series(std::array{written_to(folder, form, header.sform(oblique()).type(type))});
      ASSERT_THAT(found.skipped, SizeIs(1)) << type;
      EXPECT_EQ(std::string(found.skipped[0].reason),
                "its voxels are of a type that is not read: save it as numbers of 8 to 64 bits");
    }
  });
}

/// 1002 is NIFTI_INTENT_LABEL.
TEST(NiftiHeader, AnIntentTellsLabelsInBothVersions) {
  for (const bool big : {false, true}) {
    for (int version = 1; version <= 2; ++version) {
      std::string data;
      for (int n = 0; n < nx * ny * nz; ++n) data += as_bytes(static_cast<std::int16_t>(1 + n), big);
      for (const int intent : {0, 501, 1001, 1002, 1003, 2004}) {
        const TestFolder folder;
        write_bytes(folder / "a.nii", EitherNifti(version, big).sform(oblique()).code(68, 504, intent).bytes() + data);
        EXPECT_EQ(find_structures(std::array{folder / "a.nii"}).structures.size(),
                  intent == 1002 ? data.size() / 2 : 0U)
            << intent << " of NIfTI-" << version;
      }
    }
  }
}

TEST(NiftiHeader, NamesOfLabelsFollowTheHeaderOfEitherVersion) {
  // Damaged tables end where they are damaged; what has no key is no label.
  const std::string liver = "<Label Key=\"7\" Red=\"0.2\" Green=\"0.4\" Blue=\"1\">liver</Label>";
  const std::string spleen = "<Label Key=\"9\" Red=\"1\" Green=\"0\" Blue=\"0.6\"><![CDATA[spleen]]></Label>";
  struct Case {
    std::string table;
    std::vector<std::string> names;
  };
  in_every_form([&](const Form& form) {
    for (const Case& one : {Case{liver + spleen, {"liver", "spleen"}}, Case{spleen + liver, {"liver", "spleen"}},
                            Case{liver + "<Label Key=\"9\"", {"liver"}}, Case{liver + "<Label Key=\"9\">x", {"liver"}},
                            Case{liver + "<Label Key=\"9\"</Label>>", {"liver"}},
                            Case{"<Label Key=\"9\">open<![CDATA[</Label>" + liver, {"liver", "open<![CDATA["}},
                            Case{"<Label Name=\"x\">y</Label>" + liver, {"liver"}}}) {
      const TestFolder folder;
      EitherNifti header(form.version, form.big);
      header.sform(oblique()).begin(static_cast<double>(header.bytes().size() + one.table.size()));
      std::string data;
      for (int n = 0; n < nx * ny * nz; ++n) {
        data += as_bytes(static_cast<std::int16_t>(n < nx * ny ? 7 : n < 2 * nx * ny ? 9 : 0), form.big);
      }
      const std::string bytes = header.bytes() + one.table + data;
      const fs::path file = folder / (form.gzipped ? "a.nii.gz" : "a.nii");
      write_bytes(file, form.gzipped ? packed(bytes, 31) : bytes);
      std::vector<std::string> names;
      for (const Structure& structure : find_structures(std::array{file}).structures) {
        if (!structure.name.starts_with("label ")) names.push_back(structure.name);
      }
      EXPECT_EQ(names, one.names) << one.table;
    }
  });
}

/// What a header's description says is no table.
TEST(NiftiHeader, NamesNoLabelInItsDescription) {
  in_every_form([](const Form& form) {
    EitherNifti header(form.version, form.big);
    const std::string table = "<Label Key=\"9\">never</Label>", extension = "<Label Key=\"7\">liver</Label>";
    header.sform(oblique()).begin(static_cast<double>(header.bytes().size() + extension.size())).description(table);
    const TestFolder folder;
    std::vector<std::string> names;
    for (const Structure& structure :
         find_structures(std::array{written_to(folder, form, header, extension)}).structures) {
      names.push_back(structure.name);
    }
    EXPECT_EQ(std::ranges::count(names, "liver"), 1);
    EXPECT_EQ(std::ranges::count(names, "never"), 0);
  });
}

/// A half turn is one, though its quaternion is of 32 bits: what is less than 1e-7 of a turn is rounding, as
/// nifti_quatern_to_mat44() of nifti1_io.c has it.
TEST(NiftiHeader, AHalfTurnIsOneInSpiteOfRounding) {
  for (int n = 0; n < 200; ++n) {
    const double turn = 0.05 * n, rise = 0.013 * n;
    const Vec3 axis(std::cos(turn) * std::cos(rise), std::sin(turn) * std::cos(rise), std::sin(rise));
    const TestFolder folder;
    const Form form;
    EitherNifti header(1, false);
    const fs::path file = written_to(folder, form, header.quaternion(axis, {0, 0, 0}));
    const Geometry geometry = find_series(std::array{file}).series.at(0).geometry;
    const Vec3 wanted = ras_to_lps * (2 * axis.x * axis - Vec3(1, 0, 0));
    EXPECT_LT(glm::length(geometry.direction_i - wanted), 2e-6) << n;
  }
}

TEST(NiftiHeader, IsToldByItsBytesAndItsNameByLettersOfEitherCase) {
  const std::string data = voxels<std::int16_t>();
  for (int version = 1; version <= 2; ++version) {
    const std::string whole = EitherNifti(version, false).sform(oblique()).bytes() + data;
    for (const char* const name : {"a.nii", "a.nii.gz", "A.NII", "A.Nii.GZ"}) {
      EXPECT_EQ(verdict_on(name, whole), "read") << name;
      EXPECT_EQ(verdict_on(name, packed(whole, 31)), "read") << name;
    }
    const std::string pair = "it is no NIfTI-1 or NIfTI-2 file with header and voxels in one: save it as such";
    std::string other = whole;
    other[version == 1 ? 345 : 5] = 'i';  // "ni1": its voxels are in another file
    EXPECT_EQ(verdict_on("a.nii", other), pair);
    other = whole;
    other[0] = static_cast<char>(other[0] + 1);
    EXPECT_EQ(verdict_on("a.nii", other), pair);
    for (const std::size_t left : {0U, 1U, 4U, 347U, 351U}) {
      EXPECT_NE(verdict_on("a.nii", whole.substr(0, left)), "read") << left;
      EXPECT_NE(verdict_on("a.nii.gz", packed(whole.substr(0, left), 31)), "read") << left;
    }
  }
}

/// A scan may be smaller than the header of NIfTI-2, which is looked for first.
TEST(NiftiHeader, AFileMayBeShorterThanTheLongerHeader) {
  for (const bool gzipped : {false, true}) {
    EitherNifti header(1, false);
    header.sform({{{-1, 0, 0, 0}, {0, -1, 0, 0}, {0, 0, 1, 0}}}).type(2).size(1, 2).size(2, 2).size(3, 2);
    const std::string bytes = header.bytes() + std::string("\1\2\3\4\5\6\7\x8", 8);
    const TestFolder folder;
    write_bytes(folder / "a.nii", gzipped ? packed(bytes, 31) : bytes);
    const Volume volume = only_volume(folder / "a.nii");
    EXPECT_EQ(volume.value_at(0, 0, 0), 1);
    EXPECT_EQ(volume.value_at(1, 1, 1), 8);
  }
}

// --- NRRD ------------------------------------------------------------------------------------------------------------

/// Lines of a header, of which each can be replaced or left out.
std::string nrrd_but(const std::string& name, const std::string& line) {
  std::string text = "NRRD0005\n";
  for (const auto& [field, value] :
       std::vector<std::pair<std::string, std::string>>{{"type", "short"},
                                                        {"dimension", "3"},
                                                        {"sizes", "4 3 5"},
                                                        {"endian", "little"},
                                                        {"encoding", "raw"},
                                                        {"space", "left-posterior-superior"},
                                                        {"space directions", "(1,0,0) (0,2,0) (0,0,3)"},
                                                        {"space origin", "(-4,5,6)"}}) {
    if (field != name) text.append(field).append(": ").append(value).append("\n");
  }
  return text + line + "\n";
}

Vec3 place_in_nrrd(int a, int b, int c) {
  return {a - 4, 2 * b + 5, 3 * c + 6};
}

void expect_nrrd(const std::string& header, const Vec3& by = Vec3(1)) {
  const TestFolder folder;
  write_bytes(folder / "a.nrrd", header + voxels<std::int16_t>());
  expect_all(
      only_volume(folder / "a.nrrd"), [&](int a, int b, int c) { return by * place_in_nrrd(a, b, c); }, stored);
}

const std::string no_place =
    "it does not say where it lies in the patient (its space is not LPS, RAS or LAS): save it with its place";

/// Of each axis of the space its own unit.
TEST(NrrdHeader, EveryUnitHasItsLength) {
  const std::vector<std::pair<std::string, double>> units{{"mm", 1},
                                                          {"millimeter", 1},
                                                          {"millimeters", 1},
                                                          {"um", 1e-3},
                                                          {"micron", 1e-3},
                                                          {"microns", 1e-3},
                                                          {"micrometer", 1e-3},
                                                          {"micrometers", 1e-3},
                                                          {"\u00b5m", 1e-3},
                                                          {"\u03bcm", 1e-3},
                                                          {"nm", 1e-6},
                                                          {"cm", 10},
                                                          {"m", 1000},
                                                          {"meter", 1000},
                                                          {"meters", 1000},
                                                          {"MILLIMETER", 1},
                                                          {" mm ", 1},
                                                          {"", 1}};
  for (int axis = 0; axis < 3; ++axis) {
    for (const auto& [unit, mm] : units) {
      std::array<std::string, 3> words{"\"mm\"", "\"mm\"", "\"mm\""};
      words[static_cast<std::size_t>(axis)] = "\"" + unit + "\"";
      const auto in_unit = [&, mm = mm](int n, double value) { return std::to_string(n == axis ? value / mm : value); };
      std::string header =
          nrrd_but("space directions", "space directions: (" + in_unit(0, 1) + ",0,0) (0," + in_unit(1, 2) +
                                           ",0) (0,0," + in_unit(2, 3) + ")\n" + "space units: " + words[0] + " " +
                                           words[1] + " " + words[2] + "\n");
      const std::string origin = "(" + in_unit(0, -4) + "," + in_unit(1, 5) + "," + in_unit(2, 6) + ")";
      header.replace(header.find("(-4,5,6)"), 8, origin);
      SCOPED_TRACE(unit);
      expect_nrrd(header);
    }
  }
  expect_nrrd(nrrd_but("", "space units: \"mm\n"));  // not closed: not said
  expect_nrrd(nrrd_but("", "space units: \"mm\" \"mm\"\n"));
  EXPECT_THAT(verdict_on("a.nrrd", nrrd_but("", "space units: \"mm\" \"\" \"pixel\"\n") + voxels<std::int16_t>()),
              HasSubstr("\"pixel\""));
}

TEST(NrrdHeader, EverySpaceThatIsNamedByThePatientIsRead) {
  const std::vector<std::pair<std::vector<std::string>, Vec3>> spaces{
      {{"left-posterior-superior", "LPS", "lps", "Left-Posterior-Superior"}, {1, 1, 1}},
      {{"right-anterior-superior", "RAS", "ras", "RIGHT-anterior-superior"}, {-1, -1, 1}},
      {{"left-anterior-superior", "LAS", "las", "left-anterior-SUPERIOR"}, {1, -1, 1}}};
  for (const auto& [names, by] : spaces) {
    for (const std::string& name : names) {
      SCOPED_TRACE(name);
      expect_nrrd(nrrd_but("space", "space: " + name + "\n"), by);
      const std::string with_time = name.size() == 3 ? name + "T" : name + "-time";
      std::string four = nrrd_but("space", "space: " + with_time + "\n");
      four.replace(four.find("(1,0,0) (0,2,0) (0,0,3)"), 23, "(1,0,0,0) (0,2,0,0) (0,0,3,0)");
      four.replace(four.find("(-4,5,6)"), 8, "(-4,5,6,1.5)");
      expect_nrrd(four, by);
    }
  }
  for (const char* const other : {"scanner-xyz", "3D-right-handed", "left-posterior", "RPS", "LPI", ""}) {
    EXPECT_EQ(verdict_on("a.nrrd", nrrd_but("space", "space: " + std::string(other) + "\n") + voxels<std::int16_t>()),
              no_place)
        << other;
  }
  EXPECT_EQ(verdict_on("a.nrrd", nrrd_but("space", "") + voxels<std::int16_t>()), no_place);
}

TEST(NrrdHeader, EveryNameOfATypeIsRead) {
  const std::vector<std::pair<std::size_t, std::vector<std::string>>> types{
      {1, {"signed char", "int8", "int8_t", "uchar", "unsigned char", "uint8", "uint8_t", "UCHAR"}},
      {2,
       {"short", "short int", "signed short", "signed short int", "int16", "int16_t", "ushort", "unsigned short",
        "unsigned short int", "uint16", "uint16_t"}},
      {4, {"int", "signed int", "int32", "int32_t", "uint", "unsigned int", "uint32", "uint32_t", "float", "Float"}},
      {8,
       {"longlong", "long long", "long long int", "signed long long", "signed long long int", "int64", "int64_t",
        "ulonglong", "unsigned long long", "unsigned long long int", "uint64", "uint64_t", "double"}}};
  for (const auto& [bytes, names] : types) {
    for (const std::string& name : names) {
      const std::string header = nrrd_but("type", "type: " + name + "\n");
      EXPECT_EQ(verdict_on("a.nrrd", header + std::string(nx * ny * nz * bytes, '\1')), "read") << name;
      const std::string early = verdict_on("a.nrrd", header + std::string(nx * ny * nz * bytes - 1, '\1'));
      EXPECT_EQ(early, "it ends before its last voxel: copy or export it again") << name;
    }
  }
  for (const char* const other : {"block", "char", "long", "float16", ""}) {
    EXPECT_EQ(verdict_on("a.nrrd", nrrd_but("type", "type: " + std::string(other) + "\n") + voxels<std::int16_t>()),
              "its voxels are of a type that is not read: save it as numbers of 8 to 64 bits")
        << other;
  }
}

/// Names of fields are the same in letters of either case; pairs, comments and lines that say nothing are no fields;
/// lines may end as on Windows.
TEST(NrrdHeader, OnlyFieldsCount) {
  expect_nrrd(nrrd_but("sizes", "SIZES: 4 3 5\n"));
  expect_nrrd(nrrd_but("space origin", "Space Origin:(-4,5,6)\n"));
  expect_nrrd(nrrd_but("", "# sizes: 9 9 9\nnothing\nsizes_of:=9 9 9\nNote:=sizes: 9 9 9\n"));
  expect_nrrd(nrrd_but("", "Sizes:=9 9 9\n"));  // a pair keeps its letters
  std::string windows = nrrd_but("", "");
  for (std::size_t at = windows.find('\n'); at != std::string::npos; at = windows.find('\n', at + 2)) {
    windows.insert(at, "\r");
  }
  expect_nrrd(windows);
  EXPECT_NE(verdict_on("a.nrrd", "nrrd" + nrrd_but("", "").substr(4) + voxels<std::int16_t>()), "read");
}

TEST(NrrdHeader, AnEncodingIsNamedInLettersOfEitherCase) {
  expect_nrrd(nrrd_but("encoding", "encoding: RAW\n"));
  for (const char* const other : {"", "zrl", "raw2"}) {
    EXPECT_THAT(
        verdict_on("a.nrrd", nrrd_but("encoding", "encoding: " + std::string(other) + "\n") + voxels<std::int16_t>()),
        HasSubstr("its encoding \"" + std::string(other) + "\" is not read"));
  }
}

/// Three axes in space and their place; what is none, or another number of them, has no place.
TEST(NrrdHeader, EachAxisHasItsDirection) {
  const auto with = [](const std::string& name, const std::string& value) {
    return verdict_on("a.nrrd", nrrd_but(name, name + ": " + value + "\n") + voxels<std::int16_t>(false, 6));
  };
  EXPECT_EQ(with("space directions", "(1,0,0) (0,2,0) (0,0,3)"), "read");
  EXPECT_EQ(with("space directions", " ( 1 , 0 , 0 )  (0, 2, 0) (0,0,3) "), "read");
  for (const char* const lacking :
       {"", "(1,0,0) (0,2,0)", "(1,0,0) (0,2,0) none", "(1,0,0) (0,2,0) (0,0,3) none", "none none (1,0,0)",
        "(1,0) (0,2) (0,3)", "(1,0,0,0,0) (0,2,0,0,0) (0,0,3,0,0)", "(1,0,0) (0,nan,0) (0,0,3)",
        "(inf,0,0) (0,1,0) (0,0,3)", "(1,0,0) (0,1,0) (0,0,-inf)"}) {
    EXPECT_EQ(with("space directions", lacking), no_place) << lacking;
  }
  EXPECT_EQ(with("space directions", "(1,0,0,0) (0,2,0,0) (0,0,3,0.5)"), no_lattice) << "a slice later than the other";
  EXPECT_EQ(with("space directions", "(1,0,0) (0,2,0) (0,0,0)"), no_lattice);
  for (const char* const lacking : {"", "(1,2)", "(1,2,3,4,5)"}) {
    EXPECT_EQ(with("space origin", lacking), no_place) << lacking;
  }
  EXPECT_EQ(with("space origin", "(1,2,nan)"), no_lattice);
  for (const char* const other : {"", "4 3", "4 3 5 2 2"}) {
    EXPECT_EQ(with("sizes", other), "it holds several volumes: save each in a file of its own") << other;
  }
  for (const char* const none : {"0 3 5", "4 -3 5", "4 3 nan", "4 inf 5"}) EXPECT_EQ(with("sizes", none), no_lattice);
}

/// A fourth axis that is not in space: "none", or a vector of what is no number.
TEST(NrrdHeader, AFourthAxisMayBeWrittenInSeveralWays) {
  for (const std::string none : {"none", "(nan,nan,nan)", "None"}) {
    std::string header = nrrd_but("sizes", "sizes: 4 3 5 2\nkinds: domain domain domain list\n");
    header.replace(header.find("(0,0,3)"), 7, "(0,0,3) " + none);
    const TestFolder folder;
    write_bytes(folder / "a.nrrd", header + voxels<std::int16_t>(false, 2));
    const Catalogue found = find_series(std::array{folder / "a.nrrd"});
    ASSERT_THAT(found.series, SizeIs(1)) << none;
    EXPECT_EQ(found.series[0].frames_per_position, 2);
    expect_all(load(found.series[0], {.frame = 1}), place_in_nrrd,
               [](int a, int b, int c) { return stored(a, b, c) + 1000; });
  }
}

/// As the fastest axis: a list or times are volumes, colors are colors, and anything else is refused. Its own kind
/// counts, and not that of an axis beside it.
TEST(NrrdHeader, AFastestAxisIsWhatItsOwnKindSays) {
  const auto with = [](int count, const std::string& kinds, const std::string& type = "uint8") {
    std::string header = nrrd_but("type", "type: " + type + "\n");
    header.replace(header.find("sizes: "), 7, "sizes: " + std::to_string(count) + " ");
    header.replace(header.find("(1,0,0)"), 7, "none (1,0,0)");
    const TestFolder folder;
    write_bytes(folder / "a.nrrd",
                header.substr(0, header.size() - 1) + "kinds: " + kinds + "\n\n" +
                    std::string(static_cast<std::size_t>(8 * nx * ny * nz * std::max(count, 1)), 'a'));
    const Catalogue found = find_series(std::array{folder / "a.nrrd"});
    if (found.series.empty()) return std::string(found.skipped.at(0).reason);
    return std::to_string(found.series[0].frames_per_position);
  };
  const auto several = [](int count) {
    return "it holds " + std::to_string(count) + " values for each voxel: save one of them in a file of its own";
  };
  for (const char* const kind : {"list", "time", "LIST"}) {
    EXPECT_EQ(with(3, std::string(kind) + " domain domain domain"), "3");
    EXPECT_EQ(with(255, std::string(kind) + " domain domain domain"), "255");
    EXPECT_EQ(with(256, std::string(kind) + " domain domain domain"), several(256));
    EXPECT_EQ(with(0, std::string(kind) + " domain domain domain"), no_lattice);
  }
  EXPECT_EQ(with(3, "domain list list list"), several(3));
  EXPECT_EQ(with(3, "RGB-color domain domain domain"), "1");
  EXPECT_EQ(with(4, "RGBA-color domain domain domain"), "1");
  EXPECT_EQ(with(4, "RGBA-color domain domain domain", "uint16"), "1");
  EXPECT_EQ(with(3, "RGB-color domain domain domain", "int16"), several(3));
  EXPECT_EQ(with(3, "RGB-color domain domain domain", "float"), several(3));
  EXPECT_EQ(with(2, "RGB-color domain domain domain"), several(2));
  EXPECT_EQ(with(5, "RGB-color domain domain domain"), several(5));
  EXPECT_EQ(with(3, ""), several(3));
}

/// ITU-R BT.601 of 16 bits, too.
TEST(NrrdHeader, ColorsOf16BitsAreGray) {
  std::string header = nrrd_but("type", "type: uint16\n");
  header.replace(header.find("sizes: "), 7, "sizes: 3 ");
  header.replace(header.find("(1,0,0)"), 7, "none (1,0,0)");
  header.insert(header.size() - 1, "kinds: RGB-color domain domain domain\n");
  std::string data;
  for (int n = 0; n < nx * ny * nz; ++n) {
    for (const int part : {1000 * n, 60000 - 500 * n, 7 * n}) data += as_bytes(static_cast<std::uint16_t>(part));
  }
  const TestFolder folder;
  write_bytes(folder / "a.nrrd", header + data);
  expect_all(only_volume(folder / "a.nrrd"), place_in_nrrd, [](int a, int b, int c) {
    const int n = (c * ny + b) * nx + a;
    return std::round(0.299 * 1000 * n + 0.587 * (60000 - 500 * n) + 0.114 * 7 * n);
  });
}

/// "byte skip" counts from the data's beginning; -1 says that the voxels are what the file ends with, of all volumes.
TEST(NrrdHeader, BytesAreSkippedByEitherName) {
  const std::string data = voxels<std::int16_t>(false, 3);
  for (const std::string name : {"byte skip", "byteskip"}) {
    for (const int count : {0, 1, 2, 6, 1000, -1}) {
      for (const bool apart : {false, true}) {
        SCOPED_TRACE(name + " " + std::to_string(count) + (apart ? " apart" : ""));
        std::string header = nrrd_but("sizes", "sizes: 4 3 5 3\n" + name + ": " + std::to_string(count) + "\n" +
                                                   (apart ? "datafile: a.raw\n" : ""));
        header.replace(header.find("(0,0,3)"), 7, "(0,0,3) none");
        const std::string body = std::string(static_cast<std::size_t>(count < 0 ? 77 : count), 'x') + data;
        const TestFolder folder;
        write_bytes(folder / "a.nhdr", header + (apart ? "" : body));
        if (apart) write_bytes(folder / "a.raw", body);
        for (const int frame : {0, 2}) {
          expect_all(only_volume(folder / "a.nhdr", frame), place_in_nrrd,
                     [&](int a, int b, int c) { return stored(a, b, c) + 1000 * frame; });
        }
      }
    }
  }
}

/// 3D Slicer's: a label without a value has its number, from 1 on; without a layer it is in the first one.
TEST(NrrdHeader, SegmentsHaveTheirOwnValuesLayersAndColors) {
  std::string header = nrrd_but("type", "type: uint8\n");
  header.insert(header.size() - 1,
                "Segment0_Name:=one\nSegment1_Name:=seven\nSegment1_LabelValue:=7\nSegment1_Color:=0.2 0.4 1\n"
                "Segment2_Name:=three\nSegment2_LabelValue:=nan\nSegment2_Layer:=nan\nSegment4_Name:=never\n");
  const TestFolder folder;
  write_bytes(folder / "a.seg.nrrd", header + std::string(20, '\1') + std::string(20, '\3') + std::string(20, '\7'));
  std::vector<std::string> found;
  for (const Structure& structure : find_structures(std::array{folder / "a.seg.nrrd"}).structures) {
    found.push_back(std::to_string(structure.number) + " " + structure.name + " " + structure.color + " " +
                    std::to_string(measure(structure).voxels.value_or(0)));
  }
  EXPECT_EQ(found, (std::vector<std::string>{"1 one  20", "3 three  20", "7 seven #3366ff 20"}));
}

/// Labels in layers are no scan, however few there are.
TEST(NrrdHeader, LayersOfLabelsAreNoScan) {
  for (const int layers : {2, 3}) {
    std::string header = nrrd_but("type", "type: uint8\nSegment0_Name:=one\nSegment0_Layer:=0\n");
    header.replace(header.find("sizes: "), 7, "sizes: " + std::to_string(layers) + " ");
    header.replace(header.find("(1,0,0)"), 7, "none (1,0,0)");
    const std::string data(static_cast<std::size_t>(layers * nx * ny * nz), '\1');
    EXPECT_EQ(verdict_on("a.nrrd", header + data),
              "it holds " + std::to_string(layers) + " values for each voxel: save one of them in a file of its own");
  }
}

// --- MetaImage -------------------------------------------------------------------------------------------------------

const std::string meta_refusal = "it is no MetaImage of three or four dimensions in binary: save it as such";

/// itk::MetaImageIO: T, t or 1 begins what is true.
TEST(MetaImageHeader, TruthIsWrittenInSeveralWays) {
  for (const auto& [word, is] : {std::pair{"True", true},
                                 {"true", true},
                                 {"T", true},
                                 {"1", true},
                                 {"False", false},
                                 {"false", false},
                                 {"F", false},
                                 {"0", false}}) {
    SCOPED_TRACE(word);
    const std::string order = is ? "ElementByteOrderMSB = " : "BinaryDataByteOrderMSB = ";
    const std::string data = voxels<std::int16_t>(is);
    const std::string header = "NDims = 3\nDimSize = 4 3 5\nElementType = MET_SHORT\n" + order + word +
                               "\nCompressedData = " + word + "\n" + meta_place;
    const TestFolder folder;
    for (const char* const local : {"LOCAL", "Local", "local"}) {
      write_bytes(folder / "a.mha", header + "ElementDataFile = " + local + "\n" + (is ? packed(data, 15) : data));
      expect_all(
          only_volume(folder / "a.mha"), [](int a, int b, int c) { return place_of(meta_rows, a, b, c); }, stored);
    }
    EXPECT_EQ(verdict_on("a.mha", "NDims = 3\nDimSize = 4 3 5\nElementType = MET_SHORT\nBinaryData = " +
                                      std::string(word) + "\nElementDataFile = LOCAL\n" + voxels<std::int16_t>()),
              is ? "read" : meta_refusal);
  }
}

TEST(MetaImageHeader, NumbersAreAsManyAsItsAxes) {
  const auto with = [](const std::string& field) {
    std::string header = "NDims = 3\nDimSize = 4 3 5\nElementType = MET_SHORT\n" + meta_place;
    const std::string name = field.substr(0, field.find(' '));
    if (const std::size_t at = header.find(name + " ="); at != std::string::npos) {
      header.erase(at, header.find('\n', at) + 1 - at);
    }
    return verdict_on("a.mha", header + field + "\nElementDataFile = LOCAL\n" + voxels<std::int16_t>(false, 4));
  };
  for (const char* const good :
       {"NDims = 3", "DimSize = 4 3 5", "ElementSpacing = 1 2 3", "ElementSpacing = 1 2 3 4", "Offset = 1 2 3",
        "ElementNumberOfChannels = 1", "TransformMatrix = 1 0 0 0 1 0 0 0 1"}) {
    EXPECT_EQ(with(good), "read") << good;
  }
  for (const char* const bad :
       {"NDims = 2", "NDims = 4", "NDims = ", "DimSize = 4 3", "DimSize = 4 3 5 2", "DimSize = 4 3 5 2 1",
        "ElementSpacing = 1 2", "Offset = 1", "TransformMatrix = 1 0 0 0 1 0 0 0", "TransformMatrix = 1 0 0 1",
        "TransformMatrix = 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1"}) {
    EXPECT_EQ(with(bad), meta_refusal) << bad;
  }
  for (const char* const none :
       {"DimSize = 0 3 5", "DimSize = 4 -3 5", "DimSize = 4 3 nan", "DimSize = inf 3 5", "ElementSpacing = 0 1 1",
        "ElementSpacing = nan 1 1", "Offset = nan 0 0", "TransformMatrix = 1 0 0 1 0 0 0 0 1"}) {
    EXPECT_EQ(with(none), no_lattice) << none;
  }
  for (const char* const other : {"ElementType = MET_OTHER", "ElementType = short", "ElementType = "}) {
    EXPECT_EQ(with(other), "its voxels are of a type that is not read: save it as numbers of 8 to 64 bits") << other;
  }
  EXPECT_EQ(with("ElementNumberOfChannels = 2"),
            "it holds 2 values for each voxel: save one of them in a file of its own");
}

/// With a fourth axis its matrix has a row more, and its directions are the first three parts of the first three rows.
TEST(MetaImageHeader, AFourthAxisTakesNothingFromTheOthers) {
  const std::string data = voxels<std::int16_t>(false, 2);
  const std::string header =
      "NDims = 4\nDimSize = 4 3 5 2\nElementType = MET_SHORT\nElementSpacing = 0.5 2 3 9\nOffset = -12 5 90 8\n"
      "TransformMatrix = 0.6 0.8 0 0 -0.8 0.6 0 0 0 0 -1 0 0 0 0 1\n";
  for (const std::string skip : {"", "HeaderSize = 0\n", "HeaderSize = -1\n"}) {
    const TestFolder folder;
    write_bytes(folder / "a.mha",
                header + skip + "ElementDataFile = LOCAL\n" + (skip.find('-') == skip.npos ? "" : "xyz") + data);
    for (const int frame : {0, 1}) {
      expect_all(
          only_volume(folder / "a.mha", frame), [](int a, int b, int c) { return place_of(meta_rows, a, b, c); },
          [&](int a, int b, int c) { return stored(a, b, c) + 1000 * frame; });
    }
  }
}

/// HeaderSize: from the first byte on, however few.
TEST(MetaImageHeader, AnyCountOfBytesIsSkipped) {
  for (const int count : {0, 1, 2, 3, 1000}) {
    const TestFolder folder;
    write_bytes(folder / "a.raw",
                std::string(static_cast<std::size_t>(count), 'x') + voxels<std::int16_t>() + "and more");
    write_bytes(folder / "a.mhd",
                meta_image(meta_place + "HeaderSize = " + std::to_string(count) + "\nElementDataFile = a.raw\n"));
    SCOPED_TRACE(count);
    expect_all(
        only_volume(folder / "a.mhd"), [](int a, int b, int c) { return place_of(meta_rows, a, b, c); }, stored);
  }
}

/// Its header ends with ElementDataFile, whatever the voxels look like. Lines may end as on Windows, be indented, or
/// say nothing.
TEST(MetaImageHeader, EndsWithTheNameOfItsData) {
  std::string data = voxels<std::int16_t>();
  data.replace(0, 14, "\nDimSize = 1 1");
  const std::string header = meta_image(meta_place + "Comment\n\n  Modality =MET_MOD_CT  \n");
  std::string windows = header;
  for (std::size_t at = windows.find('\n'); at != std::string::npos; at = windows.find('\n', at + 2)) {
    windows.insert(at, "\r");
  }
  for (const std::string& lines : {header, windows}) {
    const TestFolder folder;
    write_bytes(folder / "a.mha", lines + "ElementDataFile = LOCAL\n" + data);
    const Volume volume = only_volume(folder / "a.mha");
    ASSERT_EQ(volume.geometry.dimensions, glm::ivec3(nx, ny, nz));
    const Vec3 at = volume.geometry.to_index(place_of(meta_rows, 3, 2, 4));
    EXPECT_EQ(volume.value_at(static_cast<int>(std::lround(at.x)), static_cast<int>(std::lround(at.y)),
                              static_cast<int>(std::lround(at.z))),
              stored(3, 2, 4));
  }
  EXPECT_NE(verdict_on("a.mha", header), "read") << "nothing says where its data are";
  EXPECT_NE(verdict_on("a.txt", header + "ElementDataFile = LOCAL\n" + data), "read");
  for (const char* const name : {"A.MHA", "a.mhd"}) {
    EXPECT_EQ(verdict_on(name, header + "ElementDataFile = LOCAL\n" + data), "read");
  }
}

/// As older versions of ITK name colors.
TEST(MetaImageHeader, AnArrayIsOfTheTypeThatItNames) {
  const std::string header =
      "NDims = 3\nDimSize = 4 3 5\nElementType = MET_UCHAR_ARRAY\nElementNumberOfChannels = 3\n" + meta_place +
      "ElementDataFile = LOCAL\n";
  const TestFolder folder;
  std::string data;
  for (int n = 0; n < nx * ny * nz; ++n) data += std::string(3, static_cast<char>(4 * n));
  write_bytes(folder / "a.mha", header + data);
  expect_all(
      only_volume(folder / "a.mha"), [](int a, int b, int c) { return place_of(meta_rows, a, b, c); },
      [](int a, int b, int c) { return 4 * ((c * ny + b) * nx + a); });
}

}  // namespace
}  // namespace palpate::io::internal

// What the header of NIfTI may say, field by field, and what of it is refused.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>
#include <string>
#include <vector>

#include "io/series.h"
#include "io/structures/structure.h"
#include "io/testing/file_bytes.h"
#include "io/testing/test_image.h"
#include "io/testing/voxel_files.h"

namespace palpate::io::internal {
namespace {

namespace fs = std::filesystem;
using ::testing::SizeIs;

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

}  // namespace
}  // namespace palpate::io::internal

#include "io/testing/voxel_files.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <new>

#include "io/errors.h"
#include "io/load.h"
#include "io/testing/file_bytes.h"
#include "io/testing/test_image.h"

namespace palpate::io::internal {
namespace {

namespace fs = std::filesystem;

Rows squared(Rows rows) {  // makes the second column perpendicular to the first
  Vec3 i(rows[0][0], rows[1][0], rows[2][0]), j(rows[0][1], rows[1][1], rows[2][1]);
  j -= glm::dot(i, j) / glm::dot(i, i) * i;
  for (std::size_t row = 0; row < 3; ++row) rows[row][1] = j[static_cast<int>(row)];
  return rows;
}

}  // namespace

int stored(int a, int b, int c) {
  return 100 * c + 10 * b + a - 150;
}

Vec3 place_of(const Rows& rows, int a, int b, int c) {
  Vec3 place(0);
  for (int row = 0; row < 3; ++row) {
    const auto& r = rows[static_cast<std::size_t>(row)];
    place[row] = r[0] * a + r[1] * b + r[2] * c + r[3];
  }
  return place;
}

void expect_all(const Volume& volume, const std::function<Vec3(int, int, int)>& lps,
                const std::function<double(int, int, int)>& value) {
  const glm::ivec3 size = volume.geometry.dimensions;
  ASSERT_EQ(size.x * size.y * size.z, nx * ny * nz);
  for (int c = 0; c < nz; ++c) {
    for (int b = 0; b < ny; ++b) {
      for (int a = 0; a < nx; ++a) {
        const Vec3 at = volume.geometry.to_index(lps(a, b, c));
        const glm::ivec3 index(std::lround(at.x), std::lround(at.y), std::lround(at.z));
        ASSERT_LT(glm::length(at - Vec3(index)), 1e-3) << a << " " << b << " " << c;
        ASSERT_TRUE(glm::all(glm::greaterThanEqual(index, glm::ivec3(0))) && glm::all(glm::lessThan(index, size)));
        EXPECT_NEAR(volume.value_at(index.x, index.y, index.z), value(a, b, c), 1e-4) << a << " " << b << " " << c;
      }
    }
  }
  const Geometry& g = volume.geometry;
  EXPECT_GT(glm::dot(glm::cross(g.direction_i, g.direction_j), g.step), 0) << "slices ascend along i x j";
}

Volume only_volume(const fs::path& file, int frame) {
  const Catalogue found = find_series(std::array{file});
  if (found.series.size() != 1) {
    ADD_FAILURE() << file << ": "
                  << (found.skipped.empty() ? std::string("nothing") : std::string(found.skipped.front().reason));
    return {};
  }
  EXPECT_TRUE(found.series[0].usable);
  return load(found.series[0], {.frame = frame});
}

std::string verdict_on(const std::string& name, const std::string& bytes) {
  const TestFolder folder;
  write_bytes(folder / name, bytes);
  const Catalogue found = find_series(std::array{folder / name});
  if (!found.series.empty()) return "read";
  return found.skipped.empty() ? "nothing" : std::string(found.skipped[0].reason);
}

std::string verdict_on_voxels(const std::string& bytes, const std::string& name) {
  const TestFolder folder;
  write_bytes(folder / name, bytes);
  const Catalogue found = find_series(std::array{folder / name});
  if (found.series.empty()) return found.skipped.at(0).reason;
  try {
    load(found.series[0]);
  } catch (const DicomError& error) {
    return error.what();
  }
  return "loaded";
}

std::string refusal_of(const std::string& name, const std::string& bytes) {
  const TestFolder folder;
  write_bytes(folder / name, bytes);
  const Catalogue found = find_in(folder);
  EXPECT_TRUE(found.series.empty());
  return found.skipped.size() == 1 ? std::string(found.skipped[0].reason) : "not refused";
}

std::string packed(std::string bytes, int window_bits) {
  z_stream stream{};
  if (deflateInit2(&stream, 9, Z_DEFLATED, window_bits, 8, Z_DEFAULT_STRATEGY) != Z_OK) throw std::bad_alloc();
  std::string out(bytes.size() + 1024, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(bytes.data());
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  deflate(&stream, Z_FINISH);
  out.resize(out.size() - stream.avail_out);
  deflateEnd(&stream);
  return out;
}

std::string labels() {
  std::string bytes;
  for (int n = 0; n < nx * ny * nz; ++n) bytes += as_bytes(static_cast<std::int16_t>(n / (nx * ny) > 1 ? 7 : 0));
  return bytes;
}

Rows oblique() {
  return squared({{{1.2, -0.8, 0.3, -40}, {0.9, 1.0, -0.5, 25.5}, {0.0, 0.15, 2.9, 7}}});
}

Rows flipped() {
  return squared({{{-1.2, -0.8, 0.3, -40}, {-0.9, 1.0, -0.5, 25.5}, {0.0, 0.15, 2.9, 7}}});
}

std::string meta_image(const std::string& fields) {
  return "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\nDimSize = 4 3 "
         "5\nElementType = MET_SHORT\n" +
         fields;
}

}  // namespace palpate::io::internal

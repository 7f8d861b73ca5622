#include "plugin/openigtlink/surface.h"

namespace palpate::plugin::igtl {
namespace {

constexpr std::size_t bytes_of_point = 12, bytes_of_triangle = 16;

}  // namespace

Bytes content_of(const Surface& surface) {
  Writer writer;
  const auto triangles = static_cast<std::uint32_t>(surface.triangles.size());
  writer.number(static_cast<std::uint32_t>(surface.points.size()));
  // A count of cells and their size, for vertices, lines, polygons and strips; then the count of attributes.
  for (const std::uint32_t number :
       {0U, 0U, 0U, 0U, triangles, static_cast<std::uint32_t>(bytes_of_triangle * triangles), 0U, 0U, 0U}) {
    writer.number(number);
  }
  for (const glm::dvec3& point : surface.points) {
    for (int axis = 0; axis < 3; ++axis) writer.real(point[axis]);
  }
  for (const auto& triangle : surface.triangles) {
    writer.number(3U);
    for (const std::uint32_t corner : triangle) writer.number(corner);
  }
  return writer.take();
}

Surface surface_of(ByteView content) {
  Reader reader(content);
  const std::size_t points = reader.number<std::uint32_t>();
  std::array<std::size_t, 8> cells{};  // counts and sizes
  for (std::size_t& number : cells) number = reader.number<std::uint32_t>();
  reader.number<std::uint32_t>();  // attributes
  if (points * bytes_of_point + cells[1] + cells[3] + cells[5] + cells[7] > reader.left()) {
    throw InvalidInput(say("igtl-ends-early"));
  }
  Surface surface;
  for (std::size_t n = 0; n < points; ++n) {
    const double x = reader.real(), y = reader.real();
    surface.points.emplace_back(x, y, reader.real());
  }
  reader.raw(cells[1] + cells[3]);
  Reader polygons(reader.raw(cells[5]));
  while (polygons.left() > 0) {
    if (polygons.number<std::uint32_t>() != 3) throw InvalidInput(say("igtl-ends-early"));
    auto& triangle = surface.triangles.emplace_back();
    for (std::uint32_t& corner : triangle) {
      corner = polygons.number<std::uint32_t>();
      if (corner >= points) throw InvalidInput(say("igtl-ends-early"));
    }
  }
  return surface;
}

}  // namespace palpate::plugin::igtl

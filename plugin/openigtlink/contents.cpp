#include "plugin/openigtlink/contents.h"

#include <algorithm>
#include <cmath>

namespace palpate::plugin::igtl {
namespace {

constexpr std::size_t status_name_size = 20, point_name_size = 64, point_group_size = 32, point_owner_size = 20;
constexpr std::uint16_t us_ascii = 3, utf_8 = 106;

void write(Writer& writer, const glm::dvec3& v) {
  for (int axis = 0; axis < 3; ++axis) writer.real(v[axis]);
}

glm::dvec3 read_vector(Reader& reader) {
  glm::dvec3 v;
  for (int axis = 0; axis < 3; ++axis) {
    v[axis] = reader.real();
    if (!std::isfinite(v[axis])) throw InvalidInput(say("igtl-not-a-number"));
  }
  return v;
}

}  // namespace

Bytes content_of(const Transform& transform) {
  Writer writer;
  for (int column = 0; column < 3; ++column) write(writer, transform.rotation[column]);
  write(writer, transform.translation);
  return writer.take();
}

Transform transform_of(ByteView content) {
  Reader reader(content);
  Transform transform;
  for (int column = 0; column < 3; ++column) transform.rotation[column] = read_vector(reader);
  transform.translation = read_vector(reader);
  return transform;
}

Bytes content_of(const Status& status) {
  Writer writer;
  writer.number(static_cast<std::uint16_t>(status.code));
  writer.number(static_cast<std::uint64_t>(status.sub_code));
  writer.text(status.name, status_name_size);
  writer.text(status.text, status.text.size() + 1);
  return writer.take();
}

Status status_of(ByteView content) {
  Reader reader(content);
  Status status;
  status.code = static_cast<Status::Code>(reader.number<std::uint16_t>());
  status.sub_code = static_cast<std::int64_t>(reader.number<std::uint64_t>());
  status.name = reader.text(status_name_size);
  status.text = reader.text(reader.left());
  return status;
}

Bytes string_content(std::string_view text) {
  if (text.size() > longest_string) throw InvalidInput(say("igtl-text-too-long", text.size()));
  const bool ascii = std::all_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x80; });
  Writer writer;
  writer.number(ascii ? us_ascii : utf_8);
  writer.number(static_cast<std::uint16_t>(text.size()));
  writer.raw(text);
  return writer.take();
}

std::string string_of(ByteView content) {
  Reader reader(content);
  reader.number<std::uint16_t>();  // the encoding
  return reader.text(reader.number<std::uint16_t>());
}

Bytes content_of(const std::vector<Point>& points) {
  Writer writer;
  for (const Point& point : points) {
    writer.text(point.name, point_name_size);
    writer.text(point.group, point_group_size);
    writer.raw(point.rgba);
    write(writer, point.position);
    writer.real(point.diameter);
    writer.text(point.owner, point_owner_size);
  }
  return writer.take();
}

std::vector<Point> points_of(ByteView content) {
  if (content.size() % point_size != 0) throw InvalidInput(say("igtl-ends-early"));
  std::vector<Point> points(content.size() / point_size);
  Reader reader(content);
  for (Point& point : points) {
    point.name = reader.utf8(point_name_size);
    point.group = reader.text(point_group_size);
    std::ranges::copy(reader.raw(point.rgba.size()), point.rgba.begin());
    point.position = read_vector(reader);
    point.diameter = reader.real();
    point.owner = reader.text(point_owner_size);
  }
  return points;
}

}  // namespace palpate::plugin::igtl

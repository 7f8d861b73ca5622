#include "plugin/openigtlink/image.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>

#include "plugin/messages/messages.h"
#include "plugin/openigtlink/contents.h"

namespace palpate::plugin::igtl {
namespace {

constexpr std::uint8_t big = 1, little = 2, ras = 1, lps = 2;

std::size_t bytes_of_number(Image::Number number) {
  if (number == Image::Number::i8 || number == Image::Number::u8) return 1;
  return number == Image::Number::i16 || number == Image::Number::u16 ? 2 : 4;
}

const char* nrrd_name(Image::Number number) {
  constexpr const char* names[] = {"int8", "uint8", "int16", "uint16", "int32", "uint32"};
  return names[static_cast<int>(number) - static_cast<int>(Image::Number::i8)];
}

/// From the image's center to the center of its first voxel.
glm::dvec3 to_first(const Image& image) {
  return -0.5 * (static_cast<double>(image.size.x - 1) * image.along[0] +
                 static_cast<double>(image.size.y - 1) * image.along[1] +
                 static_cast<double>(image.size.z - 1) * image.along[2]);
}

glm::dvec3 read_place(Reader& reader, bool is_ras) {
  glm::dvec3 v;
  for (int axis = 0; axis < 3; ++axis) v[axis] = reader.real();
  if (!std::isfinite(v.x + v.y + v.z)) throw InvalidInput(say("igtl-not-a-number"));
  return is_ras ? lps_of(v) : v;
}

glm::ivec3 read_size(Reader& reader) {
  glm::ivec3 size;
  for (int axis = 0; axis < 3; ++axis) size[axis] = reader.number<std::uint16_t>();
  return size;
}

}  // namespace

Image image_of(ByteView content) {
  Reader reader(content);
  reader.number<std::uint16_t>();  // version
  const auto components = reader.number<std::uint8_t>(), type = reader.number<std::uint8_t>();
  const auto endian = reader.number<std::uint8_t>(), coordinates = reader.number<std::uint8_t>();
  if (components != 1 || type < static_cast<int>(Image::Number::i8) || type > static_cast<int>(Image::Number::u32)) {
    throw InvalidInput(say("igtl-not-labels"));
  }
  if ((endian != big && endian != little) || (coordinates != ras && coordinates != lps)) {
    throw InvalidInput(say("igtl-not-an-image"));
  }
  Image image;
  image.number = static_cast<Image::Number>(type);
  image.big_endian = endian == big;
  image.size = read_size(reader);
  for (glm::dvec3& along : image.along) along = read_place(reader, coordinates == ras);
  const glm::dvec3 center = read_place(reader, coordinates == ras);
  image.first = center + to_first(image);
  const glm::ivec3 offset = read_size(reader), part = read_size(reader);
  if (offset != glm::ivec3(0) || part != image.size) throw InvalidInput(say("igtl-part-of-an-image"));
  const std::size_t bytes = static_cast<std::size_t>(image.size.x) * static_cast<std::size_t>(image.size.y) *
                            static_cast<std::size_t>(image.size.z) * bytes_of_number(image.number);
  if (bytes == 0 || bytes != reader.left()) throw InvalidInput(say("igtl-not-an-image"));
  image.voxels = reader.raw(bytes);
  return image;
}

Bytes content_of(const Image& image) {
  Writer writer;
  writer.number(std::uint16_t{1});
  writer.number(std::uint8_t{1});
  writer.number(static_cast<std::uint8_t>(image.number));
  writer.number(image.big_endian ? big : little);
  writer.number(ras);
  for (int axis = 0; axis < 3; ++axis) writer.number(static_cast<std::uint16_t>(image.size[axis]));
  for (const glm::dvec3& place : {image.along[0], image.along[1], image.along[2], image.first - to_first(image)}) {
    const glm::dvec3 v = ras_of(place);
    for (int axis = 0; axis < 3; ++axis) writer.real(v[axis]);
  }
  for (int axis = 0; axis < 3; ++axis) writer.number(std::uint16_t{0});
  for (int axis = 0; axis < 3; ++axis) writer.number(static_cast<std::uint16_t>(image.size[axis]));
  writer.raw(image.voxels);
  return writer.take();
}

void write_nrrd(const Image& image, const std::filesystem::path& file) {
  const auto in_words = [](const glm::dvec3& v) { return fmt::format("({:.9g},{:.9g},{:.9g})", v.x, v.y, v.z); };
  std::ofstream stream(file, std::ios::binary);
  stream << fmt::format(
      "NRRD0005\ntype: {}\ndimension: 3\nspace: left-posterior-superior\nsizes: {} {} {}\n"
      "space directions: {} {} {}\nkinds: domain domain domain\nendian: {}\nencoding: raw\nspace origin: {}\n\n",
      nrrd_name(image.number), image.size.x, image.size.y, image.size.z, in_words(image.along[0]),
      in_words(image.along[1]), in_words(image.along[2]), image.big_endian ? "big" : "little", in_words(image.first));
  stream.write(reinterpret_cast<const char*>(image.voxels.data()), static_cast<std::streamsize>(image.voxels.size()));
  stream.close();
  if (!stream) throw Refusal(plugin::say("cannot-be-written", file.string()));
}

}  // namespace palpate::plugin::igtl

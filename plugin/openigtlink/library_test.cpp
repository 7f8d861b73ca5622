// Each message against Debian's OpenIGTLink library: the same bytes, and the same values read back.

#include <gtest/gtest.h>
#include <igtlImageMessage.h>
#include <igtlPointMessage.h>
#include <igtlPolyDataMessage.h>
#include <igtlStatusMessage.h>
#include <igtlStringMessage.h>
#include <igtlTransformMessage.h>

#include <random>

#include "plugin/openigtlink/contents.h"
#include "plugin/openigtlink/image.h"
#include "plugin/openigtlink/message.h"
#include "plugin/openigtlink/surface.h"

namespace palpate::plugin::igtl {
namespace {

constexpr unsigned seconds = 1'700'000'000, fraction = 0x8000'0000;
constexpr double time_s = seconds + 0.5;

template <typename LibraryMessage>
Bytes bytes_of(LibraryMessage& message, const std::string& device) {
  message->SetDeviceName(device.c_str());
  message->SetTimeStamp(seconds, fraction);
  message->Pack();
  const auto* first = static_cast<const std::uint8_t*>(message->GetPackPointer());
  return {first, first + message->GetPackSize()};
}

Bytes bytes_of(const std::string& type, const std::string& device, Bytes content) {
  Bytes wire;
  append(wire, {.type = type, .device = device, .time_s = time_s, .content = std::move(content)});
  return wire;
}

struct Seeded {
  std::mt19937 generator{7};
  double number() { return static_cast<float>(std::uniform_real_distribution<float>(-300, 300)(generator)); }
  glm::dvec3 vector() {
    const double x = number(), y = number();
    return {x, y, number()};
  }
  /// With letters outside ASCII, and of every length up to one more than fits.
  std::string text(std::size_t most) {
    std::string text(generator() % (most + 2), ' ');
    for (char& c : text) c = static_cast<char>(1 + generator() % 255);
    return text;
  }
};

TEST(OpenIgtLibrary, TransformsAreTheSameBytes) {
  Seeded seeded;
  for (int n = 0; n < 100; ++n) {
    const Transform transform{.rotation = {seeded.vector(), seeded.vector(), seeded.vector()},
                              .translation = seeded.vector()};
    ::igtl::Matrix4x4 matrix;
    ::igtl::IdentityMatrix(matrix);
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) {
        matrix[row][column] = static_cast<float>(transform.rotation[column][row]);
      }
      matrix[row][3] = static_cast<float>(transform.translation[row]);
    }
    auto message = ::igtl::TransformMessage::New();
    message->SetMatrix(matrix);
    const std::string device = seeded.text(device_size);
    const Bytes theirs = bytes_of(message, device);
    EXPECT_EQ(bytes_of("TRANSFORM", device, content_of(transform)), theirs);
    const Transform back = transform_of(ByteView(theirs).subspan(header_size));
    EXPECT_EQ(back.rotation, transform.rotation);
    EXPECT_EQ(back.translation, transform.translation);
  }
}

TEST(OpenIgtLibrary, StatusAndStringsAreTheSameBytes) {
  Seeded seeded;
  for (int n = 0; n < 100; ++n) {
    const Status status{.code = Status::Code::configuration_error,
                        .sub_code = -static_cast<std::int64_t>(seeded.generator()),
                        .name = seeded.text(19),
                        .text = seeded.text(200)};
    auto message = ::igtl::StatusMessage::New();
    message->SetCode(static_cast<int>(status.code));
    message->SetSubCode(status.sub_code);
    message->SetErrorName(status.name.c_str());
    message->SetStatusString(status.text.c_str());
    const Bytes theirs = bytes_of(message, "Palpate");
    EXPECT_EQ(bytes_of("STATUS", "Palpate", content_of(status)), theirs);
    EXPECT_EQ(status_of(ByteView(theirs).subspan(header_size)).text, status.text);
    EXPECT_EQ(status_of(ByteView(theirs).subspan(header_size)).sub_code, status.sub_code);

    std::string text = seeded.text(2000);
    const bool ascii = std::all_of(text.begin(), text.end(), [](char c) { return c > 0; });
    auto string = ::igtl::StringMessage::New();
    string->SetString(text);
    string->SetEncoding(ascii ? 3 : 106);
    const Bytes string_bytes = bytes_of(string, "PalpateScene");
    EXPECT_EQ(bytes_of("STRING", "PalpateScene", string_content(text)), string_bytes);
    EXPECT_EQ(string_of(ByteView(string_bytes).subspan(header_size)), text);
  }
}

TEST(OpenIgtLibrary, PointsAreTheSameBytes) {
  Seeded seeded;
  for (int n = 0; n < 20; ++n) {
    std::vector<Point> points(static_cast<std::size_t>(n));
    auto message = ::igtl::PointMessage::New();
    for (Point& point : points) {
      point = {.name = seeded.text(63),
               .group = seeded.text(31),
               .rgba = {1, 2, 3, 4},
               .position = seeded.vector(),
               .diameter = seeded.number(),
               .owner = seeded.text(19)};
      // Names are read as UTF-8; ASCII stays as it is.
      if (n % 2 == 0) {
        for (char& c : point.name) c = static_cast<char>(1 + (c & 0x7f) % 127);
      }
      auto element = ::igtl::PointElement::New();
      element->SetName(point.name.c_str());
      element->SetGroupName(point.group.c_str());
      element->SetRGBA(1, 2, 3, 4);
      element->SetPosition(static_cast<float>(point.position.x), static_cast<float>(point.position.y),
                           static_cast<float>(point.position.z));
      element->SetRadius(static_cast<float>(point.diameter));
      element->SetOwner(point.owner.c_str());
      message->AddPointElement(element);
    }
    const Bytes theirs = bytes_of(message, "PalpateMarks");
    EXPECT_EQ(bytes_of("POINT", "PalpateMarks", content_of(points)), theirs);
    const std::vector<Point> back = points_of(ByteView(theirs).subspan(header_size));
    ASSERT_EQ(back.size(), points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_EQ(back[i].position, points[i].position);
      if (n % 2 != 0) continue;
      EXPECT_EQ(back[i].name, points[i].name.substr(0, 64));
    }
  }
}

TEST(OpenIgtLibrary, SurfacesAreTheSameBytes) {
  Seeded seeded;
  Surface surface;
  auto points = ::igtl::PolyDataPointArray::New();
  auto polygons = ::igtl::PolyDataCellArray::New();
  for (std::uint32_t n = 0; n < 40; ++n) {
    surface.points.push_back(seeded.vector());
    points->AddPoint(static_cast<float>(surface.points.back().x), static_cast<float>(surface.points.back().y),
                     static_cast<float>(surface.points.back().z));
    if (n < 2) continue;
    surface.triangles.push_back({n - 2, n, n - 1});
    polygons->AddCell(3, surface.triangles.back().data());
  }
  auto message = ::igtl::PolyDataMessage::New();
  message->SetPoints(points);
  message->SetPolygons(polygons);
  const Bytes theirs = bytes_of(message, "liver");
  EXPECT_EQ(bytes_of("POLYDATA", "liver", content_of(surface)), theirs);
  const Surface back = surface_of(ByteView(theirs).subspan(header_size));
  EXPECT_EQ(back.points, surface.points);
  EXPECT_EQ(back.triangles, surface.triangles);
}

// The library's origin is the field that 3D Slicer and the specification read as the center: of one voxel both are one.
TEST(OpenIgtLibrary, ImagesAreTheSameBytes) {
  Seeded seeded;
  for (const auto number : {Image::Number::u8, Image::Number::i16, Image::Number::u16, Image::Number::i32}) {
    const std::vector<int> sizes{3, 4, 5};
    const glm::dvec3 center = seeded.vector();
    auto message = ::igtl::ImageMessage::New();
    message->SetDimensions(3, 4, 5);
    message->SetScalarType(static_cast<int>(number));
    message->SetEndian(::igtl::ImageMessage::ENDIAN_LITTLE);
    message->SetSpacing(0.5F, 2.0F, 3.0F);
    message->SetOrigin(static_cast<float>(center.x), static_cast<float>(center.y), static_cast<float>(center.z));
    message->AllocateScalars();
    auto* voxels = static_cast<std::uint8_t*>(message->GetScalarPointer());
    const auto count = static_cast<std::size_t>(message->GetImageSize());
    for (std::size_t n = 0; n < count; ++n) voxels[n] = static_cast<std::uint8_t>(seeded.generator());
    const Bytes theirs = bytes_of(message, "liver");

    const Image image = image_of(ByteView(theirs).subspan(header_size));
    EXPECT_EQ(image.number, number);
    EXPECT_EQ(image.size, glm::ivec3(3, 4, 5));
    EXPECT_EQ(image.along[0], glm::dvec3(-0.5, 0, 0)) << "LPS";
    EXPECT_EQ(image.along[2], glm::dvec3(0, 0, 3));
    const glm::dvec3 middle = image.first + image.along[0] + 1.5 * image.along[1] + 2.0 * image.along[2];
    EXPECT_LT(glm::length(middle - lps_of(center)), 1e-12);
    EXPECT_EQ(image.voxels.size(), count);
    EXPECT_EQ(bytes_of("IMAGE", "liver", content_of(image)), theirs);
  }
}

}  // namespace
}  // namespace palpate::plugin::igtl

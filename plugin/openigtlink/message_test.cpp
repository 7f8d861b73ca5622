// Laws of the protocol that need no peer: headers, checksums, version 2, and streams that are truncated, false or
// damaged.

#include "plugin/openigtlink/message.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <random>

#include "io/structures/structure.h"
#include "plugin/openigtlink/contents.h"
#include "plugin/openigtlink/image.h"
#include "plugin/openigtlink/receiver.h"
#include "plugin/openigtlink/surface.h"
#include "plugin/testing/test_files.h"

namespace palpate::plugin::igtl {
namespace {

Bytes of_text(std::string_view text) {
  return {text.begin(), text.end()};
}

// The check value of CRC-64/ECMA-182 in the catalogue of parametrised CRC algorithms (reveng.sourceforge.io).
TEST(OpenIgtMessage, ChecksumIsEcma182) {
  EXPECT_EQ(checksum(of_text("123456789")), 0x6C40DF5F0B497347U);
  EXPECT_EQ(checksum({}), 0U);
}

/// Whatever a sender writes, and wherever it cuts.
TEST(OpenIgtMessage, NamesAreReadAsUtf8AndCutBehindWholeCharacters) {
  const auto read = [](const std::string& raw, std::size_t room) {
    Bytes bytes = of_text(raw);
    bytes.resize(room);
    return Reader(bytes).utf8(room);
  };
  EXPECT_EQ(read("L\xe4sion", 20), "L\u00e4sion") << "Latin-1";
  EXPECT_EQ(read("L\xc3\xa4sion", 20), "L\u00e4sion");
  EXPECT_EQ(read("L\xe4", 20), "L\u00e4") << "not cut";
  const std::string letters = "a\u00e4\u20ac\U0001f9e0";  // of 1, 2, 3 and 4 bytes
  const std::vector<std::size_t> whole{0, 1, 1, 3, 3, 3, 6, 6, 6, 6, 10};
  for (std::size_t room = 1; room < whole.size(); ++room) {
    EXPECT_EQ(read(letters.substr(0, room), room), letters.substr(0, whole[room])) << room;
  }
}

// The layout of the specification, byte by byte: an extended header of 12 bytes, the content, a table of key and value
// sizes, keys and values.
TEST(OpenIgtMessage, Version2HasItsPartsInTheirPlaces) {
  const Message message{
      .type = "STRING", .device = "D", .time_s = 1.5, .content = string_content("hey"), .metadata = {{"key", "value"}}};
  Bytes wire;
  append(wire, message, 2);
  Bytes body = of_text(std::string("\0\x0C\0\x0A\0\0\0\x08\0\0\0\0", 12));
  for (const auto& part :
       {std::string("\0\3\0\3hey", 7), std::string("\0\1\0\3\0\3\0\0\0\5", 10), std::string("keyvalue")}) {
    body.insert(body.end(), part.begin(), part.end());
  }
  EXPECT_EQ(Bytes(wire.begin() + header_size, wire.end()), body);
  const Header header = read_header(wire);
  EXPECT_EQ(header.version, 2);
  EXPECT_EQ(header.time_s, 1.5);
  const Message back = read_message(header, body);
  EXPECT_EQ(back.content, message.content);
  EXPECT_EQ(back.metadata, message.metadata);
}

// Whatever sizes an extended header claims, its parts lie within the body or the message is refused.
TEST(OpenIgtMessage, Version2ThatLiesIsRefused) {
  std::mt19937 seeded(3);
  int refused = 0;
  for (int n = 0; n < 20000; ++n) {
    Bytes wire;
    append(wire, {.type = "STRING", .device = "D", .content = string_content("hey"), .metadata = {{"key", "value"}}},
           2);
    const Header header = read_header(wire);
    Bytes body(wire.begin() + header_size, wire.end());
    for (int changes = 0; changes < 1 + n % 3; ++changes) {
      body[seeded() % body.size()] = static_cast<std::uint8_t>(n % 2 == 0 ? 0xFF : seeded());
    }
    try {
      EXPECT_LE(read_message(header, body).content.size(), body.size());
    } catch (const InvalidInput&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 1000);
}

std::vector<Message> some_messages() {
  std::vector<Message> messages;
  for (int n = 0; n < 20; ++n) {
    messages.push_back({.type = n % 3 == 0 ? "STRING" : "STATUS",
                        .device = "device " + std::to_string(n),
                        .time_s = n * 0.25,
                        .content = n % 3 == 0 ? string_content(std::string(static_cast<std::size_t>(37 * n), 'x'))
                                              : content_of(Status{.text = std::to_string(n)})});
  }
  messages.push_back({.type = "GET_STATUS", .device = "", .content = {}});
  return messages;
}

const auto everything = [](const Header&) { return std::size_t{1} << 20U; };

// The same messages arrive in whatever pieces the bytes come.
TEST(OpenIgtReceiver, PiecesOfAnySizeGiveTheSameMessages) {
  const std::vector<Message> sent = some_messages();
  Bytes wire;
  for (std::size_t n = 0; n < sent.size(); ++n) append(wire, sent[n], n % 2 == 0 ? 1 : 2);
  for (std::size_t piece : {1U, 2U, 57U, 58U, 59U, 1000U, 100000U}) {
    Receiver receiver(everything);
    std::vector<Message> got;
    for (std::size_t at = 0; at < wire.size(); at += piece) {
      receiver.take(ByteView(wire).subspan(at, std::min(piece, wire.size() - at)),
                    [&](Message&& message) { got.push_back(std::move(message)); });
    }
    ASSERT_EQ(got.size(), sent.size()) << piece;
    for (std::size_t n = 0; n < sent.size(); ++n) {
      EXPECT_EQ(got[n].device, sent[n].device);
      EXPECT_EQ(got[n].content, sent[n].content);
    }
  }
}

TEST(OpenIgtReceiver, AMessageThatIsDamagedIsDroppedAndTheNextOneArrives) {
  Bytes wire;
  append(wire, {.type = "STATUS", .device = "a", .content = content_of(Status{.text = "first"})});
  wire.back() ^= 1U;
  append(wire, {.type = "STATUS", .device = "b", .content = content_of(Status{.text = "second"})});
  Receiver receiver(everything);
  std::vector<std::string> got;
  receiver.take(wire, [&](const Message& message) { got.push_back(message.device); });
  EXPECT_EQ(got, std::vector<std::string>{"b"});
  EXPECT_EQ(receiver.dropped(), 1U);
  EXPECT_EQ(receiver.why_dropped(), "the message's checksum is wrong");
}

// Also a body of more bytes than any machine has.
TEST(OpenIgtReceiver, WhatIsNotWantedIsPassedOverWithoutMemory) {
  Bytes wire;
  append(wire, {.type = "VIDEO", .device = "", .content = Bytes(5000)});
  append(wire, {.type = "STATUS", .device = "b", .content = content_of(Status{})});
  Receiver receiver([](const Header& header) { return header.type == "STATUS" ? std::size_t{1000} : 0; });
  std::vector<std::string> got;
  receiver.take(wire, [&](const Message& message) { got.push_back(message.device); });
  EXPECT_EQ(got, std::vector<std::string>{"b"});
  EXPECT_EQ(receiver.passed_over(), 1U);
  Bytes endless;
  append(endless, {.type = "VIDEO", .device = "", .content = {}});
  std::fill(endless.begin() + 42, endless.begin() + 50, std::uint8_t{0xFF});
  for (int n = 0; n < 1000; ++n) receiver.take(n == 0 ? endless : Bytes(100000), [](const Message&) { FAIL(); });
}

TEST(OpenIgtReceiver, ABodyOfMoreThanIsWantedEndsTheStreamAtItsHeader) {
  Bytes wire;
  append(wire, {.type = "STRING", .device = "", .content = {}});
  std::fill(wire.begin() + 42, wire.begin() + 50, std::uint8_t{0x7F});
  Receiver receiver([](const Header&) { return std::size_t{65540}; });
  EXPECT_THROW(receiver.take(wire, [](const Message&) {}), InvalidInput);
}

TEST(OpenIgtContents, SizesThatLieAreRefusedBeforeMemoryIsTaken) {
  Writer lying;
  lying.number(0xFFFFFFFFU);
  for (int n = 0; n < 9; ++n) lying.number(0xFFFFFFF0U);
  EXPECT_THROW(surface_of(lying.take()), InvalidInput);
  EXPECT_THROW(points_of(Bytes(point_size + 1)), InvalidInput);
  Writer long_text;
  long_text.number(std::uint16_t{3});
  long_text.number(std::uint16_t{65535});
  EXPECT_THROW(string_of(long_text.take()), InvalidInput);
}

/// A ball in an oblique lattice, which the peer's image places by its center.
struct Ball {
  glm::ivec3 size{24, 20, 16};
  Bytes voxels;
  Image image;
  glm::dvec3 center{10, -20, 30};

  explicit Ball(Image::Number number, bool big_endian, std::uint8_t label) {
    image.number = number;
    image.big_endian = big_endian;
    image.size = size;
    image.along = {glm::dvec3(0.8, 0.6, 0), glm::dvec3(-0.6, 0.8, 0), glm::dvec3(0, 0, 1.5)};
    image.first = center - 11.5 * image.along[0] - 9.5 * image.along[1] - 7.5 * image.along[2];
    const std::size_t bytes = number == Image::Number::u8 ? 1 : number == Image::Number::u16 ? 2 : 4;
    for (int k = 0; k < size.z; ++k) {
      for (int j = 0; j < size.y; ++j) {
        for (int i = 0; i < size.x; ++i) {
          const glm::dvec3 from = glm::dvec3(i, j, k) - 0.5 * glm::dvec3(size - 1);
          const bool inside = glm::length(from * glm::dvec3(1, 1, 1.5)) < 8;
          Bytes voxel(bytes);
          voxel[big_endian ? bytes - 1 : 0] = inside ? label : 0;
          voxels.insert(voxels.end(), voxel.begin(), voxel.end());
        }
      }
    }
    image.voxels = voxels;
  }
};

// In every type and byte order: the structure that io reads from the file lies where the peer said.
TEST(OpenIgtContents, ALabelMapArrivesWhereItsSenderPlacedIt) {
  for (const auto number : {Image::Number::u8, Image::Number::u16, Image::Number::i32}) {
    for (const bool big_endian : {false, true}) {
      const Ball ball(number, big_endian, 5);
      const Bytes content = content_of(ball.image);
      const auto file = plugin::testing::fresh_path("ball.nrrd");
      write_nrrd(image_of(content), file);
      const auto found = io::find_structures(std::vector{file});
      ASSERT_EQ(found.structures.size(), 1U);
      EXPECT_EQ(found.structures.front().number, 5);
      const io::StructureMeasures measures = io::measure(found.structures.front());
      EXPECT_LT(glm::length(measures.centroid_mm - ball.center), 1e-4);
      EXPECT_NEAR(measures.volume_mm3, 4.0 / 3 * 3.14159 * 512, 60);
    }
  }
}

}  // namespace
}  // namespace palpate::plugin::igtl

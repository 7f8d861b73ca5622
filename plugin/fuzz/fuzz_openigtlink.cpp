// libFuzzer's way into OpenIGTLink: the first byte chooses what the others are, a stream of messages or the body of
// one. Bodies are tried without their checksum, which no fuzzer would find.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>

#include "plugin/openigtlink/contents.h"
#include "plugin/openigtlink/image.h"
#include "plugin/openigtlink/receiver.h"
#include "plugin/openigtlink/surface.h"

namespace igtl = palpate::plugin::igtl;

namespace {

void read_stream(igtl::ByteView bytes) {
  igtl::Receiver receiver([](const igtl::Header& header) { return header.device.size() * 1000; });
  std::size_t got = 0;
  while (!bytes.empty()) {  // in pieces of uneven sizes
    const std::size_t count = 1 + bytes.size() * 5 % 97 % bytes.size();
    receiver.take(bytes.first(count), [&](const igtl::Message& message) { got += message.content.size(); });
    bytes = bytes.subspan(count);
  }
}

void read_content(int kind, igtl::ByteView bytes) {
  switch (kind) {
    case 0:
      return read_stream(bytes);
    case 1:
      igtl::read_message({.version = 2, .type = "STRING"}, {bytes.begin(), bytes.end()});
      return;
    case 2:
      igtl::transform_of(bytes);
      return;
    case 3:
      igtl::status_of(bytes);
      return;
    case 4:
      igtl::string_of(bytes);
      return;
    case 5:
      // What was read is written as it came.
      if (const auto points = igtl::points_of(bytes); igtl::content_of(points).size() != bytes.size()) std::abort();
      return;
    case 6:
      if (const auto image = igtl::image_of(bytes); igtl::content_of(image).size() != bytes.size()) std::abort();
      return;
    default:
      igtl::surface_of(bytes);
  }
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): the name that libFuzzer calls.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  try {
    read_content(data[0] % 8, {data + 1, size - 1});
  } catch (const std::invalid_argument&) {
  }
  return 0;
}

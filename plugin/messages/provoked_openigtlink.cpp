#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "plugin/messages/provoked.h"
#include "plugin/openigtlink/contents.h"
#include "plugin/openigtlink/image.h"
#include "plugin/openigtlink/marks.h"
#include "plugin/openigtlink/receiver.h"
#include "plugin/openigtlink/requests.h"

namespace palpate::plugin::testing {
namespace {

using palpate::testing::said_when;

/// The content of a label map of eight voxels, with one byte changed.
igtl::Bytes labels_with(std::size_t byte, std::uint8_t value) {
  const igtl::Bytes voxels(8);
  igtl::Image image;
  image.size = glm::ivec3(2);
  image.along = {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)};
  image.voxels = voxels;
  igtl::Bytes content = content_of(image);
  content.at(byte) = value;
  return content;
}

/// The message about a stream of bytes.
std::string said_of(const igtl::Bytes& wire) {
  return said_when([&] {
    igtl::Receiver([](const igtl::Header&) { return std::size_t{100}; }).take(wire, [](const igtl::Message&) {});
  });
}

std::string said_of_a_damaged_one() {
  igtl::Bytes wire;
  igtl::append(wire, {.type = "STATUS", .device = "", .content = igtl::Bytes(3)});
  wire.back() = 1;
  igtl::Receiver receiver([](const igtl::Header&) { return std::size_t{100}; });
  receiver.take(wire, [](const igtl::Message&) {});
  return receiver.why_dropped();
}

igtl::Bytes status_of_size(std::size_t size) {
  igtl::Bytes wire;
  igtl::append(wire, {.type = "STATUS", .device = "", .content = igtl::Bytes(size)});
  return wire;
}

}  // namespace

std::vector<Provoked> provoke_openigtlink() {
  const igtl::Point nowhere{.position = glm::dvec3(std::numeric_limits<double>::quiet_NaN())};
  return {
      {"igtl-ends-early", said_when([] { igtl::status_of(igtl::Bytes(7)); })},
      {"igtl-not-a-message", said_of(igtl::Bytes(igtl::header_size, 'G'))},
      {"igtl-wrong-checksum", said_of_a_damaged_one()},
      {"igtl-body-too-large", said_of(status_of_size(101))},
      {"igtl-not-a-number", said_when([&] { igtl::points_of(content_of(std::vector{nowhere})); })},
      {"igtl-text-too-long", said_when([] { igtl::string_content(std::string(65536, ' ')); })},
      {"igtl-not-labels", said_when([] { igtl::image_of(labels_with(3, 10)); })},
      {"igtl-not-an-image", said_when([] { igtl::image_of(labels_with(4, 9)); })},
      {"igtl-cannot-listen", said_when([] { igtl::Server({.host = "no numbers"}); })},
      {"igtl-file-from-elsewhere", said_when([] {
         igtl::internal::check_file({.client = 1, .from_this_machine = false, .message = {}}, "/scans/liver.nrrd");
       })},
      {"igtl-no-scan", said_when([] { igtl::internal::check_scan(false); })},
      {"igtl-too-many-marks", said_when([] {
         std::vector<igtl::Point> marks(igtl::most_marks + 1);
         for (std::size_t n = 0; n < marks.size(); ++n) marks[n].position.x = static_cast<double>(n);
         igtl::changed_marks({}, marks);
       })},
      {"igtl-part-of-an-image", said_when([] { igtl::image_of(labels_with(61, 1)); })},
  };
}

}  // namespace palpate::plugin::testing

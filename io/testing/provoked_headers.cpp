#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcdeftag.h>

#include <cstddef>
#include <filesystem>
#include <string>

#include "io/testing/provoked_scans.h"

namespace palpate::io::testing {
namespace {

using namespace std::string_literals;

const std::string item = "\xFE\xFF\x00\xE0"s;
const std::string unknown = "\xFF\xFF\xFF\xFF"s;
const std::string nothing = "\0\0\0\0"s;
const std::string open_sequence = "\x08\x00\x40\x11SQ\0\0"s + unknown;

/// A file whose elements, in explicit little endian, are these.
std::string of_elements(const std::string& elements) {
  return of_bytes([&](const std::string& b) { return b.substr(0, b.find("\x08\x00\x08\x00"s)) + elements; });
}

std::string repeated(const std::string& bytes, int count) {
  std::string all;
  for (int n = 0; n < count; ++n) all += bytes;
  return all;
}

std::string descending_elements() {
  std::string all;
  for (int n = 0xFFFF; n > 0xE000; --n) {
    all += "\x09\x00"s + static_cast<char>(n & 0xFF) + static_cast<char>(n >> 8) + "LO\0\0"s;
  }
  return all;
}

/// An image whose header holds one element of 300 MiB, which are a hole on the disk.
std::string of_a_long_header() {
  return said_of([](const TestFolder& folder) {
    internal::write({}, folder / "long.dcm");
    const std::string bytes = bytes_of(folder / "long.dcm");
    constexpr std::size_t length = 300U << 20;
    const std::string element = "\x09\x00\x01\x10OB\0\0"s + "\0\0\xC0\x12"s;  // 300 MiB, little endian
    const std::string head = bytes.substr(0, bytes.find("\x08\x00\x08\x00"s)) + element;
    write_bytes(folder / "long.dcm", head);
    std::filesystem::resize_file(folder / "long.dcm", head.size() + length);
  });
}

/// The image, in a deflated syntax, whose deflated bytes are edited.
std::string of_deflated(const std::function<std::string(std::string)>& damage) {
  return said_of([&](const TestFolder& folder) {
    TestImage image;
    image.syntax = EXS_DeflatedLittleEndianExplicit;
    internal::write(image, folder / "a.dcm");
    write_bytes(folder / "a.dcm", damage(bytes_of(folder / "a.dcm")));
  });
}

}  // namespace

std::vector<Provoked> provoke_headers() {
  return {
      {"empty-file", of_bytes([](const std::string&) { return std::string(); })},
      {"not-a-dicom-file", of_bytes([](const std::string&) { return std::string(600, 'x'); })},
      {"truncated-in-its-header", of_bytes([](const std::string& b) { return b.substr(0, b.find("1.2.3.4") + 3); })},
      {"truncated-pixels", of_bytes([](const std::string& b) { return b.substr(0, b.size() - 10); })},
      {"damaged-no-dataset",
       of_bytes([](const std::string& b) { return b.substr(0, 200) + std::string(200, '\xee'); })},
      {"damaged-its-sequences-are-nested-too-deeply", of_elements(repeated(open_sequence + item + unknown, 100))},
      {"sequence-is-not-items", of_elements(open_sequence + "no item."s)},
      {"damaged-its-header-is-in-disorder", of_elements(descending_elements())},
      {"damaged-its-header-has-no-end", of_elements(open_sequence + repeated(item + nothing, 4'000'001))},
      {"header-is-larger-than-256-mib", of_a_long_header()},
      {"damaged-header",
       of_deflated([](const std::string& b) { return b.substr(0, b.size() - 200) + std::string(200, '\xee'); })},
  };
}

}  // namespace palpate::io::testing

#include "palpate/io/internal/pixels.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcuid.h>
#include <dcmtk/dcmdata/dcxfer.h>
#include <fcntl.h>
#include <unistd.h>

#include <bit>
#include <vector>

#include "palpate/io/errors.h"

namespace palpate::io::internal {
namespace {

class OpenFile {
 public:
  explicit OpenFile(const std::filesystem::path& path) : descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
    if (descriptor_ < 0) throw DicomError("cannot be opened: check that it still exists and may be read");
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  ~OpenFile() { ::close(descriptor_); }

  void read(std::uint64_t at, std::span<std::byte> into) const {
    while (!into.empty()) {
      const ssize_t got = ::pread(descriptor_, into.data(), into.size(), static_cast<off_t>(at));
      if (got <= 0) throw DicomError("truncated: its pixels end early");
      at += static_cast<std::uint64_t>(got);
      into = into.subspan(static_cast<std::size_t>(got));
    }
  }

 private:
  int descriptor_;
};

void swap_bytes(std::span<std::uint16_t> values) {
  for (auto& v : values) v = static_cast<std::uint16_t>(v << 8 | v >> 8);
}

// Brings the stored bits down to bit 0 and extends the sign.
void clean_bits(const PixelFormat& format, std::span<std::uint16_t> values) {
  if (format.bits_stored == 16) return;
  const int above = 15 - format.high_bit;
  const int total = 16 - format.bits_stored;
  if (format.is_signed) {
    for (auto& v : values) {
      const auto top = static_cast<std::int16_t>(static_cast<std::uint16_t>(v << above));
      v = static_cast<std::uint16_t>(top >> total);
    }
  } else {
    for (auto& v : values) v = static_cast<std::uint16_t>(static_cast<std::uint16_t>(v << above) >> total);
  }
}

void read_native(const FileHeader& header, std::uint32_t frame, std::span<std::uint16_t> values) {
  const std::size_t frame_bytes = header.format.bytes_per_frame();
  const std::uint64_t at = header.pixels_at + frame * frame_bytes;
  const OpenFile file(header.path);
  if (header.format.bits_allocated == 8) {
    std::vector<std::uint8_t> bytes(frame_bytes);
    file.read(at, std::as_writable_bytes(std::span(bytes)));
    std::copy(bytes.begin(), bytes.end(), values.begin());
    return;
  }
  file.read(at, std::as_writable_bytes(values));
  const bool big = header.transfer_syntax == UID_BigEndianExplicitTransferSyntax;
  if (big != (std::endian::native == std::endian::big)) swap_bytes(values);
}

}  // namespace

void read_stored_values(const FileHeader& header, std::uint32_t frame, std::span<std::uint16_t> values) {
  read_native(header, frame, values);
  clean_bits(header.format, values);
}

}  // namespace palpate::io::internal

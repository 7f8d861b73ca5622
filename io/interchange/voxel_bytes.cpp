#include "io/interchange/voxel_bytes.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include "io/dicom/input_file.h"
#include "io/errors.h"
#include "io/interchange/voxel_words.h"
#include "io/messages.h"

namespace palpate::io {
namespace {

[[noreturn]] void refuse_end() {
  throw DicomError(say("voxels-end-early"));
}

class PlainBytes final : public VoxelBytes {
 public:
  explicit PlainBytes(const VoxelFile& file) : file_(file.voxels_at), at_(static_cast<std::uint64_t>(file.first)) {}
  void read(std::span<std::uint8_t> into) override {
    if (at_ > file_.size() || into.size() > file_.size() - at_) refuse_end();
    file_.read(at_, std::as_writable_bytes(into));
    at_ += into.size();
  }
  void skip(std::uint64_t count) override { at_ += count; }

 private:
  internal::InputFile file_;
  std::uint64_t at_;
};

// gzip or zlib, and several of them one behind the other.
class InflatedBytes final : public VoxelBytes {
 public:
  InflatedBytes(const VoxelFile& file, std::uint64_t at) : file_(file.voxels_at), at_(at) {
    constexpr int either = 32;  // zlib finds out which
    if (inflateInit2(&stream_, MAX_WBITS + either) != Z_OK) throw std::bad_alloc();
  }
  ~InflatedBytes() override { inflateEnd(&stream_); }

  void read(std::span<std::uint8_t> into) override {
    for (std::size_t done = 0; done < into.size();) {
      constexpr std::size_t most = std::size_t{1} << 30;
      const auto part = static_cast<uInt>(std::min(most, into.size() - done));
      stream_.next_out = into.data() + done;
      stream_.avail_out = part;
      inflate_some();
      done += part - stream_.avail_out;
    }
  }
  void finish() override {
    std::vector<std::uint8_t> passed(1U << 16);
    while (!at_end_) {
      stream_.next_out = passed.data();
      stream_.avail_out = static_cast<uInt>(passed.size());
      inflate_some();
    }
  }

 private:
  void inflate_some() {
    if (stream_.avail_in == 0) {
      const std::uint64_t count = std::min<std::uint64_t>(window_.size(), file_.size() - std::min(file_.size(), at_));
      if (count == 0) refuse_end();
      file_.read(at_, std::as_writable_bytes(std::span(window_).first(count)));
      at_ += count;
      stream_.next_in = window_.data();
      stream_.avail_in = static_cast<uInt>(count);
    }
    const int status = inflate(&stream_, Z_NO_FLUSH);
    at_end_ = status == Z_STREAM_END;
    if (at_end_) {
      inflateReset(&stream_);
    } else if (status != Z_OK && status != Z_BUF_ERROR) {
      throw DicomError(say("voxels-are-damaged"));
    }
  }

  internal::InputFile file_;
  std::uint64_t at_;
  z_stream stream_{};
  bool at_end_ = false;  // of a part with a checksum of its own
  std::array<std::uint8_t, 1U << 16> window_{};
};

template <typename T>
double value_in(const std::uint8_t* from) noexcept {
  T value;
  std::memcpy(&value, from, sizeof value);
  return static_cast<double>(value);
}

}  // namespace

void VoxelBytes::skip(std::uint64_t count) {
  std::vector<std::uint8_t> passed(std::min<std::uint64_t>(count, 1U << 20));
  while (count > 0) {
    const auto part = std::min<std::uint64_t>(count, passed.size());
    read(std::span(passed).first(part));
    count -= part;
  }
}

double number_at(VoxelFile::Number number, const std::uint8_t* from) noexcept {
  using Number = VoxelFile::Number;
  switch (number) {
    case Number::u8:
      return value_in<std::uint8_t>(from);
    case Number::i8:
      return value_in<std::int8_t>(from);
    case Number::u16:
      return value_in<std::uint16_t>(from);
    case Number::i16:
      return value_in<std::int16_t>(from);
    case Number::u32:
      return value_in<std::uint32_t>(from);
    case Number::i32:
      return value_in<std::int32_t>(from);
    case Number::u64:
      return value_in<std::uint64_t>(from);
    case Number::i64:
      return value_in<std::int64_t>(from);
    case Number::f32:
      return value_in<float>(from);
    case Number::f64:
      break;
  }
  return value_in<double>(from);
}

std::unique_ptr<VoxelBytes> voxel_bytes(const VoxelFile& file) {
  const auto first = static_cast<std::uint64_t>(file.first);
  switch (file.packing) {
    case VoxelFile::Packing::none:
      break;
    case VoxelFile::Packing::bzip2:
      return bunzipped(file);
    case VoxelFile::Packing::ascii:
    case VoxelFile::Packing::hex:
      return voxels_in_words(file);
    case VoxelFile::Packing::behind_it:
      return std::make_unique<InflatedBytes>(file, first);
    case VoxelFile::Packing::whole:
      auto bytes = std::make_unique<InflatedBytes>(file, 0);
      bytes->skip(first);
      return bytes;
  }
  return std::make_unique<PlainBytes>(file);
}

void read_raw_slices(const VoxelFile& file, int volume, int begin, int end,
                     const std::function<bool(int, std::span<const std::uint8_t>)>& slice) {
  const std::size_t number = bytes_of(file.number);
  std::vector<std::uint8_t> raw(file.numbers_of_slice() * number);
  const auto bytes = voxel_bytes(file);
  const std::uint64_t before =
      static_cast<std::uint64_t>(volume) * static_cast<std::uint64_t>(file.size.z) + static_cast<std::uint64_t>(begin);
  bytes->skip(before * raw.size());
  for (int n = begin; n < end; ++n) {
    bytes->read(raw);
    for (std::size_t at = 0; file.swapped && at < raw.size(); at += number) {
      std::reverse(raw.data() + at, raw.data() + at + number);
    }
    if (!slice(n, raw)) return;
  }
  if (begin == 0 && end == file.size.z) bytes->finish();
}

void read_slices(const VoxelFile& file, const std::function<bool(int, std::span<const double>)>& slice) {
  const std::size_t number = bytes_of(file.number);
  std::vector<double> values(file.numbers_of_slice());
  read_raw_slices(file, 0, 0, file.size.z, [&](int n, std::span<const std::uint8_t> raw) {
    for (std::size_t v = 0; v < values.size(); ++v) {
      values[v] = number_at(file.number, raw.data() + v * number) * file.slope + file.offset;
    }
    return slice(file.reversed ? file.size.z - 1 - n : n, values);
  });
}

}  // namespace palpate::io

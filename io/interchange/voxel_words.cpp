#include "io/interchange/voxel_words.h"

#include <archive.h>
#include <archive_entry.h>
#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <charconv>
#include <cstring>
#include <fstream>
#include <string>

#include "io/errors.h"
#include "io/messages.h"

namespace palpate::io {
namespace {

class Bunzipped final : public VoxelBytes {
 public:
  explicit Bunzipped(const VoxelFile& file)
      : file_(::open(file.voxels_at.c_str(), O_RDONLY | O_CLOEXEC)), reader_(archive_read_new(), archive_read_free) {
    constexpr std::size_t block = 1U << 16;
    archive_read_support_filter_bzip2(reader_.get());
    archive_read_support_format_raw(reader_.get());
    archive_entry* entry = nullptr;
    const bool is_open = file_ >= 0 && ::lseek(file_, file.first, SEEK_SET) >= 0 &&
                         archive_read_open_fd(reader_.get(), file_, block) == ARCHIVE_OK &&
                         archive_read_next_header(reader_.get(), &entry) == ARCHIVE_OK;
    if (is_open && archive_filter_code(reader_.get(), 0) == ARCHIVE_FILTER_BZIP2) return;
    close_file();
    throw DicomError(say("voxels-are-damaged"));
  }
  ~Bunzipped() override { close_file(); }

  void read(std::span<std::uint8_t> into) override {
    for (std::size_t done = 0; done < into.size();) done += read_some(into.subspan(done));
  }
  void finish() override {
    std::array<std::uint8_t, 1U << 16> passed{};
    while (archive_read_data(reader_.get(), passed.data(), passed.size()) > 0) {
    }
    if (archive_errno(reader_.get()) != 0) throw DicomError(say("voxels-are-damaged"));
  }

 private:
  std::size_t read_some(std::span<std::uint8_t> into) {
    const la_ssize_t got = archive_read_data(reader_.get(), into.data(), into.size());
    if (got < 0) throw DicomError(say("voxels-are-damaged"));
    if (got == 0) throw DicomError(say("voxels-end-early"));
    return static_cast<std::size_t>(got);
  }
  void close_file() {
    reader_.reset();
    if (file_ >= 0) ::close(file_);
    file_ = -1;
  }

  int file_;
  std::unique_ptr<archive, int (*)(archive*)> reader_;
};

template <typename Number>
void put_number(const std::string& word, std::span<std::uint8_t> into) {
  Number value{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) throw DicomError(say("voxels-in-no-words", word));
  std::memcpy(into.data(), &value, sizeof value);
}

void put_word(VoxelFile::Number number, const std::string& word, std::span<std::uint8_t> into) {
  using Number = VoxelFile::Number;
  switch (number) {
    case Number::u8:
      return put_number<std::uint8_t>(word, into);
    case Number::i8:
      return put_number<std::int8_t>(word, into);
    case Number::u16:
      return put_number<std::uint16_t>(word, into);
    case Number::i16:
      return put_number<std::int16_t>(word, into);
    case Number::u32:
      return put_number<std::uint32_t>(word, into);
    case Number::i32:
      return put_number<std::int32_t>(word, into);
    case Number::u64:
      return put_number<std::uint64_t>(word, into);
    case Number::i64:
      return put_number<std::int64_t>(word, into);
    case Number::f32:
      return put_number<float>(word, into);
    case Number::f64:
      break;
  }
  put_number<double>(word, into);
}

class AsciiNumbers final : public VoxelBytes {
 public:
  explicit AsciiNumbers(const VoxelFile& file) : stream_(file.voxels_at, std::ios::binary), number_(file.number) {
    stream_.seekg(file.first);
  }
  void read(std::span<std::uint8_t> into) override {
    const std::size_t bytes = bytes_of(number_);
    for (std::size_t at = 0; at + bytes <= into.size(); at += bytes) {
      put_word(number_, next_word(), into.subspan(at, bytes));
    }
  }

 private:
  std::string next_word() {
    constexpr std::size_t longest = 64;
    std::string word;
    for (int c = stream_.get(); c != std::ifstream::traits_type::eof(); c = stream_.get()) {
      const bool is_between = c == ' ' || c == ',' || (c >= '\t' && c <= '\r');
      if (is_between && !word.empty()) return word;
      if (!is_between) word += static_cast<char>(c);
      if (word.size() > longest) throw DicomError(say("voxels-in-no-words", word));
    }
    if (word.empty()) throw DicomError(say("voxels-end-early"));
    return word;
  }

  std::ifstream stream_;
  VoxelFile::Number number_;
};

class HexBytes final : public VoxelBytes {
 public:
  explicit HexBytes(const VoxelFile& file) : stream_(file.voxels_at, std::ios::binary) { stream_.seekg(file.first); }
  void read(std::span<std::uint8_t> into) override {
    for (std::uint8_t& byte : into) {
      const int high = next_digit();
      byte = static_cast<std::uint8_t>(16 * high + next_digit());
    }
  }

 private:
  int next_digit() {
    for (int c = stream_.get(); c != std::ifstream::traits_type::eof(); c = stream_.get()) {
      if (c >= '0' && c <= '9') return c - '0';
      if (c >= 'a' && c <= 'f') return c - 'a' + 10;
      if (c >= 'A' && c <= 'F') return c - 'A' + 10;
      if (c != ' ' && (c < '\t' || c > '\r'))
        throw DicomError(say("voxels-in-no-words", std::string(1, static_cast<char>(c))));
    }
    throw DicomError(say("voxels-end-early"));
  }

  std::ifstream stream_;
};

}  // namespace

std::unique_ptr<VoxelBytes> bunzipped(const VoxelFile& file) {
  return std::make_unique<Bunzipped>(file);
}

std::unique_ptr<VoxelBytes> voxels_in_words(const VoxelFile& file) {
  if (file.packing == VoxelFile::Packing::hex) return std::make_unique<HexBytes>(file);
  return std::make_unique<AsciiNumbers>(file);
}

}  // namespace palpate::io

#include "io/dicom/dataset.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcdatset.h>
#include <dcmtk/dcmdata/dcdeftag.h>
#include <dcmtk/dcmdata/dcdicent.h>
#include <dcmtk/dcmdata/dcdict.h>
#include <dcmtk/dcmdata/dcistrmb.h>
#include <dcmtk/dcmdata/dcistrmf.h>
#include <dcmtk/dcmdata/dcsequen.h>
#include <dcmtk/dcmdata/dcuid.h>
#include <dcmtk/dcmdata/dcxfer.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <vector>

#include "io/dicom/asked_for.h"
#include "io/errors.h"
#include "io/messages.h"

namespace palpate::io::internal {
namespace {

struct FirstBytes {
  std::array<std::byte, 12> bytes{};

  FirstBytes(const InputFile& file, std::uint64_t at) {
    if (at > file.size() || file.size() - at < bytes.size()) throw DicomError(say("not-a-dicom-file"));
    file.read(at, bytes);
  }
  unsigned operator[](std::size_t i) const { return std::to_integer<unsigned>(bytes[i]); }
  bool has_vr() const {
    const auto letter = [](unsigned c) { return c >= 'A' && c <= 'Z'; };
    return letter((*this)[4]) && letter((*this)[5]);
  }
  unsigned group() const { return (*this)[0] | (*this)[1] << 8; }
};

// A dataset starts with a low group (8, rarely 2 or 4) and, without a VR, a length of at most a few hundred bytes.
std::optional<Encoding> guess_encoding(const FirstBytes& start) {
  const bool little = (start[0] == 8 || start[0] == 4) && start[1] == 0 && start[3] == 0;
  const bool big = start[0] == 0 && (start[1] == 8 || start[1] == 4) && start[2] == 0;
  const bool short_value = start[6] == 0 && start[7] == 0;
  if (little && start.has_vr()) return Encoding{false, true};
  if (big && start.has_vr()) return Encoding{true, true};
  if (little && short_value) return Encoding{false, false};
  return std::nullopt;
}

// Group 2 is always little endian with explicit VRs. Returns the transfer syntax; `at` moves behind it.
std::string read_meta(const InputFile& file, std::uint64_t& at) {
  std::string syntax;
  while (file.size() - at >= 12) {
    const FirstBytes element(file, at);
    if (element.group() != 2 || !element.has_vr()) break;
    const bool wide = element[4] == 'O' || (element[4] == 'U' && (element[5] == 'N' || element[5] == 'T'));
    const std::uint64_t length =
        wide ? element[8] | element[9] << 8 | element[10] << 16 | std::uint64_t{element[11]} << 24
             : element[6] | element[7] << 8;
    const std::uint64_t value_at = at + (wide ? 12 : 8);
    if (value_at > file.size() || length > file.size() - value_at) throw DicomError(say("truncated-in-its-header"));
    if ((element[2] | element[3] << 8) == 0x0010 && length <= 64) {
      syntax.resize(length);
      file.read(value_at, std::as_writable_bytes(std::span(syntax)));
      syntax.erase(std::find_if(syntax.begin(), syntax.end(), [](char c) { return c == '\0' || c == ' '; }),
                   syntax.end());
    }
    at = value_at + length;
  }
  return syntax;
}

// A window of the file, so that a header costs a few reads and not one an element.
class FileBytes final : public ByteSource {
 public:
  FileBytes(const InputFile& file, std::uint64_t at) : file_(file), at_(at) {}

  std::size_t read(std::span<std::byte> into) override {
    const std::size_t count = std::min<std::uint64_t>(into.size(), file_.size() - std::min(file_.size(), at_));
    if (at_ < window_at_ || at_ + count > window_at_ + window_.size()) {
      window_.resize(std::min<std::uint64_t>(file_.size() - at_, window_size));
      window_at_ = at_;
      file_.read(window_at_, window_);
    }
    std::copy_n(window_.begin() + static_cast<std::ptrdiff_t>(at_ - window_at_), count, into.begin());
    at_ += count;
    return count;
  }
  bool skip(std::uint64_t count) override {
    if (at_ > file_.size() || count > file_.size() - at_) return false;
    at_ += count;
    return true;
  }

 private:
  static constexpr std::uint64_t window_size = 1U << 14;
  const InputFile& file_;
  std::uint64_t at_;
  std::uint64_t window_at_ = 0;
  std::vector<std::byte> window_;
};

constexpr std::uint64_t longest_header = 1U << 28;  // five times the header of 10 000 enhanced frames

[[noreturn]] void refuse_long_header() {
  throw DicomError(say("header-is-larger-than-256-mib"));
}

// Of a source, no more bytes than a header may have: a deflated one may grow a thousandfold.
class HeaderBytes final : public ByteSource {
 public:
  explicit HeaderBytes(ByteSource& source) : source_(source) {}

  std::size_t read(std::span<std::byte> into) override {
    take(into.size());
    const std::size_t got = source_.read(into);
    if (got < into.size()) check_damage();
    return got;
  }
  bool skip(std::uint64_t count) override {
    take(count);
    const bool skipped = source_.skip(count);
    if (!skipped) check_damage();
    return skipped;
  }

 private:
  void take(std::uint64_t count) {
    if (count > left_) refuse_long_header();
    left_ -= count;
  }
  void check_damage() const {
    if (const std::string why = source_.damage(); !why.empty()) throw DicomError(say("damaged-header", why));
  }

  ByteSource& source_;
  std::uint64_t left_ = longest_header;
};

class InflatedBytes final : public ByteSource {
 public:
  InflatedBytes(const std::filesystem::path& path, std::uint64_t at)
      : stream_(OFFilename(path.c_str()), static_cast<offile_off_t>(at)) {
    if (stream_.installCompressionFilter(ESC_zlib).bad()) {  // it went away since its first bytes were read
      throw DicomError(say("cannot-be-opened"));
    }
  }
  std::size_t read(std::span<std::byte> into) override {
    std::size_t total = 0;
    while (total < into.size()) {
      const offile_off_t got = stream_.read(into.data() + total, static_cast<offile_off_t>(into.size() - total));
      if (got <= 0) break;
      total += static_cast<std::size_t>(got);
    }
    return total;
  }
  bool skip(std::uint64_t count) override {
    while (count > 0) {
      const offile_off_t skipped = stream_.skip(static_cast<offile_off_t>(count));
      if (skipped <= 0) return false;
      count -= static_cast<std::uint64_t>(skipped);
    }
    return true;
  }
  std::string damage() const override { return stream_.status().bad() ? stream_.status().text() : ""; }

 private:
  DcmInputFileStream stream_;
};

// What DCMTK is to parse by: the file's own syntax, or one written alike where DCMTK does not know that, or where the
// file is not written as it says.
E_TransferSyntax syntax_of(const DatasetStart& start) {
  if (start.deflated) return EXS_LittleEndianExplicit;  // as it is once it has been inflated
  const DcmXfer known(start.transfer_syntax.c_str());
  const bool as_it_says = (known.isExplicitVR() == OFTrue) == start.encoding.explicit_vr;
  if (!start.transfer_syntax.empty() && known.getXfer() != EXS_Unknown && as_it_says) return known.getXfer();
  if (!start.encoding.explicit_vr) return EXS_LittleEndianImplicit;
  return start.encoding.big_endian ? EXS_BigEndianExplicit : EXS_LittleEndianExplicit;
}

// Archives that did not know an attribute wrote it with the VR UN. Its value is then one of implicit VR, little endian
// (PS3.5 6.2.2), and is read as that wherever the dictionary knows it.
class Bytes final : public ByteSource {
 public:
  explicit Bytes(std::span<const std::byte> bytes) : rest_(bytes) {}

  std::size_t read(std::span<std::byte> into) override {
    const std::size_t count = std::min(into.size(), rest_.size());
    std::copy_n(rest_.begin(), count, into.begin());
    rest_ = rest_.subspan(count);
    return count;
  }
  bool skip(std::uint64_t count) override {
    if (count > rest_.size()) return false;
    rest_ = rest_.subspan(count);
    return true;
  }

 private:
  std::span<const std::byte> rest_;
};

std::vector<std::byte> wanted_bytes(ByteSource& source, const DatasetShape& shape) {
  std::vector<std::byte> bytes;
  std::uint64_t at = 0;
  for (const DatasetShape::Stretch& stretch : shape.wanted) {
    const std::size_t kept = bytes.size();
    bytes.resize(kept + (stretch.end - stretch.begin));
    if (!source.skip(stretch.begin - at) || source.read(std::span(bytes).subspan(kept)) != bytes.size() - kept) {
      throw DicomError(say("truncated-in-its-header"));
    }
    at = stretch.end;
  }
  return bytes;
}

bool wants_all(std::uint32_t) {
  return true;
}

bool is_in_dictionary(const DcmTagKey& key) {
  const DcmDataDictionary& dictionary = dcmDataDict.rdlock();
  const DcmDictEntry* entry = dictionary.findEntry(key, nullptr);
  const bool known = entry != nullptr && entry->getEVR() != EVR_UN && entry->getEVR() != EVR_UNKNOWN;
  dcmDataDict.rdunlock();
  return known;
}

// The element with this tag and value, read without a VR; null if the bytes are invalid.
std::unique_ptr<DcmElement> without_vr(const DcmTagKey& tag, std::span<const std::byte> content) {
  const auto length = static_cast<std::uint32_t>(content.size());
  std::vector<std::byte> bytes;
  const auto add = [&](std::uint32_t number, std::size_t size) {
    for (std::size_t n = 0; n < size; ++n) bytes.push_back(static_cast<std::byte>(number >> 8 * n));
  };
  add(tag.getGroup(), 2);
  add(tag.getElement(), 2);
  add(length, 4);
  bytes.insert(bytes.end(), content.begin(), content.end());
  try {
    Bytes source(bytes);
    check_structure(source, Encoding{false, false}, wants_all);
  } catch (const DicomError&) {
    return nullptr;
  }
  DcmInputBufferStream stream;
  stream.setBuffer(bytes.data(), static_cast<offile_off_t>(bytes.size()));
  stream.setEos();
  DcmDataset dataset;
  dataset.transferInit();
  const OFCondition read = dataset.read(stream, EXS_LittleEndianImplicit, EGL_noChange, DCM_MaxReadLength);
  dataset.transferEnd();
  if (read.bad() || dataset.card() != 1) return nullptr;
  return std::unique_ptr<DcmElement>(dataset.remove(static_cast<unsigned long>(0)));
}

// The same element as it would be read without a VR.
std::unique_ptr<DcmElement> with_known_vr(DcmElement& unknown) {
  Uint8* value = nullptr;
  const std::uint32_t length = unknown.getLength();
  static_cast<void>(unknown.getUint8Array(value));  // null where it cannot
  if (length > 0 && value == nullptr) return nullptr;
  return without_vr(unknown.getTag(), std::as_bytes(std::span(value, length)));
}

void settle_unknown(DcmItem& item) {
  std::vector<DcmElement*> elements;
  DcmObject* object = nullptr;
  while ((object = item.nextInContainer(object)) != nullptr) elements.push_back(dynamic_cast<DcmElement*>(object));
  for (DcmElement* element : elements) {
    if (element == nullptr) continue;
    if (element->getVR() == EVR_UN && element->getGTag() % 2 == 0 && is_in_dictionary(element->getTag())) {
      std::unique_ptr<DcmElement> known = with_known_vr(*element);
      if (!known || item.insert(known.get(), OFTrue).bad()) continue;
      element = known.release();
    }
    if (auto* sequence = dynamic_cast<DcmSequenceOfItems*>(element)) {
      DcmObject* inside = nullptr;
      while ((inside = sequence->nextInContainer(inside)) != nullptr) {
        if (auto* inner = dynamic_cast<DcmItem*>(inside)) settle_unknown(*inner);
      }
    }
  }
}

}  // namespace

DatasetStart find_dataset(const InputFile& file) {
  if (file.size() == 0) throw DicomError(say("empty-file"));
  DatasetStart start;
  bool is_part_10 = false;
  if (file.size() >= 132) {
    std::array<std::byte, 4> magic{};
    file.read(128, magic);
    is_part_10 = std::memcmp(magic.data(), "DICM", magic.size()) == 0;
    if (is_part_10) start.at = 132;
  }
  const std::uint64_t meta_at = start.at;
  start.transfer_syntax = read_meta(file, start.at);
  const DcmXfer syntax(start.transfer_syntax.c_str());  // which knows syntaxes without a UID, too
  if (!start.transfer_syntax.empty() && syntax.getXfer() != EXS_Unknown) {
    start.encoding = {syntax.getByteOrder() == EBO_BigEndian, syntax.isExplicitVR() == OFTrue};
    start.deflated = syntax.getStreamCompression() != ESC_none;
    if (start.deflated || file.size() - start.at < sizeof(FirstBytes)) return start;
    // Some archives rewrite the dataset in another encoding but not the meta information about it.
    const auto shown = guess_encoding(FirstBytes(file, start.at));
    if (shown && shown->big_endian == start.encoding.big_endian) start.encoding = *shown;
    return start;
  }
  const auto guess = guess_encoding(FirstBytes(file, start.at));
  if (!guess) throw DicomError(is_part_10 || start.at > meta_at ? say("damaged-no-dataset") : say("not-a-dicom-file"));
  start.encoding = *guess;
  if (start.transfer_syntax.empty()) start.transfer_syntax = DcmXfer(syntax_of(start)).getXferID();
  return start;
}

std::unique_ptr<DcmSequenceOfItems> sequence_in(std::span<const std::byte> value) {
  // By a tag that the dictionary knows for a sequence.
  std::unique_ptr<DcmElement> element = without_vr(DCM_ReferencedImageSequence, value);
  if (dynamic_cast<DcmSequenceOfItems*>(element.get()) == nullptr) return nullptr;
  return std::unique_ptr<DcmSequenceOfItems>(dynamic_cast<DcmSequenceOfItems*>(element.release()));
}

std::unique_ptr<ByteSource> inflated(const std::filesystem::path& path, const DatasetStart& start) {
  return std::make_unique<InflatedBytes>(path, start.at);
}

std::optional<PixelElement> parse_header(const InputFile& file, const std::filesystem::path& path,
                                         const DatasetStart& start, DcmDataset& dataset,
                                         bool (*wants)(std::uint32_t tag)) {
  DatasetShape shape;
  // Pixels and unwanted attributes are left out: DCMTK takes a microsecond for each element.
  std::vector<std::byte> wanted;
  // The syntax is given, so that DCMTK never guesses another one than was checked.
  dataset.transferInit();
  if (start.deflated) {
    const auto once = inflated(path, start);
    HeaderBytes bytes(*once);
    shape = check_structure(bytes, start.encoding, wants);
    wanted = wanted_bytes(*inflated(path, start), shape);
  } else {
    FileBytes bytes(file, start.at);
    shape = check_structure(bytes, start.encoding, wants);
    if (shape.header_end > longest_header) refuse_long_header();
    wanted.resize(shape.header_end);
    file.read(start.at, wanted);
    std::size_t kept = 0;
    for (const DatasetShape::Stretch& stretch : shape.wanted) {
      std::memmove(wanted.data() + kept, wanted.data() + stretch.begin, stretch.end - stretch.begin);
      kept += stretch.end - stretch.begin;
    }
    wanted.resize(kept);
  }
  DcmInputBufferStream stream;
  stream.setBuffer(wanted.data(), static_cast<offile_off_t>(wanted.size()));
  stream.setEos();
  const OFCondition read = dataset.read(stream, syntax_of(start), EGL_noChange, DCM_MaxReadLength);
  dataset.transferEnd();
  if (read.bad()) throw DicomError(say("damaged-header", read.text()));
  if (shape.has_unknown) settle_unknown(dataset);
  return shape.pixels;
}

}  // namespace palpate::io::internal

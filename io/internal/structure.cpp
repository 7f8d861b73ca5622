#include "palpate/io/internal/structure.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcistrma.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "palpate/io/errors.h"

namespace palpate::io::internal {
namespace {

constexpr std::size_t deepest = 64;             // structured reports, the deepest objects there are, stay below 20
constexpr std::size_t most_disorder = 1000;     // elements behind one with a higher tag; the standard allows none
constexpr std::size_t most_elements = 4000000;  // 100 for each of 40 000 frames
constexpr std::uint32_t undefined_length = 0xFFFFFFFF;
constexpr std::uint32_t item_tag = 0xFFFEE000;
constexpr std::uint32_t item_end = 0xFFFEE00D;
constexpr std::uint32_t sequence_end = 0xFFFEE0DD;
constexpr std::uint32_t pixel_data = 0x7FE00010;

enum class Holds { elements, items, fragments };

struct Level {
  Holds holds = Holds::elements;
  std::optional<std::uint64_t> end;  // where its length was given
  Encoding encoding;
  std::uint32_t last_tag = 0;
};

class Walk {
 public:
  Walk(DcmInputStream& in, Encoding encoding) : in_(in) {
    levels_.push_back({Holds::elements, std::nullopt, encoding, 0});
  }

  void run() {
    while (step()) {
    }
  }

 private:
  struct Head {
    std::uint32_t length = 0;
    bool sequence = false;
    bool unknown = false;
  };

  bool read(void* into, std::uint32_t count) {
    const bool complete = in_.read(into, count) == static_cast<offile_off_t>(count);
    at_ += count;
    return complete;
  }
  std::uint32_t number(std::uint32_t bytes) {
    std::array<unsigned char, 4> raw{};
    if (!read(raw.data(), bytes)) throw DicomError("truncated in its header");
    if (!levels_.back().encoding.big_endian) std::reverse(raw.begin(), raw.begin() + bytes);
    std::uint32_t value = 0;
    for (std::uint32_t i = 0; i < bytes; ++i) value = value << 8 | raw[i];
    return value;
  }
  void skip(std::uint64_t count) {
    while (count > 0) {
      const offile_off_t skipped = in_.skip(static_cast<offile_off_t>(count));
      if (skipped <= 0) throw DicomError("truncated in its header");
      at_ += static_cast<std::uint64_t>(skipped);
      count -= static_cast<std::uint64_t>(skipped);
    }
  }
  void push(Holds holds, std::uint32_t length, Encoding encoding) {
    if (levels_.size() >= deepest) throw DicomError("damaged: its sequences are nested too deeply");
    const auto end = length == undefined_length ? std::nullopt : std::optional(at_ + length);
    levels_.push_back({holds, end, encoding, 0});
  }

  // The VR and the length of an element. VRs that are not in the standard are read as DCMTK reads them.
  Head head() {
    if (!levels_.back().encoding.explicit_vr) return {number(4), false, false};
    std::array<char, 2> vr{};
    if (!read(vr.data(), 2)) throw DicomError("truncated in its header");
    const std::string_view name(vr.data(), 2);
    constexpr std::string_view brief = "AE AS AT CS DA DS DT FD FL IS LO LT PN SH SL SS ST TM UI UL US";
    const bool letters = std::all_of(name.begin(), name.end(), [](char c) { return c >= 'A' && c <= 'Z'; });
    if (!letters || brief.find(name) != std::string_view::npos) return {number(2), false, false};
    number(2);  // reserved
    return {number(4), name == "SQ", name == "UN"};
  }

  bool step() {
    if (levels_.back().end && at_ >= *levels_.back().end) {
      levels_.pop_back();
      return true;
    }
    std::array<unsigned char, 4> raw{};
    const offile_off_t got = in_.read(raw.data(), 4);
    at_ += 4;
    if (got <= 0 && levels_.size() == 1) return false;  // an object without pixels ends here
    if (got != 4) throw DicomError("truncated in its header");
    const std::uint32_t tag = levels_.back().encoding.big_endian
                                  ? unsigned{raw[0]} << 24 | unsigned{raw[1]} << 16 | unsigned{raw[2]} << 8 | raw[3]
                                  : unsigned{raw[1]} << 24 | unsigned{raw[0]} << 16 | unsigned{raw[3]} << 8 | raw[2];
    if (++elements_ > most_elements) throw DicomError("damaged: its header has no end");
    return levels_.back().holds == Holds::elements ? element(tag) : item(tag);
  }

  bool element(std::uint32_t tag) {
    if (tag == item_end && levels_.size() > 1 && !levels_.back().end) {
      number(4);
      levels_.pop_back();
      return true;
    }
    if (levels_.size() == 1 && tag >= pixel_data) return false;
    Level& level = levels_.back();
    if (tag <= level.last_tag && ++disorder_ > most_disorder) throw DicomError("damaged: its header is in disorder");
    level.last_tag = tag;
    const Encoding inside = level.encoding;
    const Head is = head();
    if (is.sequence || is.length == undefined_length) {
      const Encoding implicit{false, false};  // PS3.5 6.2.2: the content of an unknown sequence
      push(tag == pixel_data ? Holds::fragments : Holds::items, is.length, is.unknown ? implicit : inside);
    } else if (!inside.explicit_vr && is.length >= 8) {
      maybe_sequence(is.length, inside);
    } else {
      skip(is.length);
    }
    return true;
  }

  // Without a VR a sequence of known length looks like any other value, but for the item it starts with.
  void maybe_sequence(std::uint32_t length, Encoding inside) {
    in_.mark();
    const std::uint64_t start = at_;
    const std::uint32_t group = number(2);
    const std::uint32_t tag = group << 16 | number(2);
    in_.putback();
    at_ = start;
    if (tag == item_tag) {
      push(Holds::items, length, inside);
    } else {
      skip(length);
    }
  }

  bool item(std::uint32_t tag) {
    const std::uint32_t length = number(4);
    if (tag == sequence_end) {
      levels_.pop_back();
    } else if (tag != item_tag) {
      throw DicomError("damaged: a sequence in its header is not made of items");
    } else if (levels_.back().holds == Holds::fragments) {
      skip(length);
    } else {
      push(Holds::elements, length, levels_.back().encoding);
    }
    return true;
  }

  DcmInputStream& in_;
  std::uint64_t at_ = 0;
  std::vector<Level> levels_;
  std::size_t elements_ = 0;
  std::size_t disorder_ = 0;
};

}  // namespace

void check_structure(DcmInputStream& dataset, Encoding encoding) {
  Walk(dataset, encoding).run();
}

}  // namespace palpate::io::internal

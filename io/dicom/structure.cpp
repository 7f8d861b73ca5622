#include "io/dicom/structure.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "io/errors.h"
#include "io/messages.h"

namespace palpate::io::internal {
namespace {

constexpr std::size_t deepest = 64;             // structured reports, the deepest objects there are, stay below 20
constexpr std::size_t most_disorder = 1000;     // elements behind one with a higher tag; the standard allows none
constexpr std::size_t most_elements = 4000000;  // 100 for each of 40 000 frames
constexpr std::uint32_t undefined_length = PixelElement::undefined_length;
constexpr std::uint32_t item_tag = 0xFFFEE000;
constexpr std::uint32_t item_end = 0xFFFEE00D;
constexpr std::uint32_t sequence_end = 0xFFFEE0DD;
constexpr std::uint32_t float_pixel_data = 0x7FE00008;
constexpr std::uint32_t double_pixel_data = 0x7FE00009;
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
  Walk(ByteSource& in, Encoding encoding, bool (*wants)(std::uint32_t)) : in_(in), wants_(wants) {
    levels_.push_back({Holds::elements, std::nullopt, encoding, 0});
  }

  DatasetShape run() {
    while (step()) {
    }
    end_stretch(shape_.header_end);
    return shape_;
  }

 private:
  struct Head {
    std::string vr;
    std::uint32_t length = 0;
  };

  static std::uint32_t number_in(std::span<const std::byte> raw, bool big_endian) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < raw.size(); ++i) {
      value = value << 8 | std::to_integer<std::uint32_t>(raw[big_endian ? i : raw.size() - 1 - i]);
    }
    return value;
  }
  std::size_t take(std::span<std::byte> into) {
    const std::size_t got = in_.read(into);
    at_ += got;
    return got;
  }
  std::uint32_t number(std::size_t bytes) {
    std::array<std::byte, 4> raw{};
    const auto wanted = std::span(raw).first(bytes);
    if (take(wanted) != bytes) throw DicomError(say("truncated-in-its-header"));
    return number_in(wanted, levels_.back().encoding.big_endian);
  }
  void skip(std::uint64_t count) {
    if (!in_.skip(count)) throw DicomError(say("truncated-in-its-header"));
    at_ += count;
  }
  void push(Holds holds, std::uint32_t length, Encoding encoding) {
    if (levels_.size() >= deepest) throw DicomError(say("damaged-its-sequences-are-nested-too-deeply"));
    const auto end = length == undefined_length ? std::nullopt : std::optional(at_ + length);
    levels_.push_back({holds, end, encoding, 0});
  }

  // The VR and the length of an element. VRs that are not in the standard are read as DCMTK reads them.
  Head head() {
    if (!levels_.back().encoding.explicit_vr) return {"", number(4)};
    std::array<std::byte, 2> vr{};
    if (take(vr) != vr.size()) throw DicomError(say("truncated-in-its-header"));
    const std::string name{std::to_integer<char>(vr[0]), std::to_integer<char>(vr[1])};
    constexpr std::string_view brief = "AE AS AT CS DA DS DT FD FL IS LO LT PN SH SL SS ST TM UI UL US";
    const bool letters = std::all_of(name.begin(), name.end(), [](char c) { return c >= 'A' && c <= 'Z'; });
    if (!letters || brief.find(name) != std::string_view::npos) return {name, number(2)};
    number(2);  // reserved
    return {name, number(4)};
  }

  void end_stretch(std::uint64_t at) {
    if (stretch_) shape_.wanted.push_back({*stretch_, at});
    stretch_.reset();
  }

  bool step() {
    if (levels_.back().end && at_ >= *levels_.back().end) {
      levels_.pop_back();
      return true;
    }
    const std::uint64_t start = at_;
    std::array<std::byte, 4> raw{};
    const std::size_t got = take(raw);
    if (got == 0 && levels_.size() == 1) {  // an object without pixels ends here
      shape_.header_end = start;
      return false;
    }
    if (got != raw.size()) throw DicomError(say("truncated-in-its-header"));
    const bool big_endian = levels_.back().encoding.big_endian;
    const std::uint32_t tag =
        number_in(std::span(raw).first(2), big_endian) << 16 | number_in(std::span(raw).last(2), big_endian);
    if (++elements_ > most_elements) throw DicomError(say("damaged-its-header-has-no-end"));
    return levels_.back().holds == Holds::elements ? element(tag, start) : item(tag);
  }

  bool element(std::uint32_t tag, std::uint64_t start) {
    if (tag == item_end && levels_.size() > 1 && !levels_.back().end) {
      number(4);
      levels_.pop_back();
      return true;
    }
    if (levels_.size() == 1 && tag >= float_pixel_data) {
      shape_.header_end = start;
      const bool is_float = tag == float_pixel_data || tag == double_pixel_data;
      if (tag == pixel_data || is_float) {
        const Head is = head();
        shape_.pixels = PixelElement{at_, is.length, is_float, tag == double_pixel_data, is.vr};
      }
      return false;
    }
    if (levels_.size() == 1 && wants_(tag) != stretch_.has_value()) {
      stretch_ ? end_stretch(start) : void(stretch_ = start);
    }
    Level& level = levels_.back();
    if (tag <= level.last_tag && ++disorder_ > most_disorder)
      throw DicomError(say("damaged-its-header-is-in-disorder"));
    level.last_tag = tag;
    const Encoding inside = level.encoding;
    const Head is = head();
    shape_.has_unknown |= is.vr == "UN";
    if (is.vr == "SQ" || is.length == undefined_length) {
      const Encoding implicit{false, false};  // PS3.5 6.2.2: the content of an unknown sequence
      push(tag == pixel_data ? Holds::fragments : Holds::items, is.length, is.vr == "UN" ? implicit : inside);
    } else if (!inside.explicit_vr && is.length >= 8) {
      maybe_sequence(is.length, inside);
    } else {
      skip(is.length);
    }
    return true;
  }

  // Without a VR a sequence of known length looks like any other value, except for the item at its start.
  void maybe_sequence(std::uint32_t length, Encoding inside) {
    const Level level{Holds::items, at_ + length, inside, 0};
    const std::uint32_t group = number(2);
    const std::uint32_t tag = group << 16 | number(2);
    if (tag != item_tag) {
      skip(length - 4);
      return;
    }
    if (levels_.size() >= deepest) throw DicomError(say("damaged-its-sequences-are-nested-too-deeply"));
    levels_.push_back(level);
    item(tag);
  }

  bool item(std::uint32_t tag) {
    const std::uint32_t length = number(4);
    if (tag == sequence_end) {
      levels_.pop_back();
    } else if (tag != item_tag) {
      throw DicomError(say("sequence-is-not-items"));
    } else if (levels_.back().holds == Holds::fragments) {
      skip(length);
    } else {
      push(Holds::elements, length, levels_.back().encoding);
    }
    return true;
  }

  ByteSource& in_;
  bool (*wants_)(std::uint32_t);
  std::optional<std::uint64_t> stretch_;  // where one of wanted elements began
  std::uint64_t at_ = 0;
  std::vector<Level> levels_;
  std::size_t elements_ = 0;
  std::size_t disorder_ = 0;
  DatasetShape shape_;
};

}  // namespace

DatasetShape check_structure(ByteSource& dataset, Encoding encoding, bool (*wants)(std::uint32_t)) {
  return Walk(dataset, encoding, wants).run();
}

}  // namespace palpate::io::internal

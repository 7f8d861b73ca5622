#include "plugin/openigtlink/receiver.h"

#include <algorithm>
#include <utility>

namespace palpate::plugin::igtl {

void Receiver::take(ByteView bytes, const Got& got) {
  while (!bytes.empty() || (header_ && left_ == 0)) {
    if (!header_) {
      const std::size_t count = std::min(header_size - head_.size(), bytes.size());
      head_.insert(head_.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count));
      bytes = bytes.subspan(count);
      if (head_.size() < header_size) return;
      header_ = read_header(head_);
      head_.clear();
      left_ = header_->body_size;
      const std::size_t most = wanted_(*header_);
      keeps_ = most > 0;
      if (keeps_ && left_ > most) {
        throw InvalidInput(say("igtl-body-too-large", header_->type, header_->body_size, most));
      }
    }
    const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(left_, bytes.size()));
    if (keeps_) {
      body_.insert(body_.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count));
      checksum_ = checksum(bytes.first(count), checksum_);
    }
    left_ -= count;
    bytes = bytes.subspan(count);
    if (left_ == 0) end_message(got);
  }
}

void Receiver::end_message(const Got& got) {
  const Header header = *std::exchange(header_, std::nullopt);
  Bytes body = std::exchange(body_, Bytes());
  const bool is_whole = std::exchange(checksum_, 0) == header.checksum;
  if (!keeps_) {
    ++passed_over_;
    return;
  }
  std::optional<Message> message;
  try {
    if (!is_whole) throw InvalidInput(say("igtl-wrong-checksum"));
    message = read_message(header, std::move(body));
  } catch (const InvalidInput& error) {
    ++dropped_;
    why_dropped_ = error.text();
    return;
  }
  got(std::move(*message));
}

}  // namespace palpate::plugin::igtl

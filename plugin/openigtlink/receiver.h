#pragma once

/// Bytes from a peer to whole messages. A peer may send half a message, lie about a size, or never end: no more memory
/// is taken than bytes have come, and no more than the receiver wants of a message of that type.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>

#include "plugin/openigtlink/message.h"

namespace palpate::plugin::igtl {

class Receiver {
 public:
  /// The most bytes that the body of such a message may have; 0: the message is passed over.
  using Wanted = std::function<std::size_t(const Header& header)>;
  using Got = std::function<void(Message&& message)>;

  explicit Receiver(Wanted wanted) : wanted_(std::move(wanted)) {}

  /// The next bytes of the stream, in pieces of any size. Calls got() for each message that they end. A message with a
  /// wrong checksum or broken parts is dropped and counted. Throws InvalidInput if the stream cannot be followed any
  /// further: a header that is none, or a body that is larger than is wanted.
  void take(ByteView bytes, const Got& got);

  std::uint64_t passed_over() const noexcept { return passed_over_; }
  std::uint64_t dropped() const noexcept { return dropped_; }
  /// Of the last one.
  const Text& why_dropped() const noexcept { return why_dropped_; }

 private:
  void end_message(const Got& got);

  Wanted wanted_;
  Bytes head_;                    // of the next message, until it is whole
  std::optional<Header> header_;  // of the message whose body comes
  Bytes body_;
  std::uint64_t left_ = 0;      // bytes of the body that have not come
  std::uint64_t checksum_ = 0;  // of those that have: a large body is not gone through again at its end
  bool keeps_ = false;          // the body; else it is passed over
  std::uint64_t passed_over_ = 0, dropped_ = 0;
  Text why_dropped_;
};

}  // namespace palpate::plugin::igtl

#pragma once

/// Assembles the bytes of a client into whole messages. A client may send half a message, give a wrong size, or never
/// end. So no more memory is allocated than bytes have come, and no more than is wanted for a message of that type.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>

#include "plugin/openigtlink/message.h"

namespace palpate::plugin::igtl {

class Receiver {
 public:
  /// The largest wanted body of such a message, bytes; 0: skip the message.
  using Wanted = std::function<std::size_t(const Header& header)>;
  using Got = std::function<void(Message&& message)>;

  explicit Receiver(Wanted wanted) : wanted_(std::move(wanted)) {}

  /// Takes the next bytes of the stream, in pieces of any size. Calls got() for each complete message. A message with a
  /// wrong checksum or invalid parts is dropped and counted. Throws InvalidInput if the stream cannot be continued: an
  /// invalid header, or a body that is larger than wanted.
  void take(ByteView bytes, const Got& got);

  std::uint64_t passed_over() const noexcept { return passed_over_; }
  std::uint64_t dropped() const noexcept { return dropped_; }
  /// Why the latest message was dropped.
  const Text& why_dropped() const noexcept { return why_dropped_; }

 private:
  void end_message(const Got& got);

  Wanted wanted_;
  Bytes head_;                    // of the next message, until it is complete
  std::optional<Header> header_;  // of the message whose body is being read
  Bytes body_;
  std::uint64_t left_ = 0;      // missing bytes of the body
  std::uint64_t checksum_ = 0;  // of the bytes so far, so that a large body is not read again at its end
  bool keeps_ = false;          // whether the body is kept; otherwise it is skipped
  std::uint64_t passed_over_ = 0, dropped_ = 0;
  Text why_dropped_;
};

}  // namespace palpate::plugin::igtl

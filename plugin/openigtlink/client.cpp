#include "plugin/openigtlink/client.h"

#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

namespace palpate::plugin::igtl {
namespace {

constexpr std::size_t bytes_at_once = std::size_t{1} << 18U;
constexpr auto longest_stall = std::chrono::seconds(10), longest_farewell = std::chrono::seconds(1);

bool would_wait() {
  return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
}

}  // namespace

bool put(std::vector<Waiting>& queue, const Waiting& waiting) {
  const auto same = std::ranges::find(queue, waiting.name, &Waiting::name);
  if (same == queue.end()) {
    queue.push_back(waiting);
    return false;
  }
  same->wire = waiting.wire;
  return true;
}

Client::Client(int socket, std::uint64_t id, bool from_this_machine, Receiver::Wanted wanted)
    : socket_(socket), id_(id), from_this_machine_(from_this_machine), receiver_(std::move(wanted)) {}

Client::~Client() {
  ::close(socket_);
}

void Client::queue(const Waiting& waiting, ServerCounts& counts) {
  if (closes_ || (!streams && waiting.name == frame_name)) return;
  if (!has_to_write()) last_progress_ = Clock::now();
  if (put(queue_, waiting)) ++counts.replaced;
}

void Client::write(ServerCounts& counts) {
  while (has_to_write() && !gone_) {
    if (!current_) {
      current_ = queue_.front().wire;
      queue_.erase(queue_.begin());
      written_ = 0;
    }
    const ssize_t count =
        ::send(socket_, current_->data() + written_, current_->size() - written_, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (count < 0) {
      gone_ = !would_wait();
      return;
    }
    last_progress_ = Clock::now();
    written_ += static_cast<std::size_t>(count);
    if (written_ == current_->size()) {
      current_.reset();
      ++counts.sent;
    }
  }
}

void Client::read(const Receiver::Got& got) {
  static thread_local Bytes buffer(bytes_at_once);
  const ssize_t count = ::recv(socket_, buffer.data(), buffer.size(), MSG_DONTWAIT);
  if (count == 0 || (count < 0 && !would_wait())) gone_ = true;
  if (count > 0 && !closes_) receiver_.take(ByteView(buffer).first(static_cast<std::size_t>(count)), got);
}

bool Client::ends(Clock::time_point now, ServerCounts& counts) {
  if (gone_ || (closes_ && (!has_to_write() || now - last_progress_ > longest_farewell))) return true;
  if (!has_to_write() || now - last_progress_ < longest_stall) return false;
  ++counts.cut;
  return true;
}

}  // namespace palpate::plugin::igtl

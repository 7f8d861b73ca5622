#include "device/testing/haply_server.h"

#include <algorithm>
#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <mutex>
#include <thread>
#include <vector>

#include "device/link/realtime.h"

namespace palpate::device {

namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using tcp = asio::ip::tcp;

struct Shared {
  std::mutex lock;
  FakeHaply service;
  std::atomic<bool> cuts{false}, stalls{false};
  std::atomic<int> sessions{0};
};

/// One connection: a question about the version, or a session.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(tcp::socket socket, Shared& shared) : socket_(std::move(socket)), shared_(shared) {}
  ~Connection() {
    const std::lock_guard hold(shared_.lock);
    if (number_ > 0) shared_.service.leave(number_);
  }
  void start() {
    http::async_read(socket_.next_layer(), buffer_, request_, [self = shared_from_this()](auto error, std::size_t) {
      if (!error) self->choose();
    });
  }
  void drop() {
    beast::error_code ignored;
    socket_.next_layer().socket().close(ignored);
    const std::lock_guard hold(shared_.lock);
    if (number_ > 0) shared_.service.leave(number_);
  }

 private:
  void choose() {
    if (websocket::is_upgrade(request_)) {
      socket_.async_accept(request_, [self = shared_from_this()](auto error) {
        if (error) return;
        self->number_ = ++self->shared_.sessions;
        self->buffer_.clear();
        const std::lock_guard hold(self->shared_.lock);
        self->say(self->shared_.service.inventory());
      });
      return;
    }
    // RFC 9112, 3.2: a request without a host is refused.
    if (request_.find(http::field::host) == request_.end()) {
      response_.result(http::status::bad_request);
    } else {
      response_.result(request_.target() == "/version" ? http::status::ok : http::status::not_found);
    }
    if (response_.result() == http::status::ok) {
      const std::lock_guard hold(shared_.lock);
      const HaplyVersion version = shared_.service.version;
      response_.body() = nlohmann::json{
          {"project_version", std::to_string(version.major) + "." + std::to_string(version.minor) + ".0"},
          {"git_tag",
           "a fake"}}.dump();
    }
    response_.prepare_payload();
    http::async_write(socket_.next_layer(), response_, [self = shared_from_this()](auto, std::size_t) {
      beast::error_code ignored;
      self->socket_.next_layer().socket().shutdown(tcp::socket::shutdown_both, ignored);
    });
  }
  void say(std::string text) {
    outgoing_ = std::move(text);
    if (shared_.cuts) {
      // The head of a frame of so many bytes (RFC 6455, 5.2), and half of them.
      std::string frame{'\x81', '\x7e', static_cast<char>(outgoing_.size() >> 8U), static_cast<char>(outgoing_.size())};
      outgoing_ = frame + outgoing_.substr(0, outgoing_.size() / 2);
      asio::async_write(socket_.next_layer(), asio::buffer(outgoing_),
                        [self = shared_from_this()](auto, std::size_t) {});
      return;
    }
    socket_.text(true);
    socket_.async_write(asio::buffer(outgoing_), [self = shared_from_this()](auto error, std::size_t) {
      if (!error) self->hear();
    });
  }
  void hear() {
    if (shared_.stalls) return wait();
    // The client's messages are text. Any other message ends the session.
    socket_.async_read(buffer_, [self = shared_from_this()](auto error, std::size_t) {
      if (!error && self->socket_.got_text()) self->answer();
    });
  }
  void answer() {
    if (shared_.stalls) return wait();
    const std::string text = beast::buffers_to_string(buffer_.data());
    buffer_.clear();
    std::string said;
    {
      const std::lock_guard hold(shared_.lock);
      said = shared_.service.answer(number_, text, monotonic_time());
      if (shared_.service.silent) said.clear();
    }
    said.empty() ? hear() : say(said);
  }
  /// Waits until the service no longer stalls.
  void wait() {
    timer_.expires_after(std::chrono::milliseconds(5));
    timer_.async_wait([self = shared_from_this()](auto error) {
      if (error) return;
      self->buffer_.size() > 0 ? self->answer() : self->hear();
    });
  }

  websocket::stream<beast::tcp_stream> socket_;
  Shared& shared_;
  asio::steady_timer timer_{socket_.get_executor()};
  beast::flat_buffer buffer_;
  http::request<http::string_body> request_;
  http::response<http::string_body> response_;
  std::string outgoing_;
  int number_ = 0;
};

/// A client that receives the service's events. It sends nothing.
struct EventHearer {
  explicit EventHearer(tcp::socket socket) : stream(std::move(socket)) {}
  websocket::stream<beast::tcp_stream> stream;
  bool is_open = false;
};

}  // namespace

class HaplyServer::Impl {
 public:
  explicit Impl(const FakeHaply& service)
      : acceptor_(context_, tcp::endpoint(asio::ip::make_address("127.0.0.1"), 0)),
        port_(acceptor_.local_endpoint().port()),
        event_acceptor_(context_, tcp::endpoint(asio::ip::make_address("127.0.0.1"), 0)),
        events_port_(event_acceptor_.local_endpoint().port()) {
    shared.service = service;
    accept();
    accept_hearer();
    thread_ = std::thread([this] {
      make_thread_realtime(65);  // above the clients' priority: like a real service, it answers also on a busy machine
      context_.run();
    });
  }
  ~Impl() {
    context_.stop();
    thread_.join();
  }
  void drop() {
    asio::post(context_, [this] {
      for (const auto& one : connections_) {
        if (const auto connection = one.lock()) connection->drop();
      }
      connections_.clear();
    });
  }
  void tell(const std::string& event) {
    asio::post(context_, [this, event] {
      for (const auto& hearer : hearers_) {
        if (!hearer->is_open) continue;
        beast::error_code ignored;
        hearer->stream.text(true);
        hearer->stream.write(asio::buffer(event), ignored);
      }
    });
  }
  int port() const { return port_; }
  int events_port() const { return events_port_; }

  Shared shared;

 private:
  void accept() {
    acceptor_.async_accept([this](auto error, tcp::socket socket) {
      if (error) return;
      const auto connection = std::make_shared<Connection>(std::move(socket), shared);
      connections_.push_back(connection);
      connection->start();
      accept();
    });
  }

  void accept_hearer() {
    event_acceptor_.async_accept([this](auto error, tcp::socket socket) {
      if (error) return;
      const auto hearer = std::make_shared<EventHearer>(std::move(socket));
      hearers_.push_back(hearer);
      hearer->stream.async_accept([hearer](auto refused) { hearer->is_open = !refused; });
      accept_hearer();
    });
  }

  asio::io_context context_{1};
  tcp::acceptor acceptor_;
  int port_;
  tcp::acceptor event_acceptor_;
  int events_port_;
  std::vector<std::shared_ptr<EventHearer>> hearers_;
  std::vector<std::weak_ptr<Connection>> connections_;
  std::thread thread_;
};

HaplyServer::HaplyServer(const FakeHaply& service) : impl_(std::make_unique<Impl>(service)) {}
HaplyServer::~HaplyServer() = default;

int HaplyServer::port() const noexcept {
  return impl_->port();
}
int HaplyServer::events_port() const noexcept {
  return impl_->events_port();
}
void HaplyServer::tell(const std::string& event) {
  impl_->tell(event);
}
void HaplyServer::with(const std::function<void(FakeHaply&)>& run) {
  const std::lock_guard hold(impl_->shared.lock);
  run(impl_->shared.service);
}
Vec3 HaplyServer::acting() {
  const std::lock_guard hold(impl_->shared.lock);
  return impl_->shared.service.acting(monotonic_time());
}
void HaplyServer::drop() {
  impl_->drop();
}
void HaplyServer::cut_frames(bool on) {
  impl_->shared.cuts = on;
}
void HaplyServer::stall(bool on) {
  impl_->shared.stalls = on;
}
int HaplyServer::sessions() const noexcept {
  return impl_->shared.sessions;
}

}  // namespace palpate::device

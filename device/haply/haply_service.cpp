// The maker's service over Boost.Beast. The thread that owns the stylus owns the socket, too: nothing here is called in
// a servo tick.

#include "device/haply/haply_service.h"

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <exception>
#include <functional>
#include <glm/geometric.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "device/link/realtime.h"
#include "device/messages.h"

namespace palpate::device {

namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using tcp = asio::ip::tcp;

constexpr std::size_t longest_message = 1 << 16;
constexpr double events_patience = 0.5;  // s: it goes without them

std::chrono::microseconds microseconds(double seconds) {
  return std::chrono::microseconds(static_cast<long>(seconds * 1e6));
}

/// Runs what was started until it has its result or the time is over.
beast::error_code result_of(asio::io_context& context, double timeout,
                            const std::function<void(std::function<void(beast::error_code)>)>& start) {
  beast::error_code result = beast::error::timeout;
  bool done = false;
  start([&](beast::error_code error) {
    result = error;
    done = true;
  });
  context.restart();
  const double begun = monotonic_time();
  while (!done && monotonic_time() - begun < timeout) {
    if (context.run_one_for(microseconds(timeout)) == 0) break;
  }
  return result;
}

/// The reply's body; empty where there is none in time.
std::string http_get(const std::string& host, int port, const char* target, double timeout) {
  asio::io_context context;
  tcp::resolver resolver(context);
  beast::tcp_stream stream(context);
  stream.expires_after(microseconds(timeout));
  beast::error_code error;
  const auto ends = resolver.resolve(host, std::to_string(port), error);
  if (error) return {};
  error = result_of(context, timeout, [&](auto done) {
    stream.async_connect(ends, [done](beast::error_code e, const tcp::endpoint&) { done(e); });
  });
  if (error) return {};
  http::request<http::empty_body> request{http::verb::get, target, 11};
  request.set(http::field::host, host);
  http::response<http::string_body> response;
  beast::flat_buffer buffer;
  error = result_of(context, timeout, [&](auto done) {
    http::async_write(stream, request, [done](beast::error_code e, std::size_t) { done(e); });
  });
  if (error) return {};
  error = result_of(context, timeout, [&](auto done) {
    http::async_read(stream, buffer, response, [done](beast::error_code e, std::size_t) { done(e); });
  });
  return error ? std::string() : response.body();
}

using Socket = websocket::stream<beast::tcp_stream>;

beast::error_code connect_socket(asio::io_context& context, Socket& socket, const std::string& host, int port,
                                 double patience) {
  tcp::resolver resolver(context);
  beast::error_code error;
  const auto ends = resolver.resolve(host, std::to_string(port), error);
  if (!error) {
    error = result_of(context, patience, [&](auto done) {
      beast::get_lowest_layer(socket).async_connect(ends,
                                                    [done](beast::error_code e, const tcp::endpoint&) { done(e); });
    });
  }
  if (error) return error;
  // A force that waits for the next one to fill a segment comes 40 ms late.
  beast::get_lowest_layer(socket).socket().set_option(tcp::no_delay(true), error);
  const std::string where = host + ":" + std::to_string(port);
  error = result_of(context, patience, [&](auto done) { socket.async_handshake(where, "/", done); });
  socket.read_message_max(longest_message);
  socket.text(true);
  return error;
}

class HaplyService final : public HaplyLink {
 public:
  explicit HaplyService(const HaplySettings& settings) {
    version_ = parse_haply_version(http_get(settings.host, settings.port, "/version", haply_patience));
    if (const auto error = connect_socket(context_, answers_.socket, settings.host, settings.port, haply_patience)) {
      const std::string where = settings.host + ":" + std::to_string(settings.port);
      throw Refusal(say("haply-its-service-does-not-answer", where, error.message()));
    }
    hears_events_ = settings.events_port > 0 &&
                    !connect_socket(context_, events_.socket, settings.host, settings.events_port, events_patience);
    if (hears_events_) start_read(events_);
    start_read(answers_);
  }

  ~HaplyService() override {
    try {
      // The operations that are still under way end with their socket, and hand back what they borrow.
      beast::error_code ignored;
      for (Incoming* const one : {&answers_, &events_}) beast::get_lowest_layer(one->socket).socket().close(ignored);
      context_.restart();
      context_.run_for(std::chrono::milliseconds(100));
    } catch (const std::exception&) {
      lost_ = true;
    }
  }

  double now() noexcept override { return monotonic_time(); }
  bool lost() const noexcept override { return lost_; }
  HaplyVersion version() const noexcept override { return version_; }
  bool hears_events() const noexcept override { return hears_events_; }

  std::size_t receive(std::span<std::uint8_t> packet, double timeout) noexcept override {
    run([this] { return answers_.has_message || events_.has_message; }, timeout);
    Incoming& one = events_.has_message ? events_ : answers_;
    if (!one.has_message) return 0;
    one.has_message = false;
    const auto bytes = one.buffer.data();
    const std::size_t size = std::min(bytes.size(), packet.size());
    std::copy_n(static_cast<const std::uint8_t*>(bytes.data()), size, packet.begin());
    one.buffer.consume(one.buffer.size());
    guarded([&] { start_read(one); });
    return size;
  }

  bool send(std::span<const std::uint8_t> packet) noexcept override {
    run([this] { return !sending_; }, 0);
    if (sending_ || lost_) return false;
    guarded([&] {
      outgoing_.assign(packet.begin(), packet.end());
      sending_ = true;
      answers_.socket.async_write(asio::buffer(outgoing_), [this](beast::error_code error, std::size_t) {
        sending_ = false;
        if (error) lost_ = true;
      });
    });
    run([this] { return !sending_; }, 0);
    return !lost_;
  }

  bool flush(double timeout) noexcept override {
    run([this] { return !sending_; }, timeout);
    return !sending_ && !lost_;
  }

 private:
  struct Incoming {
    explicit Incoming(asio::io_context& context) : socket(context) {}
    Socket socket;
    beast::flat_buffer buffer;
    bool has_message = false;
  };

  void start_read(Incoming& one) {
    one.socket.async_read(one.buffer, [this, &one](beast::error_code error, std::size_t) {
      one.has_message = !error;
      // Both channels are one service's: where its brake is not heard any more nothing is pushed.
      if (error) lost_ = true;
    });
  }

  /// Lets the socket work until something holds or the time is over.
  template <typename Until>
  void run(const Until& until, double timeout) noexcept {
    guarded([&] {
      context_.restart();
      context_.poll();
      const double begun = monotonic_time();
      double left = timeout;
      while (!until() && !lost_ && left > 0) {
        context_.run_one_for(microseconds(left));
        left = timeout - (monotonic_time() - begun);
      }
    });
  }

  template <typename Run>
  void guarded(const Run& run) noexcept {
    try {
      run();
    } catch (const std::exception&) {
      lost_ = true;
    }
  }

  asio::io_context context_;
  Incoming answers_{context_};
  Incoming events_{context_};
  std::string outgoing_;
  HaplyVersion version_;
  bool hears_events_ = false;
  bool sending_ = false;
  bool lost_ = false;
};

}  // namespace

std::unique_ptr<HaplyLink> open_haply_service(const HaplySettings& settings) {
  return std::make_unique<HaplyService>(settings);
}

std::vector<FoundDevice> find_haply() {
  std::vector<FoundDevice> found;
  try {
    const auto service = open_haply_service(haply_defaults());
    std::vector<std::uint8_t> packet(longest_message);
    const std::size_t size = service->receive(packet, 0.5);
    for (const HaplyDevice& device : haply_inventory({reinterpret_cast<const char*>(packet.data()), size})) {
      found.push_back({"haply", "Haply " + device.type, device.id, true, describe(device)});
    }
  } catch (const std::exception&) {
    return found;
  }
  return found;
}

namespace {

/// "HOST:PORT" into the settings; what is no port leaves them as they are.
void take_place(std::string_view place, HaplySettings& settings) {
  const auto colon = place.rfind(':');
  if (colon == std::string_view::npos || colon == 0) return;
  int port = 0;
  const char* const end = place.data() + place.size();
  if (std::from_chars(place.data() + colon + 1, end, port).ptr != end || port <= 0 || port > 65535) return;
  settings.host = place.substr(0, colon);
  settings.port = port;
}

}  // namespace

HaplySettings haply_defaults() {
  HaplySettings settings;
  if (const char* const named = std::getenv("PALPATE_HAPLY")) take_place(named, settings);
  return settings;
}

bool send_zeros_to_haply(const std::string& address) {
  constexpr double patience = 0.3, nothing = 0.02;  // s; N
  const auto at = address.find('@');
  HaplySettings settings = haply_defaults();
  settings.address = address.substr(0, at);
  settings.events_port = 0;
  if (at != std::string::npos) take_place(std::string_view(address).substr(at + 1), settings);
  const auto service = open_haply_service(settings);
  HaplyProtocol protocol(settings);
  protocol.connect(*service);
  std::vector<std::uint8_t> packet(longest_message);
  const double begun = monotonic_time();
  while (!service->lost() && monotonic_time() - begun < patience) {
    if (const std::size_t size = service->receive(packet, 0.005); size > 0) {
      protocol.receive(std::span(packet).first(size), monotonic_time());
      const std::optional<Vec3> acting = protocol.acting_force();
      if (acting && glm::length(*acting) < nothing) return true;
    }
    if (const std::size_t due = protocol.step(Vec3(0), monotonic_time(), packet); due > 0) {
      service->send(std::span(packet).first(due));
    }
  }
  return false;
}

std::unique_ptr<Stylus> make_haply(const HaplySettings& settings) {
  LinkStylusOptions options;
  const std::string place = settings.address + "@" + settings.host + ":" + std::to_string(settings.port);
  if (settings.guarded) options.guardian = {guardian_program(), "haply", place};
  options.signs = settings.signs;
  options.stays_awake = true;
  return make_haply_on(
      settings, [settings]() -> std::unique_ptr<Link> { return open_haply_service(settings); }, options);
}

}  // namespace palpate::device

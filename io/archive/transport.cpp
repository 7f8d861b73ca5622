#include "io/archive/transport.h"

#include <dcmtk/dcmtls/tlslayer.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <filesystem>

#include "io/messages.h"

namespace palpate::io {
namespace {

/// A question and its answer are small messages that wait for each other: Nagle's algorithm costs 40 ms each.
void send_at_once(int socket) {
  const int on = 1;
  setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
}

class PlainLayer final : public DcmTransportLayer {
 public:
  explicit PlainLayer(Transport& owner) : owner_(owner) {}
  DcmTransportConnection* createConnection(DcmNativeSocketType socket, OFBool secure) override {
    owner_.socket = socket;
    send_at_once(socket);
    return DcmTransportLayer::createConnection(socket, secure);
  }

 private:
  Transport& owner_;
};

class TlsLayer final : public DcmTLSTransportLayer {
 public:
  TlsLayer(Transport& owner, T_ASC_NetworkRole side) : DcmTLSTransportLayer(side, nullptr, OFFalse), owner_(owner) {}
  DcmTransportConnection* createConnection(DcmNativeSocketType socket, OFBool secure) override {
    owner_.socket = socket;
    send_at_once(socket);
    return DcmTLSTransportLayer::createConnection(socket, secure);
  }

 private:
  Transport& owner_;
};

void require(bool good, const Archive& archive, const char* what, const std::filesystem::path& file) {
  if (!good) {
    throw ArchiveError(say("archive-cannot-be-used-for-tls", archive.name, what, file.string()));
  }
}

constexpr DcmTLSSecurityProfile profile = TSP_Profile_BCP195;

OFCondition set_certificate(DcmTLSTransportLayer& layer, const std::filesystem::path& file) {
#if PACKAGE_VERSION_NUMBER >= 368  // DCMTK's: Debian 12 has 3.6.7
  return layer.setCertificateFile(file.c_str(), DCF_Filetype_PEM, profile);
#else
  return layer.setCertificateFile(file.c_str(), DCF_Filetype_PEM);
#endif
}

void set_up(DcmTLSTransportLayer& layer, const Archive& archive) {
  const Tls& tls = archive.tls;
  require(layer.addTrustedCertificateFile(tls.authorities.c_str(), DCF_Filetype_PEM).good(), archive, "--tls-ca",
          tls.authorities);
  if (!tls.certificate.empty()) {
    require(layer.setPrivateKeyFile(tls.key.c_str(), DCF_Filetype_PEM).good(), archive, "--tls-key", tls.key);
    require(set_certificate(layer, tls.certificate).good(), archive, "--tls-certificate", tls.certificate);
    if (!layer.checkPrivateKeyMatchesCertificate()) {
      throw ArchiveError(
          say("archive-tls-key-does-not-belong", archive.name, tls.key.string(), tls.certificate.string()));
    }
  }
  if (layer.setTLSProfile(profile).bad() || layer.activateCipherSuites().bad()) {
    throw ArchiveError(say("archive-the-openssl-that-is-installed-cannot", archive.name));
  }
  layer.setCertificateVerification(DCV_requireCertificate);
}

}  // namespace

std::unique_ptr<Transport> make_transport(const Archive& archive, T_ASC_NetworkRole role) {
  auto transport = std::make_unique<Transport>();
  if (archive.tls.used) {
    static std::once_flag once;
    std::call_once(once, [] { DcmTLSTransportLayer::initializeOpenSSL(); });
    auto layer = std::make_unique<TlsLayer>(*transport, role);
    set_up(*layer, archive);
    transport->layer = std::move(layer);
  } else {
    transport->layer = std::make_unique<PlainLayer>(*transport);
  }
  return transport;
}

Watch::Watch(int socket, int silence_s) : socket_(socket), silence_(silence_s) {
  thread_ = std::jthread([this](const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    while (!stop.stop_requested()) {
      const auto until = last_.load(std::memory_order_relaxed) + silence_;
      if (std::chrono::steady_clock::now() >= until) {
        end();
        return;
      }
      wake_.wait_until(lock, stop, until, [] { return false; });
    }
  });
}

Watch::~Watch() = default;  // the thread first: it is the last member

void Watch::end() noexcept {
  ended_.store(true, std::memory_order_relaxed);
  if (socket_ >= 0) {
    ::shutdown(socket_, SHUT_RDWR);
  }
}

}  // namespace palpate::io

#include "io/archive/transport.h"

#include <dcmtk/dcmtls/tlslayer.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <openssl/ssl.h>
#include <openssl/x509_vfy.h>
#include <openssl/x509v3.h>
#include <sys/socket.h>

#include <algorithm>
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

/// Where a context's Transport is found by a callback of OpenSSL's.
int transport_index() {
  static const int index = SSL_CTX_get_ex_new_index(0, nullptr, nullptr, nullptr, nullptr);
  return index;
}

/// Changes nothing of the verdict; remembers why it was bad.
int note_verdict(int good, X509_STORE_CTX* verified) {
  const int error = X509_STORE_CTX_get_error(verified);
  if (good == 0 && (error == X509_V_ERR_HOSTNAME_MISMATCH || error == X509_V_ERR_IP_ADDRESS_MISMATCH)) {
    auto* const connection =
        static_cast<SSL*>(X509_STORE_CTX_get_ex_data(verified, SSL_get_ex_data_X509_STORE_CTX_idx()));
    auto* const transport =
        static_cast<Transport*>(SSL_CTX_get_ex_data(SSL_get_SSL_CTX(connection), transport_index()));
    transport->names_other = true;
  }
  return good;
}

/// Makes OpenSSL refuse, during the handshake, a certificate for another machine. An address is compared with the
/// certificate's addresses, a name with its names, or with its common name if it has none.
void require_name(DcmTLSTransportLayer& layer, const Archive& archive, Transport& transport) {
  const std::string& name = archive.tls.name.empty() ? archive.host : archive.tls.name;
  SSL_CTX* const context = layer.getNativeHandle();
  X509_VERIFY_PARAM* const wanted = SSL_CTX_get0_param(context);
  X509_VERIFY_PARAM_set_hostflags(wanted, X509_CHECK_FLAG_NO_PARTIAL_WILDCARDS);
  const bool is_known = X509_VERIFY_PARAM_set1_ip_asc(wanted, name.c_str()) == 1 ||
                        X509_VERIFY_PARAM_set1_host(wanted, name.data(), name.size()) == 1;
  if (!is_known || SSL_CTX_set_ex_data(context, transport_index(), &transport) != 1) {
    throw ArchiveError(say("archive-the-openssl-that-is-installed-cannot", archive.name));
  }
  SSL_CTX_set_verify(context, SSL_VERIFY_PEER, note_verdict);
}

}  // namespace

std::unique_ptr<Transport> make_transport(const Archive& archive, T_ASC_NetworkRole role) {
  auto transport = std::make_unique<Transport>();
  if (archive.tls.used) {
    static std::once_flag once;
    std::call_once(once, [] { DcmTLSTransportLayer::initializeOpenSSL(); });
    auto layer = std::make_unique<TlsLayer>(*transport, role);
    set_up(*layer, archive);
    if (role == NET_REQUESTOR) require_name(*layer, archive, *transport);
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
      const auto now = std::chrono::steady_clock::now(), until = last_.load(std::memory_order_relaxed) + silence_;
      cancelled_.store(!goes_on(), std::memory_order_relaxed);
      if (now >= until || cancelled()) {
        end();
        return;
      }
      const auto next = keep_going_ ? std::min(until, now + std::chrono::seconds(1)) : until;
      wake_.wait_until(lock, stop, next, [this, asks = bool(keep_going_)] { return asks != bool(keep_going_); });
    }
  });
}

void Watch::ask(KeepGoing keep_going) {
  const std::lock_guard lock(mutex_);
  keep_going_ = std::move(keep_going);
  wake_.notify_all();
}

bool Watch::goes_on() noexcept {
  try {
    return !keep_going_ || keep_going_();
  } catch (...) {
    return false;  // whoever asks next hears of it
  }
}

Watch::~Watch() = default;  // the thread first: it is the last member

void Watch::end() noexcept {
  ended_.store(true, std::memory_order_relaxed);
  if (socket_ >= 0) {
    ::shutdown(socket_, SHUT_RDWR);
  }
}

}  // namespace palpate::io

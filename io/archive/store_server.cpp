#include "io/archive/store_server.h"

#include <arpa/inet.h>
#include <dcmtk/dcmdata/dcuid.h>
#include <dcmtk/dcmnet/cond.h>
#include <dcmtk/dcmnet/dul.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>

#include "io/archive/status_words.h"
#include "io/errors.h"
#include "io/messages.h"

namespace palpate::io {
namespace {

constexpr int greeting_s = 10;  // for TLS and the association's first message

int listen_on(const Archive& archive) {
  const auto refuse = [&](const std::string& why) {
    throw ArchiveError(say("cannot-listen-on", archive.listen_address, archive.listen_port, archive.name, why));
  };
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(archive.listen_port));
  if (inet_pton(AF_INET, archive.listen_address.c_str(), &address.sin_addr) != 1) refuse(say("no-ipv4-address"));
  const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const int on = 1;
  if (socket < 0) refuse(std::generic_category().message(errno));
  setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  if (bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 || listen(socket, 8) != 0) {
    const int error = errno;
    close(socket);
    refuse(std::generic_category().message(error));
  }
  return socket;
}

/// DCMTK is handed a connection that was accepted already through a global.
std::mutex& external_socket() {
  static std::mutex mutex;
  return mutex;
}

struct Network {
  T_ASC_Network* network = nullptr;
  T_ASC_Association* association = nullptr;
  Network() = default;
  Network(const Network&) = delete;
  Network& operator=(const Network&) = delete;
  ~Network() {
    if (association != nullptr) {
      ASC_dropSCPAssociation(association, 1);
      ASC_destroyAssociation(&association);
    }
    if (network != nullptr) ASC_dropNetwork(&network);
  }
};

OFCondition receive_association(const Archive& archive, Transport& transport, int socket, Network& net) {
  const std::lock_guard lock(external_socket());
  dcmExternalSocketHandle.set(socket);
  OFCondition condition = ASC_initializeNetwork(NET_ACCEPTOR, 0, greeting_s, &net.network);
  if (condition.good()) {
    ASC_setTransportLayer(net.network, transport.layer.get(), 0);
    condition = ASC_receiveAssociation(net.network, &net.association, maximum_pdu, nullptr, nullptr, archive.tls.used,
                                       DUL_NOBLOCK, greeting_s);
  }
  dcmExternalSocketHandle.set(-1);
  return condition;
}

void accept_contexts(T_ASC_Association& association) {
  std::vector<const char*> syntaxes;
  syntaxes.reserve(uncompressed_syntaxes().size() + compressed_syntaxes().size());
  for (const std::string& syntax : uncompressed_syntaxes()) syntaxes.push_back(syntax.c_str());
  for (const std::string& syntax : compressed_syntaxes()) syntaxes.push_back(syntax.c_str());
  const char* verification = UID_VerificationSOPClass;
  ASC_acceptContextsWithPreferredTransferSyntaxes(association.params, &verification, 1, syntaxes.data(),
                                                  static_cast<int>(uncompressed_syntaxes().size()));
  ASC_acceptContextsWithPreferredTransferSyntaxes(association.params, dcmAllStorageSOPClassUIDs,
                                                  numberOfDcmAllStorageSOPClassUIDs, syntaxes.data(),
                                                  static_cast<int>(syntaxes.size()));
}

std::string trimmed(const char* title) {
  std::string text = title;
  text.erase(0, std::min(text.find_first_not_of(' '), text.size()));
  text.erase(text.find_last_not_of(' ') + 1);
  return text;
}

}  // namespace

StoreServer::StoreServer(const Archive& archive, Inbox& inbox)
    : archive_(archive), inbox_(inbox), listening_(listen_on(archive)), thread_([this] { run(); }) {}

StoreServer::~StoreServer() {
  stopping_.store(true, std::memory_order_relaxed);
  {
    const std::lock_guard lock(mutex_);
    if (watch_ != nullptr) watch_->end();  // an archive may be silent in the middle of an image
  }
  thread_.join();
  close(listening_);
}

StoreServer::Active::Active(StoreServer& server, Watch& watch) : server_(server) {
  const std::lock_guard lock(server_.mutex_);
  server_.watch_ = &watch;
}

StoreServer::Active::~Active() {
  const std::lock_guard lock(server_.mutex_);
  server_.watch_ = nullptr;
}

void StoreServer::rethrow() {
  const std::lock_guard lock(mutex_);
  if (failure_) std::rethrow_exception(failure_);
}

std::string StoreServer::turned_away() {
  const std::lock_guard lock(mutex_);
  return turned_away_;
}

void StoreServer::run() {
  while (!stopping_.load(std::memory_order_relaxed)) {
    pollfd ready{listening_, POLLIN, 0};
    if (poll(&ready, 1, 100) <= 0) continue;
    const int socket = accept4(listening_, nullptr, nullptr, SOCK_CLOEXEC);
    if (socket < 0) continue;
    try {
      serve(socket);
    } catch (...) {
      const std::lock_guard lock(mutex_);
      failure_ = std::current_exception();
      return;
    }
  }
}

void StoreServer::serve(int socket) {
  const std::unique_ptr<Transport> transport = make_transport(archive_, NET_ACCEPTOR);
  Network net;
  {
    Watch greeting(socket, greeting_s);
    if (receive_association(archive_, *transport, socket, net).bad()) {
      if (transport->socket < 0) close(socket);  // nothing of DCMTK's owns it yet
      return;
    }
  }
  if (!let_in(*net.association)) return;
  accept_contexts(*net.association);
  if (ASC_acknowledgeAssociation(net.association).bad()) return;
  Watch watch(socket, archive_.silence_s);
  const Active active(*this, watch);
  try {
    converse(*net.association, watch);
  } catch (...) {
    {
      const std::lock_guard lock(mutex_);
      failure_ = std::current_exception();  // before the archive can tell of it
    }
    // Nothing answers an abort. DCMTK would read until the peer closes, which takes long if the peer is silent.
    ::shutdown(socket, SHUT_RD);
    ASC_abortAssociation(net.association);
    throw;
  }
}

bool StoreServer::let_in(T_ASC_Association& association) {
  const std::string calling = trimmed(association.params->DULparams.callingAPTitle);
  const std::string called = trimmed(association.params->DULparams.calledAPTitle);
  // Spaces at either end do not belong to a title (PS3.5 6.2, AE).
  const bool known = calling == trimmed(archive_.called.c_str());
  if (known && called == trimmed(archive_.calling.c_str())) return true;
  {
    const std::lock_guard lock(mutex_);
    turned_away_ = fmt::format("{} called us {}", printable(calling), printable(called));
  }
  const T_ASC_RejectParameters reject{
      ASC_RESULT_REJECTEDPERMANENT, ASC_SOURCE_SERVICEUSER,
      known ? ASC_REASON_SU_CALLEDAETITLENOTRECOGNIZED : ASC_REASON_SU_CALLINGAETITLENOTRECOGNIZED};
  ASC_rejectAssociation(&association, &reject);
  return false;
}

void StoreServer::converse(T_ASC_Association& association, Watch& watch) {
  const KeepGoing keep_going = [this] { return !stopping_.load(std::memory_order_relaxed); };
  while (true) {
    while (ASC_dataWaiting(&association, 1) == OFFalse) {
      if (watch.ended()) return;
      if (!keep_going()) throw Cancelled();
    }
    Command command;
    const OFCondition received = DIMSE_receiveCommand(&association, DIMSE_NONBLOCKING, archive_.silence_s,
                                                      &command.context, &command.message, nullptr);
    watch.heard();
    if (received == DUL_PEERREQUESTEDRELEASE) {
      ASC_acknowledgeRelease(&association);
      return;
    }
    if (received.bad()) return;
    if (command.message.CommandField == DIMSE_C_ECHO_RQ) {
      DIMSE_sendEchoResponse(&association, command.context, &command.message.msg.CEchoRQ, STATUS_Success, nullptr);
    } else if (command.message.CommandField == DIMSE_C_STORE_RQ) {
      OFCondition broken;
      T_DIMSE_C_StoreRSP response{};
      response.DimseStatus = inbox_.store(association, watch, archive_.silence_s, command, keep_going, broken);
      if (broken.bad()) return;
      DIMSE_sendStoreResponse(&association, command.context, &command.message.msg.CStoreRQ, &response, nullptr);
    } else {
      ASC_abortAssociation(&association);
      return;
    }
  }
}

}  // namespace palpate::io

#include "io/archive/association.h"

#include <dcmtk/dcmdata/dcistrmb.h>
#include <dcmtk/dcmdata/dctk.h>
#include <dcmtk/dcmnet/cond.h>
#include <dcmtk/dcmnet/dcmtrans.h>
#include <dcmtk/dcmnet/diutil.h>
#include <dcmtk/dcmnet/dul.h>
#include <dcmtk/dcmtls/tlscond.h>
#include <fmt/format.h>
#include <sys/socket.h>

#include <algorithm>
#include <mutex>

#include "io/archive/status_words.h"
#include "io/dicom/dcmtk_start.h"
#include "io/errors.h"
#include "io/messages.h"

namespace palpate::io {
namespace {

constexpr int connect_s = 10;
bool is(const OFCondition& condition, unsigned short code) {
  return condition.module() == OFM_dcmnet && condition.code() == code;
}

std::string where(const Archive& archive) {
  return fmt::format("archive {} ({}:{})", archive.name, archive.host, archive.port);
}

Text refusal_words(const Archive& archive, T_ASC_Parameters* parameters) {
  T_ASC_RejectParameters reject{};
  ASC_getRejectParameters(parameters, &reject);
  switch (reject.reason) {
    case ASC_REASON_SU_CALLEDAETITLENOTRECOGNIZED:
      return say("archive-title-not-known", where(archive), archive.called);
    case ASC_REASON_SU_CALLINGAETITLENOTRECOGNIZED:
      return say("does-not-know-our-title", where(archive), archive.calling);
    case ASC_REASON_SP_PRES_TEMPORARYCONGESTION:
    case ASC_REASON_SP_PRES_LOCALLIMITEXCEEDED:
      return say("too-busy-to-talk-to-us", where(archive));
    default:
      return say("refused-the-association-and-did-not-say", where(archive), archive.called, archive.calling);
  }
}

Text failure_words(const Archive& archive, const OFCondition& condition, bool silent) {
  if (silent || is(condition, DULC_READTIMEOUT) || is(condition, DIMSEC_NODATAAVAILABLE)) {
    return say("silent", where(archive), archive.silence_s);
  }
  if (is(condition, DULC_UNKNOWNHOST)) {
    return say("no-machine-of-that-name-is-known", where(archive));
  }
  if (condition.module() == OFM_dcmtls || is(condition, DULC_TLSERROR)) {
    return say("tls-with-failed", where(archive));
  }
  return say("broke-the-connection-off", where(archive), archive.tls.used ? " with TLS" : " without TLS");
}

Text connection_words(const Archive& archive, const OFCondition& condition) {
  const std::string text = condition.text();
  if (is(condition, DULC_TCPINITERROR) || is(condition, DULC_REQUESTASSOCIATIONFAILED)) {
    const std::size_t colon = text.find("Connection refused") != std::string::npos ? 0 : text.rfind(": ");
    const std::string why = colon == 0                   ? "connection refused"
                            : colon == std::string::npos ? "no connection"
                                                         : printable(text.substr(colon + 2));
    return say("cannot-be-reached", where(archive), why);
  }
  return failure_words(archive, condition, false);
}

Text other_machine_words(const Archive& archive) {
  const std::string& name = archive.tls.name.empty() ? archive.host : archive.tls.name;
  return say("certificate-is-for-another-machine", where(archive), name);
}

void require(const OFCondition& condition, const Archive& archive) {
  if (condition.bad()) throw ArchiveError(failure_words(archive, condition, false));
}

std::vector<const char*> pointers(const std::vector<std::string>& texts) {
  std::vector<const char*> result;
  result.reserve(texts.size());
  for (const std::string& text : texts) result.push_back(text.c_str());
  return result;
}

T_ASC_Parameters* make_parameters(const Archive& archive, const std::vector<Proposal>& proposals) {
  T_ASC_Parameters* parameters = nullptr;
#if PACKAGE_VERSION_NUMBER >= 368  // DCMTK's: Debian 12 has 3.6.7
  require(ASC_createAssociationParameters(&parameters, maximum_pdu, connect_s), archive);
#else
  require(ASC_createAssociationParameters(&parameters, maximum_pdu), archive);
#endif
  ASC_setAPTitles(parameters, archive.calling.c_str(), archive.called.c_str(), nullptr);
  const std::string peer = fmt::format("{}:{}", archive.host, archive.port);
  ASC_setPresentationAddresses(parameters, OFStandard::getHostName().c_str(), peer.c_str());
  ASC_setTransportLayerType(parameters, archive.tls.used);
  int id = 1;
  for (const Proposal& proposal : proposals) {
    if (id > 255) break;  // DICOM PS3.8 9.3.2.2: odd numbers of a byte
    std::vector<const char*> syntaxes = pointers(proposal.transfer_syntaxes);
    ASC_addPresentationContext(parameters, static_cast<T_ASC_PresentationContextID>(id), proposal.sop_class.c_str(),
                               syntaxes.data(), static_cast<int>(syntaxes.size()),
                               proposal.we_receive ? ASC_SC_ROLE_SCP : ASC_SC_ROLE_DEFAULT);
    id += 2;
  }
  return parameters;
}

void set_network_defaults(const Archive& archive) {
  static std::once_flag once;
  std::call_once(once, [] {
    dcmConnectionTimeout.set(connect_s);
    dcmDisableGethostbyaddr.set(OFTrue);  // no name is looked up for who connects to us
  });
  dcmSocketSendTimeout.set(archive.silence_s);
  dcmSocketReceiveTimeout.set(archive.silence_s);
}

}  // namespace

void check(const Archive& archive) {
  const auto refuse = [&](const Text& what) { throw ArchiveError(at_place("archive " + archive.name, what)); };
  const auto is_title = [](const std::string& title) {
    return !title.empty() && title.size() <= 16 &&
           std::ranges::all_of(title, [](char c) { return c >= ' ' && c <= '~' && c != '\\'; }) &&
           title.find_first_not_of(' ') != std::string::npos;
  };
  const auto is_port = [](int port) { return port > 0 && port < 65536; };
  if (archive.host.empty() || printable(archive.host) != archive.host) refuse(say("host-has-to-be-a-machine-name"));
  if (!is_port(archive.port) || !is_port(archive.listen_port)) refuse(say("port-is-a-number-from-1"));
  if (!is_title(archive.called) || !is_title(archive.calling)) refuse(say("ae-title-has-1-to-16"));
  if (archive.silence_s < 1 || archive.silence_s > 3600) refuse(say("time-to-wait"));
  if (!archive.tls.used) return;
  if (archive.tls.authorities.empty()) refuse(say("tls-needs-tls-ca"));
  if (archive.tls.certificate.empty() != archive.tls.key.empty())
    refuse(say("tls-certificate-and-tls-key-go-together"));
  if (!archive.uses_get && archive.tls.certificate.empty()) {
    refuse(say("c-move-needs-a-certificate"));
  }
}

Association::Association(const Archive& archive, const std::vector<Proposal>& proposals) : archive_(archive) {
  internal::start_dcmtk();
  check(archive);
  set_network_defaults(archive);
  transport_ = make_transport(archive, NET_REQUESTOR);
  require(ASC_initializeNetwork(NET_REQUESTOR, 0, archive.silence_s, &network_), archive);
  ASC_setTransportLayer(network_, transport_->layer.get(), 0);
  T_ASC_Parameters* parameters = make_parameters(archive, proposals);
  const OFCondition asked =
      ASC_requestAssociation(network_, parameters, &association_, nullptr, nullptr, DUL_NOBLOCK, archive.silence_s);
  if (asked.bad()) {
    const Text words = is(asked, DULC_ASSOCIATIONREJECTED) ? refusal_words(archive, parameters)
                       : transport_->names_other           ? other_machine_words(archive)
                                                           : connection_words(archive, asked);
    if (association_ == nullptr) ASC_destroyAssociationParameters(&parameters);  // else they go with it
    ASC_destroyAssociation(&association_);
    ASC_dropNetwork(&network_);
    throw ArchiveError(words);
  }
  watch_ = std::make_unique<Watch>(transport_->socket, archive.silence_s);
}

Association::~Association() {
  const bool ended = watch_->ended();
  watch_.reset();
  if (broken_ || ended) {
    // Nothing answers an abort. DCMTK would read until the peer closes, which takes long if the peer is silent.
    if (transport_->socket >= 0) ::shutdown(transport_->socket, SHUT_RD);
    ASC_abortAssociation(association_);
  } else {
    ASC_releaseAssociation(association_);
  }
  ASC_destroyAssociation(&association_);
  ASC_dropNetwork(&network_);
}

void Association::fail(const OFCondition& condition) {
  broken_ = true;
  if (watch_->cancelled()) throw Cancelled();
  throw ArchiveError(failure_words(archive_, condition, watch_->ended()));
}

bool Association::accepts(const std::string& sop_class) const {
  return ASC_findAcceptedPresentationContextID(association_, sop_class.c_str()) != 0;
}

T_ASC_PresentationContextID Association::context_for(const std::string& sop_class) const {
  const T_ASC_PresentationContextID id = ASC_findAcceptedPresentationContextID(association_, sop_class.c_str());
  if (id == 0) {
    throw ArchiveError(say("does-not-offer-us-this-service", where(archive_),
                           dcmFindNameOfUID(sop_class.c_str(), sop_class.c_str()), archive_.calling));
  }
  return id;
}

void Association::send(Command& command, DcmDataset* dataset) {
  watch_->heard();
  // A dataset may take longer than the silence that is allowed: each piece that went counts.
  const DIMSE_ProgressCallback went = [](void* watch, unsigned long) { static_cast<Watch*>(watch)->heard(); };
  const OFCondition sent = DIMSE_sendMessageUsingMemoryData(association_, command.context, &command.message, nullptr,
                                                            dataset, went, watch_.get());
  if (sent.bad()) fail(sent);
  watch_->heard();
}

Command Association::receive(const KeepGoing& keep_going) {
  while (ASC_dataWaiting(association_, 1) == OFFalse) {
    if (watch_->ended()) fail(DUL_READTIMEOUT);
    if (keep_going && !keep_going()) {
      broken_ = true;
      throw Cancelled();
    }
  }
  Command command;
  DcmDataset* detail = nullptr;
  const OFCondition received = DIMSE_receiveCommand(association_, DIMSE_NONBLOCKING, archive_.silence_s,
                                                    &command.context, &command.message, &detail);
  delete detail;  // its comment may hold names
  if (received.bad()) fail(received);
  watch_->heard();
  return command;
}

std::unique_ptr<DcmDataset> Association::receive_dataset(T_ASC_PresentationContextID context, std::size_t most_bytes) {
  std::string bytes;
  bool too_long = false;
  const OFCondition received =
      stream_dataset(*association_, archive_.silence_s, *watch_, [&](const void* data, std::size_t n) {
        too_long = bytes.size() + n > most_bytes;
        if (!too_long) bytes.append(static_cast<const char*>(data), n);
        return !too_long;
      });
  if (too_long) {
    broken_ = true;
    throw ArchiveError(say("answer-too-long", where(archive_), most_bytes));
  }
  if (received.bad()) fail(received);
  E_TransferSyntax syntax = EXS_Unknown;
  T_ASC_PresentationContext agreed{};
  if (ASC_findAcceptedPresentationContext(association_->params, context, &agreed).good()) {
    syntax = DcmXfer(agreed.acceptedTransferSyntax).getXfer();
  }
  auto dataset = std::make_unique<DcmDataset>();
  DcmInputBufferStream stream;
  stream.setBuffer(bytes.data(), static_cast<offile_off_t>(bytes.size()));
  stream.setEos();
  dataset->transferInit();
  const OFCondition parsed = dataset->read(stream, syntax);
  dataset->transferEnd();
  if (parsed.bad()) {
    broken_ = true;
    throw ArchiveError(say("answer-is-no-dataset", where(archive_)));
  }
  return dataset;
}

OFCondition stream_dataset(T_ASC_Association& association, int silence_s, Watch& watch,
                           const std::function<bool(const void*, std::size_t)>& sink) {
  for (bool last = false; !last;) {
    DUL_PDV pdv{};
    OFCondition next = DUL_NextPDV(&association.DULassociation, &pdv);
    if (next.bad()) {
      next = DUL_ReadPDVs(&association.DULassociation, nullptr, DUL_NOBLOCK, silence_s);
      if (!is(next, DULC_PDATAPDUARRIVED)) {
        return next.good() ? DUL_READTIMEOUT : next;
      }
      next = DUL_NextPDV(&association.DULassociation, &pdv);
      if (next.bad()) return next;
    }
    watch.heard();
    if (pdv.pdvType != DUL_DATASETPDV) return DIMSE_UNEXPECTEDPDVTYPE;
    if (pdv.fragmentLength > 0 && !sink(pdv.data, pdv.fragmentLength)) return DIMSE_OUTOFRESOURCES;
    last = pdv.lastPDV == OFTrue;
  }
  return EC_Normal;
}

const std::vector<std::string>& uncompressed_syntaxes() {
  static const std::vector<std::string> syntaxes = {UID_LittleEndianExplicitTransferSyntax,
                                                    UID_LittleEndianImplicitTransferSyntax};
  return syntaxes;
}

const std::vector<std::string>& compressed_syntaxes() {
  static const std::vector<std::string> syntaxes = {
      UID_JPEGProcess14SV1TransferSyntax, UID_JPEG2000LosslessOnlyTransferSyntax,
      UID_JPEGLSLosslessTransferSyntax,   UID_RLELosslessTransferSyntax,
      UID_JPEGProcess14TransferSyntax,    UID_JPEG2000TransferSyntax,
      UID_JPEGLSLossyTransferSyntax,      UID_JPEGProcess2_4TransferSyntax,
      UID_JPEGProcess1TransferSyntax,     UID_JPEGProcess10_12TransferSyntax,
      UID_JPEGProcess6_8TransferSyntax,   UID_DeflatedExplicitVRLittleEndianTransferSyntax,
      UID_BigEndianExplicitTransferSyntax};
  return syntaxes;
}

}  // namespace palpate::io

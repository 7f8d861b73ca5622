#include <dcmtk/config/osconfig.h>
// DCMTK's configuration comes first.
#include <dcmtk/dcmdata/dcuid.h>

#include "io/archive/association.h"
#include "io/archive/status_words.h"
#include "io/messages.h"

namespace palpate::io {

void echo(const Archive& archive) {
  Association association(archive, {{UID_VerificationSOPClass, uncompressed_syntaxes()}});
  Command ask;
  ask.context = association.context_for(UID_VerificationSOPClass);
  ask.message.CommandField = DIMSE_C_ECHO_RQ;
  T_DIMSE_C_EchoRQ& request = ask.message.msg.CEchoRQ;
  request.MessageID = association.next_message_id();
  request.DataSetType = DIMSE_DATASET_NULL;
  OFStandard::strlcpy(request.AffectedSOPClassUID, UID_VerificationSOPClass, sizeof request.AffectedSOPClassUID);
  association.send(ask);
  const Command answer = association.receive({});
  if (answer.message.CommandField != DIMSE_C_ECHO_RSP || answer.message.msg.CEchoRSP.DimseStatus != STATUS_Success) {
    const bool is_echo = answer.message.CommandField == DIMSE_C_ECHO_RSP;
    throw ArchiveError(say("archive-answered-and-refused-the-echo", archive.name,
                           status_words(is_echo ? answer.message.msg.CEchoRSP.DimseStatus : std::uint16_t{0x0211})));
  }
}

}  // namespace palpate::io

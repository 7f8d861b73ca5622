#include "io/dicom/dcmtk_start.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcdict.h>
#include <dcmtk/oflog/oflog.h>

#include <mutex>

#include "io/errors.h"
#include "io/messages.h"

namespace palpate::io::internal {

void check_dictionary(const DcmDataDictionary& dictionary, bool loaded) {
  if (!loaded || dictionary.numberOfNormalTagEntries() == 0) {
    throw DicomError(say("dcmtk-data-dictionary-is-missing"));
  }
}

void start_dcmtk() {
  static std::once_flag once;
  std::call_once(once, [] {
    OFLog::configure(OFLogger::OFF_LOG_LEVEL);
    // The global dictionary is loaded here, before any of our threads could race for it.
    const DcmDataDictionary& dictionary = dcmDataDict.rdlock();
    const bool filled = dictionary.isDictionaryLoaded();
    dcmDataDict.rdunlock();
    check_dictionary(dictionary, filled);
  });
}

}  // namespace palpate::io::internal

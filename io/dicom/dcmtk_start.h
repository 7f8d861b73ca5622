#pragma once

class DcmDataDictionary;

namespace palpate::io::internal {

/// To be called before any other use of DCMTK, from any thread: registers its decoders, silences its log (which names
/// files and attributes), checks its data dictionary. Throws DicomError where that is missing.
void start_dcmtk();

/// Throws DicomError for a dictionary without entries: implicit-VR attributes would silently lose their types.
void check_dictionary(const DcmDataDictionary& dictionary, bool loaded);

}  // namespace palpate::io::internal

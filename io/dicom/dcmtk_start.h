#pragma once

class DcmDataDictionary;

namespace palpate::io::internal {

/// Must be called before any other use of DCMTK, from any thread: registers its decoders, silences its log (which names
/// files and attributes) and checks its data dictionary. Throws DicomError if the dictionary is missing.
void start_dcmtk();

/// Throws DicomError for a dictionary without entries: with it DCMTK would read attributes of implicit VR without their
/// types, and report no error.
void check_dictionary(const DcmDataDictionary& dictionary, bool loaded);

}  // namespace palpate::io::internal

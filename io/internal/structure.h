#pragma once

class DcmInputStream;

namespace palpate::io::internal {

/// How a dataset is written.
struct Encoding {
  bool big_endian = false;
  bool explicit_vr = true;
};

/// Walks over a dataset up to its pixel data without building anything, and throws DicomError where a parser that does
/// build would overflow its stack (sequences nested deeper than any object defined), run for hours (elements in no
/// order, which is quadratic in DCMTK) or fill the memory (millions of elements), or where the bytes are no elements or
/// end early.
void check_structure(DcmInputStream& dataset, Encoding encoding);

}  // namespace palpate::io::internal

#pragma once

/// Reads attribute values of a DCMTK item, and invents none: DCMTK's own findAndGetFloat64 writes 0 when it fails, and
/// its conversion from text to number is not correctly rounded.

#include <optional>
#include <string>
#include <vector>

class DcmItem;
class DcmTagKey;

namespace palpate::io::internal {

/// All values of a text attribute (separated by backslashes), without trailing padding; empty if absent.
std::string text_of(DcmItem& item, const DcmTagKey& tag);
/// The value of a code, which has one of three places (PS3.3 8.1): short, long, or a URN.
std::string code_value(DcmItem& item);

/// The values of a numeric attribute (DS, IS or binary). Empty if absent or if one of them is not a finite number.
std::vector<double> numbers_of(DcmItem& item, const DcmTagKey& tag);

/// The first value of a numeric attribute.
std::optional<double> number_of(DcmItem& item, const DcmTagKey& tag);

/// The first item of a sequence; null if absent or empty.
DcmItem* first_item(DcmItem& item, const DcmTagKey& sequence);

}  // namespace palpate::io::internal

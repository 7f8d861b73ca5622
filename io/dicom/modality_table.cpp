#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcdeftag.h>
#include <dcmtk/dcmdata/dcelem.h>
#include <dcmtk/dcmdata/dcitem.h>

#include <cmath>

#include "io/dicom/dicom_value.h"
#include "io/dicom/planes.h"
#include "io/messages.h"

namespace palpate::io::internal {
namespace {

// LUTData holds a word an entry, or a byte where entries have 8 bits and the writer packed them.
std::vector<float> entries_of(DcmItem& table, std::size_t count, bool may_be_bytes) {
  DcmElement* element = nullptr;
  Uint16* words = nullptr;
  if (table.findAndGetElement(DCM_LUTData, element).bad()) return {};
  const std::size_t length = element->getLength();
  std::vector<float> entries;
  if (element->getUint16Array(words).bad() || words == nullptr) {
    for (const double value : numbers_of(table, DCM_LUTData)) entries.push_back(static_cast<float>(value));
  } else if (length >= 2 * count) {
    entries.assign(words, words + count);
  } else if (may_be_bytes && length >= count) {
    for (std::size_t n = 0; n < count; ++n) entries.push_back(static_cast<float>(words[n / 2] >> 8 * (n % 2) & 0xFF));
  }
  if (entries.size() < count) return {};
  entries.resize(count);
  return entries;
}

}  // namespace

void read_modality_table(DcmItem& dataset, FileHeader& header) {
  DcmItem* const item = first_item(dataset, DCM_ModalityLUTSequence);
  if (item == nullptr || !header.unfit.empty()) return;
  const std::vector<double> descriptor = numbers_of(*item, DCM_LUTDescriptor);
  if (descriptor.size() < 3) {
    header.unfit = say("modality-look-up-table-is-damaged");
    return;
  }
  constexpr double words = 65536;
  const double count = descriptor[0] == 0 ? words : std::fmod(descriptor[0] + words, words);  // may be read as signed
  auto table = std::make_shared<ModalityTable>();
  const bool negative = header.format.is_signed && descriptor[1] > 32767;
  table->first = negative ? descriptor[1] - words : descriptor[1];
  table->values = entries_of(*item, static_cast<std::size_t>(count), descriptor[2] <= 8);
  if (table->values.empty()) {
    header.unfit = say("modality-look-up-table-is-damaged");
    return;
  }
  header.table = std::move(table);
  header.unit = text_of(*item, DCM_ModalityLUTType) == "HU" ? "HU" : "";
}

}  // namespace palpate::io::internal

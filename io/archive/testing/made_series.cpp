#include "io/archive/testing/made_series.h"

#include <dcmtk/config/osconfig.h>
// DCMTK's configuration comes first.
#include <dcmtk/dcmdata/dctk.h>

#include "io/fresh_folder.h"
#include "io/testing/test_coders.h"
#include "io/testing/test_image.h"

namespace palpate::io::testing {
namespace {

namespace fs = std::filesystem;
using internal::put;

/// `number` tells its study, its series, its patient and its day from the others'.
void write(const fs::path& folder, int number, const char* modality, int slices, int width = 16,
           E_TransferSyntax syntax = EXS_LittleEndianExplicit) {
  fs::create_directory(folder);
  const std::string study = internal::numbered("1.2.826.0.1.3680043.10.1.", number);
  internal::write_stack(folder, slices, [&](int k, internal::TestImage& image) {
    image.columns = image.rows = width;
    image.series = study + ".1";
    image.instance = internal::numbered(image.series + ".", k + 1);
    image.syntax = syntax;
    image.value = [k, number](int i, int j) { return (37 * i + 101 * j + 1009 * k + 11 * number) % 4096; };
    image.edit = [&](DcmDataset& dataset) {
      put(dataset, DCM_StudyInstanceUID, study);
      put(dataset, DCM_StudyDate, internal::numbered("2020010", number));
      put(dataset, DCM_PatientID, internal::numbered("P", number));
      put(dataset, DCM_PatientName, internal::numbered("Generated^N", number));
      put(dataset, DCM_StudyDescription, internal::numbered("Study of N", number));
      put(dataset, DCM_Modality, modality);
      if (std::string(modality) == "MR") put(dataset, DCM_SOPClassUID, UID_MRImageStorage);
    };
  });
}

}  // namespace

const fs::path& made_series() {
  static const FreshFolder folder = temporary_folder();
  static const bool written = [] {
    internal::register_encoders();
    write(folder.path() / ct, 1, "CT", 4);
    write(folder.path() / compressed, 2, "MR", 4, 16, EXS_JPEGProcess14SV1);
    write(folder.path() / brain, 3, "MR", 20, 192);  // 1.4 MiB
    write(folder.path() / another_mr, 4, "MR", 35);
    write(folder.path() / another_ct, 5, "CT", 4);
    return true;
  }();
  static_cast<void>(written);
  return folder.path();
}

}  // namespace palpate::io::testing

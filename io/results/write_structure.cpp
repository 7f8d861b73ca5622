#include <filesystem>

#include "io/errors.h"
#include "io/messages.h"
#include "io/structures/label_image.h"
#include "io/structures/write_checks.h"

namespace palpate::io {

void write_structure(const StructureLabel& label, const Series& scan, const Geometry& geometry,
                     const SignedDistance& distance, const std::optional<StructureBox>& within, StructureForm form,
                     const std::filesystem::path& file, const WriteOptions& options, const Progress& progress) {
  check_target(label, file, options);  // before the work
  for (const std::filesystem::path& image : scan.files) {
    std::error_code not_there;
    if (std::filesystem::equivalent(image, file, not_there))
      throw DicomError(say("file-is-of-the-scan", file.string()));
  }
  if (form == StructureForm::contours) {
    write_contours(trace_slices(label, geometry, distance, within, progress), scan, file, options);
    return;
  }
  const LabelImage image = sample_labels(label, geometry, distance, within, progress);
  if (form == StructureForm::segmentation) {
    write_segmentation(image, scan, file, options);
  } else {
    write_label_map(image, file, options);
  }
}

}  // namespace palpate::io

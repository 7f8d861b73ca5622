#include "io/dicom/copies.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <map>
#include <span>
#include <string>

#include "io/dicom/input_file.h"
#include "io/errors.h"
#include "io/messages.h"

namespace palpate::io::internal {
namespace {

bool same_place_and_time(const FileHeader& a, const FileHeader& b) {
  constexpr double rounding = 1e-3;  // mm
  const auto same_place = [](const Plane& x, const Plane& y) {
    if (x.placement.has_value() != y.placement.has_value()) return false;
    return !x.placement || glm::distance(x.placement->position, y.placement->position) < rounding;
  };
  return a.acquisition_time == b.acquisition_time && a.content_time == b.content_time &&
         std::equal(a.planes.begin(), a.planes.end(), b.planes.begin(), b.planes.end(), same_place);
}

// Where the coded pixels are in their file.
std::vector<Fragment> coded_pixels(const FileHeader& file) {
  std::vector<Fragment> stretches;
  if (file.coding == PixelCoding::native) {
    const std::size_t frame = file.format.bytes_per_frame();
    for (const Plane& plane : file.planes) {
      stretches.push_back({file.pixels_at + plane.frame * frame, static_cast<std::uint32_t>(frame)});
    }
  }
  for (const auto& frame : file.fragments) stretches.insert(stretches.end(), frame.begin(), frame.end());
  return stretches;
}

// Compares coded pixels. Images in different encodings are not compared, nor unreadable ones: the length of images that
// are unfit for a volume was not checked.
bool pixels_differ(const FileHeader& a, const FileHeader& b) try {
  if (a.transfer_syntax != b.transfer_syntax) return false;
  const InputFile file_a(a.stored_at);
  const InputFile file_b(b.stored_at);
  const auto coded_a = coded_pixels(a);
  const auto coded_b = coded_pixels(b);
  const auto differ = [&](const Fragment& x, const Fragment& y) {
    return x.length != y.length || read_fragments(file_a, {x}) != read_fragments(file_b, {y});
  };
  return !std::equal(coded_a.begin(), coded_a.end(), coded_b.begin(), coded_b.end(),
                     [&](const Fragment& x, const Fragment& y) { return !differ(x, y); });
} catch (const DicomError&) {
  return false;
}

// Archives may renumber images. Images of one position and time that differ in number and pixels are two images.
bool same_image(const FileHeader& a, const FileHeader& b) {
  return same_place_and_time(a, b) &&
         (a.instance_number == b.instance_number || !a.defect.empty() || !b.defect.empty() || !pixels_differ(a, b));
}

}  // namespace

std::vector<FileHeader> drop_copies(std::vector<FileHeader> files, std::vector<SkippedFile>& skipped) {
  std::stable_sort(files.begin(), files.end(), [](const FileHeader& a, const FileHeader& b) {
    return a.defect.empty() == b.defect.empty() ? a.path < b.path : a.defect.empty();
  });
  std::map<std::string, std::vector<std::size_t>> kept_of;  // SOP instance -> those of it that are kept
  std::vector<FileHeader> kept;
  for (FileHeader& file : files) {
    auto& known = kept_of[file.sop_instance];
    const auto first =
        std::find_if(known.begin(), known.end(), [&](std::size_t n) { return same_image(kept[n], file); });
    if (file.sop_instance.empty() || first == known.end()) {
      if (!file.sop_instance.empty() && known.size() == 1) {
        kept[known[0]].remarks.push_back(say("one-uid-for-several-images"));
      }
      known.push_back(kept.size());
      kept.push_back(std::move(file));
      continue;
    }
    FileHeader& original = kept[*first];
    Text why = say("copy-of-an-image", name_of(original));
    if (!file.defect.empty()) {
      why = say("damaged-copy", name_of(original), file.defect);
    } else if (pixels_differ(original, file)) {
      why = say("copy-with-other-pixels", name_of(original));
      original.remarks.push_back(say("used-and-not-its-copy", name_of(original), name_of(file)));
    }
    skipped.push_back({file.path, std::move(why)});
  }
  return kept;
}

}  // namespace palpate::io::internal

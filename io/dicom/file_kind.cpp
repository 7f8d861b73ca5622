#include "io/dicom/file_kind.h"

#include <array>
#include <string_view>

namespace palpate::io::internal {
namespace {

struct Kind {
  std::string_view begins;  ///< a UID, or its beginning up to a dot
  const char* name;
};

// PS3.6 annex A; the more special ones first.
constexpr std::array classes{Kind{"1.2.840.10008.1.3.10", "index"},
                             Kind{"1.2.840.10008.5.1.4.1.1.88.59", "key object note"},
                             Kind{"1.2.840.10008.5.1.4.1.1.88.67", "dose report"},
                             Kind{"1.2.840.10008.5.1.4.1.1.88.68", "dose report"},
                             Kind{"1.2.840.10008.5.1.4.1.1.88.73", "dose report"},
                             Kind{"1.2.840.10008.5.1.4.1.1.88", "structured report"},
                             Kind{"1.2.840.10008.5.1.4.1.1.66.4", "segmentation"},
                             Kind{"1.2.840.10008.5.1.4.1.1.66.5", "segmentation"},
                             Kind{"1.2.840.10008.5.1.4.1.1.66.1", "registration"},
                             Kind{"1.2.840.10008.5.1.4.1.1.66.3", "registration"},
                             Kind{"1.2.840.10008.5.1.4.1.1.66", "raw data file"},
                             Kind{"1.2.840.10008.5.1.4.1.1.481.2", "dose distribution"},
                             Kind{"1.2.840.10008.5.1.4.1.1.481.3", "structure set"},
                             Kind{"1.2.840.10008.5.1.4.1.1.481", "treatment plan"},
                             Kind{"1.2.840.10008.5.1.4.1.1.11", "presentation state"},
                             Kind{"1.2.840.10008.5.1.4.1.1.104", "document"},
                             Kind{"1.2.840.10008.5.1.4.1.1.30", "parametric map"},
                             Kind{"1.2.840.10008.5.1.4.1.1.9", "waveform"},
                             Kind{"1.2.840.10008.5.1.4.1.1.7", "screen capture"}};

bool is_of(std::string_view uid, std::string_view begins) {
  return uid.starts_with(begins) && (uid.size() == begins.size() || uid[begins.size()] == '.');
}

}  // namespace

std::string kind_of_file(const std::string& sop_class, const std::string& image_type, const std::string& reason) {
  if (reason.starts_with("a copy of")) return "copy";
  if (reason.starts_with("DICOMDIR")) return "index";
  if (reason.starts_with("a folder")) return "locked folder";
  if (reason.starts_with("a label map")) return "label map";
  if (reason.starts_with("an archive")) return "packed file";
  for (const char* word : {"truncated", "damaged", "empty file"}) {
    if (reason.starts_with(word)) return "damaged file";
  }
  for (const Kind& kind : classes) {
    if (is_of(sop_class, kind.begins)) return kind.name;
  }
  if (image_type.find("LOCALIZER") != std::string::npos) return "scout";
  return sop_class.empty() && image_type.empty() ? "other file" : "image that is no part of a volume";
}

}  // namespace palpate::io::internal

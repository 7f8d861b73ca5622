#include "io/structures/registration.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcdatset.h>
#include <dcmtk/dcmdata/dcdeftag.h>
#include <dcmtk/dcmdata/dcsequen.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "io/dicom/character_set.h"
#include "io/dicom/dicom_value.h"
#include "io/messages.h"
#include "io/reach.h"

namespace palpate::io {
namespace {

using internal::numbers_of;
using internal::text_of;

constexpr const char* spatial_registration_storage = "1.2.840.10008.5.1.4.1.1.66.1";
constexpr const char* deformable_registration_storage = "1.2.840.10008.5.1.4.1.1.66.3";

template <typename Work>
void for_items(DcmItem& item, const DcmTagKey& sequence, const Work& work) {
  DcmSequenceOfItems* items = nullptr;
  if (item.findAndGetSequence(sequence, items).bad()) return;
  DcmObject* object = nullptr;
  while ((object = items->nextInContainer(object)) != nullptr) {
    if (auto* one = dynamic_cast<DcmItem*>(object)) work(*one);
  }
}

/// Sixteen numbers, row by row, the last four of which are 0, 0, 0, 1 (PS3.3 C.20.2.1.1). Nothing if the matrix scales,
/// shears or mirrors, whatever the file calls it. Matrices are written with about six digits.
std::optional<RigidMotion> rigid(const std::vector<double>& rows) {
  constexpr double tolerance = 1e-4;
  glm::dmat3 turn;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) turn[column][row] = rows.data()[4 * row + column];
  }
  const glm::dmat3 square = glm::transpose(turn) * turn;
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) {
      if (!(std::abs(square[a][b] - (a == b ? 1 : 0)) < tolerance)) return std::nullopt;
    }
  }
  if (!(glm::determinant(turn) > 0)) return std::nullopt;
  for (std::size_t n = 12; n < 16; ++n) {
    if (!(std::abs(rows[n] - (n == 15 ? 1 : 0)) < tolerance)) return std::nullopt;
  }
  // Removes the error of the rounded digits.
  turn[0] = glm::normalize(turn[0]);
  turn[1] = glm::normalize(turn[1] - glm::dot(turn[0], turn[1]) * turn[0]);
  turn[2] = glm::cross(turn[0], turn[1]);
  return RigidMotion{turn, {rows[3], rows[7], rows[11]}};
}

/// The matrices of an item, one after the other.
Registration::Part part_in(DcmItem& item, const std::string& file) {
  Registration::Part part{.frame_of_reference_uid = text_of(item, DCM_FrameOfReferenceUID)};
  bool any = false;
  for_items(item, DCM_MatrixRegistrationSequence, [&](DcmItem& registration) {
    for_items(registration, DCM_MatrixSequence, [&](DcmItem& matrix) {
      any = true;
      const std::vector<double> rows = numbers_of(matrix, DCM_FrameOfReferenceTransformationMatrix);
      if (rows.size() != 16) {
        part.unfit = say("registration-without-a-matrix", file);
        return;
      }
      if (const auto motion = rigid(rows)) {
        part.motion = after(part.motion, *motion);
        const bool is_near = glm::length(part.motion.shift) <= internal::farthest_place_mm;  // nor is what is no number
        if (!is_near && part.unfit.empty()) part.unfit = say("registration-moves-too-far", file);
      } else if (part.unfit.empty()) {
        part.unfit = say("registration-is-not-rigid", file);
      }
    });
  });
  if (!any) part.unfit = say("registration-without-a-matrix", file);
  return part;
}

/// The motion from a frame to a registration's target frame; for the target itself the identity.
std::optional<Registration::Part> part_of(const Registration& registration, const std::string& frame) {
  const auto found = std::ranges::find(registration.parts, frame, &Registration::Part::frame_of_reference_uid);
  if (found != registration.parts.end()) return *found;
  if (registration.frame_of_reference_uid == frame) return Registration::Part{.frame_of_reference_uid = frame};
  return std::nullopt;
}

/// Whether they move nothing within a meter around the patient apart by more than a tenth of a millimeter.
bool agree(const RigidMotion& a, const RigidMotion& b) {
  constexpr double far_mm = 1000, same_mm = 0.1;
  for (const Vec3& at : {Vec3(0), Vec3(far_mm, 0, 0), Vec3(0, far_mm, 0), Vec3(0, 0, far_mm)}) {
    if (glm::distance(a(at), b(at)) > same_mm) return false;
  }
  return true;
}

}  // namespace

std::optional<Registration> registration_in(DcmDataset& dataset, const std::filesystem::path& path) {
  const std::string sop_class = text_of(dataset, DCM_SOPClassUID);
  const bool deforms = sop_class == deformable_registration_storage;
  if (!deforms && sop_class != spatial_registration_storage) return std::nullopt;
  const std::string name = path.filename().string();
  Registration registration;
  registration.file = path;
  registration.frame_of_reference_uid = text_of(dataset, DCM_FrameOfReferenceUID);
  registration.patient_id =
      internal::utf8_of(text_of(dataset, DCM_PatientID), text_of(dataset, DCM_SpecificCharacterSet));
  if (deforms) {
    for_items(dataset, DCM_DeformableRegistrationSequence, [&](DcmItem& item) {
      registration.parts.push_back({.frame_of_reference_uid = text_of(item, DCM_SourceFrameOfReferenceUID),
                                    .unfit = say("registration-deforms", name)});
    });
  } else {
    for_items(dataset, DCM_RegistrationSequence,
              [&](DcmItem& item) { registration.parts.push_back(part_in(item, name)); });
  }
  std::erase_if(registration.parts, [](const auto& part) { return part.frame_of_reference_uid.empty(); });
  return registration;
}

Joined join(std::span<const Registration> registrations, const std::string& from, const std::string& to,
            const std::string& patient_id) {
  Joined joined;
  for (const Registration& one : registrations) {
    if (!one.patient_id.empty() && !patient_id.empty() && one.patient_id != patient_id) continue;
    const auto first = part_of(one, from), second = part_of(one, to);
    if (!first || !second) continue;
    if (!first->unfit.empty() || !second->unfit.empty()) {
      joined.why_not = first->unfit.empty() ? second->unfit : first->unfit;
      continue;
    }
    const RigidMotion motion = after(first->motion, back(second->motion));
    if (joined.motion && !agree(*joined.motion, motion)) {
      const Text differ = say("registrations-differ", joined.file.filename().string(), one.file.filename().string());
      return {.motion = std::nullopt, .file = {}, .why_not = differ};
    }
    if (!joined.motion) {
      joined.motion = motion;
      joined.file = one.file;
    }
  }
  if (joined.motion) joined.why_not.clear();
  return joined;
}

}  // namespace palpate::io

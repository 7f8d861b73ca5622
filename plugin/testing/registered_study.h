#pragma once

/// A study whose structures were outlined in another frame of reference than its scan's.

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "io/testing/file_bytes.h"
#include "io/testing/test_image.h"
#include "io/volume.h"
#include "modes/scene/scene.h"

namespace palpate::plugin::testing {

/// A registration's matrix, row by row: 100 mm along x.
inline constexpr const char* along_x = "1\\0\\0\\100\\0\\1\\0\\0\\0\\0\\1\\0\\0\\0\\0\\1";

inline DcmItem& new_item(DcmItem& item, const DcmTagKey& sequence) {
  DcmItem* added = nullptr;
  io::internal::succeed(item.findOrCreateSequenceItem(sequence, added, -2));
  return *added;
}

/// Squares from -10 to 10 mm along x and y, from 0 to 18 mm along z, in a frame of reference and of a patient.
inline void write_contours(const std::filesystem::path& file, const std::string& frame, const std::string& id,
                           const std::string& name) {
  std::filesystem::create_directories(file.parent_path());
  io::internal::TestImage image;
  image.edit = [&](DcmDataset& dataset) {
    dataset.findAndDeleteElement(DCM_PixelData);
    io::internal::put(dataset, DCM_SOPClassUID, "1.2.840.10008.5.1.4.1.1.481.3");
    io::internal::put(dataset, DCM_PatientID, id);
    io::internal::put(dataset, DCM_PatientName, name);
    DcmItem& roi = new_item(dataset, DCM_StructureSetROISequence);
    io::internal::succeed(roi.putAndInsertString(DCM_ROINumber, "1"));
    io::internal::succeed(roi.putAndInsertString(DCM_ROIName, "Cube"));
    io::internal::succeed(roi.putAndInsertString(DCM_ReferencedFrameOfReferenceUID, frame.c_str()));
    DcmItem& drawn = new_item(dataset, DCM_ROIContourSequence);
    io::internal::succeed(drawn.putAndInsertString(DCM_ReferencedROINumber, "1"));
    for (const std::string z : {"0", "3", "6", "9", "12", "15", "18"}) {
      DcmItem& item = new_item(drawn, DCM_ContourSequence);
      io::internal::succeed(item.putAndInsertString(DCM_ContourGeometricType, "CLOSED_PLANAR"));
      const std::string points = "-10\\-10\\" + z + "\\10\\-10\\" + z + "\\10\\10\\" + z + "\\-10\\10\\" + z;
      io::internal::succeed(item.putAndInsertString(DCM_ContourData, points.c_str()));
    }
  };
  io::internal::write(image, file);
}

/// As another program rewrites such a file: the squares' corner at -10, -10 mm now lies at -16, -16 mm.
inline void move_corner(const std::filesystem::path& file) {
  std::string bytes = io::internal::bytes_of(file);
  const std::string corner = "-10\\-10\\";
  for (std::size_t at = 0; (at = bytes.find(corner, at)) != std::string::npos;)
    bytes.replace(at, corner.size(), "-16\\-16\\");
  const auto time = std::filesystem::last_write_time(file);
  std::ofstream(file, std::ios::binary) << bytes;
  std::filesystem::last_write_time(file, time + std::chrono::seconds(1));
}

/// From frame 1.2 to frame 1.1.
inline void write_registration(const std::filesystem::path& file, const std::string& rows = along_x) {
  std::filesystem::create_directories(file.parent_path());
  io::internal::TestImage image;
  image.edit = [&](DcmDataset& dataset) {
    dataset.findAndDeleteElement(DCM_PixelData);
    io::internal::put(dataset, DCM_SOPClassUID, "1.2.840.10008.5.1.4.1.1.66.1");
    io::internal::put(dataset, DCM_FrameOfReferenceUID, "1.1");
    DcmItem& item = new_item(dataset, DCM_RegistrationSequence);
    io::internal::succeed(item.putAndInsertString(DCM_FrameOfReferenceUID, "1.2"));
    DcmItem& matrix = new_item(new_item(item, DCM_MatrixRegistrationSequence), DCM_MatrixSequence);
    io::internal::succeed(matrix.putAndInsertString(DCM_FrameOfReferenceTransformationMatrix, rows.c_str()));
  };
  io::internal::write(image, file);
}

/// 40 x 40 x 20 voxels of 2 mm around the place to which the registration moves the structure.
inline std::shared_ptr<const io::Volume> registered_scan() {
  auto volume = std::make_shared<io::Volume>();
  volume->frame_of_reference_uid = "1.1";
  volume->patient_id = "7";
  volume->patient_name = "Doe^Jane";
  volume->modality = "CT";
  volume->geometry.dimensions = {40, 40, 20};
  volume->geometry.spacing_i = volume->geometry.spacing_j = 2;
  volume->geometry.step = {0, 0, 2};
  for (int k = 0; k < 20; ++k) volume->geometry.slice_positions.emplace_back(60, -40, -10 + 2 * k);
  volume->voxels = std::vector<std::int16_t>(volume->offset(0, 0, 20));
  return volume;
}

inline modes::Scene scene_of(const std::filesystem::path& file) {
  modes::Scene scene;
  scene.structures.push_back({.name = "cube", .file = file.string(), .segment = "Cube"});
  modes::Mode mode;
  mode.type = "surface";
  mode.structure = "cube";
  mode.strength_n = modes::TransferFunction(1.0);
  scene.modes.push_back(mode);
  return scene;
}

}  // namespace palpate::plugin::testing

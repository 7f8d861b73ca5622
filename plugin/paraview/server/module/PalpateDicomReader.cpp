#include "plugin/paraview/server/module/PalpateDicomReader.h"
#include "plugin/messages/messages.h"

#include <vtkDataObject.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkIntArray.h>
#include <vtkMultiProcessController.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkStringArray.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "io/errors.h"
#include "io/filter.h"
#include "io/whole_scan.h"
#include "modes/scene/scene_json.h"
#include "modes/scene/starting_scene.h"
#include "plugin/app/scan_choice.h"
#include "plugin/paraview/common/body_mask.h"
#include "plugin/paraview/common/display_image.h"
#include "plugin/paraview/common/scan_store.h"
#include "plugin/paraview/common/slice_order.h"
#include "plugin/paraview/server/module/quick_slices.h"
#include "plugin/paraview/server/module/value_shares.h"

using namespace palpate;

struct PalpateDicomReader::Scan {
  std::shared_ptr<const io::Catalogue> catalogue;
  std::size_t chosen = 0;
  bool loaded_elsewhere = false;  // before this reader was asked
  plugin::DisplayGrid grid;
  int frame = 0;                                  // shown last
  std::shared_ptr<const io::Volume> volume;       // of that frame, or of the slices that this rank shows
  std::optional<std::array<int, 6>> part_extent;  // of the volume on the grid
  vtkSmartPointer<vtkDoubleArray> shares;
  std::optional<double> light_part;
  std::shared_ptr<const io::Volume> probed;  // the slice that was probed last, where the volume does not have it
  int probed_slice = -1;

  const io::Series& series() const { return plugin::scan_at(*catalogue, chosen); }
  plugin::Part load(int wanted_frame, const io::Filter& filter, const std::array<int, 6>& extent,
                    const io::Progress& progress) const;
};

// One process has the whole scan, whatever part of it is asked for, and so shares it with the stylus. A rank of several
// holds its own part and its neighbors' voxels around it, no more: all ranks together hold the scan once.
plugin::Part PalpateDicomReader::Scan::load(int wanted_frame, const io::Filter& filter,
                                            const std::array<int, 6>& extent, const io::Progress& progress) const {
  vtkMultiProcessController* const ranks = vtkMultiProcessController::GetGlobalController();
  const auto& size = grid.dimensions;
  const bool all = extent == std::array<int, 6>{0, size[0] - 1, 0, size[1] - 1, 0, size[2] - 1};
  const bool in_parts = ranks && ranks->GetNumberOfProcesses() > 1 && !grid.resampled && !all &&
                        series().frames_per_position == 1 && !plugin::is_velocity(*catalogue, chosen) &&
                        extent[4] <= extent[5];
  if (!in_parts) return plugin::whole_part(plugin::load_scan(series(), wanted_frame, filter, progress), grid);
  if (filter.type != nullptr) {
    throw InvalidInput(plugin::say("several-ranks-do-not-filter"));
  }
  if (const auto whole = plugin::held_scan(series(), wanted_frame)) return plugin::whole_part(whole, grid);
  if (volume && part_extent && plugin::contains(*part_extent, extent)) return {volume, *part_extent, true};
  std::array<int, 6> read = extent;
  if (extent[1] - extent[0] + 1 == size[0] && extent[3] - extent[2] + 1 == size[1]) {
    // With the slices next to it: a surface asks for them after the picture has not, and would have all read again.
    read[4] = std::max(extent[4] - 1, 0);
    read[5] = std::min(extent[5] + 1, size[2] - 1);
  }
  const auto part = plugin::load_part(series(), read, progress);
  return {part, read, part->geometry.dimensions.z == read[5] - read[4] + 1};
}

vtkStandardNewMacro(PalpateDicomReader);

PalpateDicomReader::PalpateDicomReader()
    : series_uids_(vtkSmartPointer<vtkStringArray>::New()),
      series_labels_(vtkSmartPointer<vtkStringArray>::New()),
      series_usable_(vtkSmartPointer<vtkIntArray>::New()),
      messages_(vtkSmartPointer<vtkStringArray>::New()) {
  SetNumberOfInputPorts(0);
  plugin::quicken_slices();
}

PalpateDicomReader::~PalpateDicomReader() = default;

void PalpateDicomReader::PrintSelf(ostream& os, vtkIndent indent) {
  Superclass::PrintSelf(os, indent);
  os << indent << "SeriesUid: " << series_uid_ << "\n";  // not the folder: its name may be the patient's
}

void PalpateDicomReader::SetFileName(const char* name) {
  if (file_name_ == (name ? name : "")) return;
  file_name_ = name ? name : "";
  scan_.reset();
  Modified();
}

void PalpateDicomReader::SetSeriesUid(const char* uid) {
  if (series_uid_ == (uid ? uid : "")) return;
  series_uid_ = uid ? uid : "";
  // ParaView replaces an empty choice by the first of the list: by the series that is already shown.
  if (scan_ && plugin::scan_name(*scan_->catalogue, scan_->chosen) == series_uid_) return;
  scan_.reset();
  Modified();
}

void PalpateDicomReader::SetFilter(const char* json) {
  if (filter_ == (json ? json : "")) return;
  filter_ = json ? json : "";
  if (scan_) scan_->volume.reset();
  Modified();
}

vtkStringArray* PalpateDicomReader::GetSeriesUids() {
  return series_uids_;
}
vtkStringArray* PalpateDicomReader::GetSeriesLabels() {
  return series_labels_;
}
vtkIntArray* PalpateDicomReader::GetSeriesUsable() {
  return series_usable_;
}
vtkStringArray* PalpateDicomReader::GetMessages() {
  return messages_;
}
bool PalpateDicomReader::GetDisplayResampled() {
  return scan_ && scan_->grid.resampled;
}

double* PalpateDicomReader::GetLattice() {
  lattice_.fill(0);
  if (scan_) {
    const plugin::DisplayGrid& grid = scan_->grid;
    const std::array<glm::dvec3, 6> rows{glm::dvec3(grid.dimensions[0], grid.dimensions[1], grid.dimensions[2]),
                                         {grid.spacing_mm[0], grid.spacing_mm[1], grid.spacing_mm[2]},
                                         grid.origin_mm,
                                         grid.direction_i,
                                         grid.direction_j,
                                         grid.direction_k};
    for (std::size_t n = 0; n < lattice_.size(); ++n) lattice_[n] = rows[n / 3][static_cast<int>(n % 3)];
  }
  return lattice_.data();
}

bool PalpateDicomReader::GetCountedFromLast() {
  return scan_ && plugin::counted_from_last(scan_->series());
}

const char* PalpateDicomReader::GetModality() {
  return scan_ ? scan_->series().modality.c_str() : "";
}

double* PalpateDicomReader::GetWindow() {
  const auto window = scan_ ? scan_->series().window : std::nullopt;
  window_ = window ? std::array{window->level, window->width} : std::array{0.0, 0.0};
  return window_.data();
}

vtkDoubleArray* PalpateDicomReader::GetValueShares() {
  if (!scan_) return nullptr;
  if (scan_->shares) return scan_->shares;
  try {
    const auto found = plugin::value_shares(scan_->series());
    const auto shares = vtkSmartPointer<vtkDoubleArray>::New();
    for (const double value : found) shares->InsertNextValue(value);
    scan_->shares = shares;
  } catch (const std::exception& error) {
    vtkErrorMacro(<< error.what());
  }
  return scan_->shares;
}

double PalpateDicomReader::GetLightPart() {
  if (scan_ && scan_->light_part) return *scan_->light_part;
  const auto volume = scan_ ? plugin::held_scan(scan_->series(), 0) : nullptr;
  if (!volume || volume->unit != "HU") return std::numeric_limits<double>::quiet_NaN();
  const auto value_at = [&](int i, int j, int k) { return volume->value_at(i, j, k); };
  const io::Geometry& geometry = volume->geometry;
  constexpr double coarse_mm = 3;
  const plugin::BodyMask body = plugin::body_mask(value_at, geometry.dimensions,
                                                  {geometry.spacing_i, geometry.spacing_j, geometry.slice_spacing()},
                                                  plugin::Rim::none, coarse_mm);
  scan_->light_part = plugin::light_part(body, value_at);
  return *scan_->light_part;
}

double PalpateDicomReader::ValueAt(double x, double y, double z) {
  if (!scan_) return std::numeric_limits<double>::quiet_NaN();
  const glm::dvec3 place(x, y, z);
  if (const auto value = scan_->volume ? plugin::nearest_value(*scan_->volume, place) : std::nullopt) return *value;
  try {
    const io::Series& series = scan_->series();
    const auto at = plugin::nearest_voxel(series.geometry, place);
    if (!at || series.frames_per_position > 1) return std::numeric_limits<double>::quiet_NaN();
    if (at->z != scan_->probed_slice) scan_->probed = plugin::load_slice(series, at->z);
    scan_->probed_slice = at->z;
    const bool padded = scan_->probed->is_padding(at->x, at->y, 0);
    return padded ? std::numeric_limits<double>::quiet_NaN() : scan_->probed->value_at(at->x, at->y, 0);
  } catch (const std::exception&) {  // a slice that cannot be read has been told of when it was loaded
    return std::numeric_limits<double>::quiet_NaN();
  }
}

const io::Series* PalpateDicomReader::FoundSeries() const {
  return scan_ ? &scan_->series() : nullptr;
}

int PalpateDicomReader::GetStoredScans() {
  return static_cast<int>(plugin::store_use().volumes);
}
vtkIdType PalpateDicomReader::GetStoredBytes() {
  return static_cast<vtkIdType>(plugin::store_use().voxel_bytes);
}
int PalpateDicomReader::GetSharedArrays() {
  return static_cast<int>(plugin::store_use().shared_arrays);
}

int PalpateDicomReader::CanReadFile(const char* name) {
  if (std::filesystem::is_directory(name) || io::holds_whole_scans(name)) return 1;
  std::ifstream file(name, std::ios::binary);
  std::array<char, 132> head{};  // a preamble of 128 bytes, then "DICM"
  return file.read(head.data(), head.size()) && std::string_view(head.data() + 128, 4) == "DICM" ? 1 : 0;
}

void PalpateDicomReader::tell(const std::string& message) {
  messages_->InsertNextValue(message);
  // A scan loaded by the panel was reported there, and ParaView's window of messages would cover the slices.
  if (!show_messages_ || (scan_ && scan_->loaded_elsewhere)) return;
  // Not vtkWarningMacro: it wraps a sentence for a radiologist in source lines and addresses.
  vtkOutputWindow::GetInstance()->DisplayWarningText(("Palpate: " + message + "\n").c_str());
}

void PalpateDicomReader::find() {
  if (scan_) return;
  auto found = std::make_unique<Scan>();
  found->catalogue = plugin::find_scans(file_name_, [this](double done) {
    UpdateProgress(done);
    return GetAbortExecute() == 0;
  });
  series_uids_->Reset();
  series_labels_->Reset();
  series_usable_->Reset();
  messages_->Reset();
  for (const std::size_t n : plugin::choices(*found->catalogue, file_name_)) {
    series_uids_->InsertNextValue(plugin::scan_name(*found->catalogue, n));
    series_labels_->InsertNextValue(plugin::scan_label(plugin::scan_at(*found->catalogue, n)));
    series_usable_->InsertNextValue(plugin::scan_at(*found->catalogue, n).usable ? 1 : 0);
  }
  found->chosen = plugin::choose_scan(*found->catalogue, series_uid_, file_name_);
  const io::Series& series = found->series();
  if (series.geometry.slice_positions.empty()) {
    throw io::DicomError(palpate::at_place(plugin::scan_label(series), series.warnings.empty()
                                                                           ? plugin::say("it-has-no-readable-images")
                                                                           : series.warnings.front()));
  }
  found->grid = plugin::display_grid(series.geometry);
  found->loaded_elsewhere = plugin::held_scan(series, 0) != nullptr;
  scan_ = std::move(found);
  for (const std::string& warning : series.warnings) tell(warning);
  if (scan_->grid.resampled) tell(plugin::say("slices-are-unevenly-spaced"));
  if (!plugin::is_straight(scan_->grid)) {
    tell(plugin::say("this-scan-is-oblique-or-tilted"));
  }
}

int PalpateDicomReader::RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector* output) {
  if (file_name_.empty()) return 1;  // nothing is asked for: nothing to show, and nothing wrong
  try {
    find();
  } catch (const std::exception& error) {
    vtkErrorMacro(<< error.what());
    return 0;
  }
  vtkInformation& info = *output->GetInformationObject(0);
  const plugin::DisplayGrid& grid = scan_->grid;
  const auto& size = grid.dimensions;
  info.Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), 0, size[0] - 1, 0, size[1] - 1, 0, size[2] - 1);
  info.Set(vtkDataObject::SPACING(), grid.spacing_mm.data(), 3);
  info.Set(vtkDataObject::ORIGIN(), grid.origin_mm.x, grid.origin_mm.y, grid.origin_mm.z);
  info.Set(vtkDataObject::DIRECTION(), plugin::direction_matrix(grid).data(), 9);
  info.Set(CAN_PRODUCE_SUB_EXTENT(), 1);
  const int frames = scan_->series().frames_per_position;
  if (frames > 1) {
    std::vector<double> times(static_cast<std::size_t>(frames));
    std::iota(times.begin(), times.end(), 0);
    info.Set(vtkStreamingDemandDrivenPipeline::TIME_STEPS(), times.data(), frames);
    const std::array<double, 2> range{times.front(), times.back()};
    info.Set(vtkStreamingDemandDrivenPipeline::TIME_RANGE(), range.data(), 2);
  } else {
    info.Remove(vtkStreamingDemandDrivenPipeline::TIME_STEPS());
    info.Remove(vtkStreamingDemandDrivenPipeline::TIME_RANGE());
  }
  return 1;
}

namespace {

void add_note(vtkImageData& image, const char* name, const std::string& text) {
  const auto note = vtkSmartPointer<vtkStringArray>::New();
  note->SetName(name);
  note->InsertNextValue(text);
  image.GetFieldData()->AddArray(note);
}

}  // namespace

int PalpateDicomReader::RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* output) {
  vtkInformation& info = *output->GetInformationObject(0);
  vtkImageData& image = *vtkImageData::GetData(output);
  if (file_name_.empty()) return 1;
  try {
    find();
    const io::Series& series = scan_->series();
    int frame = 0;
    if (info.Has(vtkStreamingDemandDrivenPipeline::UPDATE_TIME_STEP())) {
      frame =
          plugin::frame_at(series.frames_per_position, info.Get(vtkStreamingDemandDrivenPipeline::UPDATE_TIME_STEP()));
    }
    std::array<int, 6> extent{};
    info.Get(vtkStreamingDemandDrivenPipeline::UPDATE_EXTENT(), extent.data());
    const plugin::Part part = scan_->load(frame, modes::filter_from_json(filter_), extent, [this](double done) {
      UpdateProgress(done);
      return GetAbortExecute() == 0;
    });
    if (part.volume != scan_->volume) {
      for (const std::string& warning : part.volume->warnings) tell(warning);
    }
    scan_->volume = part.volume;
    scan_->part_extent = part.on_grid ? std::optional(part.extent) : std::nullopt;
    scan_->frame = frame;
    plugin::show_volume(part, scan_->grid, extent, series.unit.empty() ? "Value" : series.unit, image);
    image.GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), frame);
    add_note(image, "Modality", series.modality);
    add_note(image, "BodyPart", modes::part_of_body(*part.volume));
    if (static_cast<std::size_t>(frame) < series.frame_names.size()) {
      add_note(image, "Frame", series.frame_names[static_cast<std::size_t>(frame)]);
    }
  } catch (const std::exception& error) {
    vtkErrorMacro(<< error.what());
    return 0;
  }
  return 1;
}

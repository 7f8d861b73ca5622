#pragma once

/// A DICOM CT or MR series as vtkImageData in patient space (LPS, mm), values in the scan's unit (HU for CT).
///
/// The image views the voxels that the process holds (scan_store.h), without another copy. Several images at a position
/// (time, b-value, echo) are time steps 0, 1, ... Oblique scans and gantry tilt are in the DirectionMatrix; unevenly
/// spaced slices are resampled for display. A rank of a parallel server reads only the slices of its part. If slices
/// are uneven, or several images lie at a position, it reads all of them.

#include <vtkImageAlgorithm.h>
#include <vtkSmartPointer.h>

#include <array>
#include <memory>
#include <string>

#include "PalpateServerModule.h"

class vtkDoubleArray;
class vtkIntArray;
class vtkStringArray;

#ifndef __VTK_WRAP__  // whose parser is older
namespace palpate::io {
struct Series;
}  // namespace palpate::io
#endif

class PALPATESERVER_EXPORT PalpateDicomReader : public vtkImageAlgorithm {
 public:
  static PalpateDicomReader* New();
  vtkTypeMacro(PalpateDicomReader, vtkImageAlgorithm)  // ends in a function body: no semicolon
      void PrintSelf(ostream& os, vtkIndent indent) override;

  /// A folder, which is searched with its subfolders, or a file of the wanted series.
  void SetFileName(const char* name);
  const char* GetFileName() { return file_name_.c_str(); }
  /// The series, as in GetSeriesUids(). Empty: the series of the file, or that of io::choose_first().
  void SetSeriesUid(const char* uid);
  const char* GetSeriesUid() { return series_uid_.c_str(); }

  /// A filter of the values, as a scene's key "filter" has it; empty: none.
  void SetFilter(const char* json);
  const char* GetFilter() { return filter_.c_str(); }

  /// Whether ParaView's window of messages shows the notes on the series, too. GetMessages() always has them. Off if a
  /// panel shows them. Changing this reads nothing anew.
  void SetShowMessages(bool shown) { show_messages_ = shown; }
  bool GetShowMessages() const { return show_messages_; }

  /// The series that were found, in the same order. The first is the one that an empty choice means. Filled by
  /// UpdateInformation().
  vtkStringArray* GetSeriesUids();
  vtkStringArray* GetSeriesLabels();
  /// 1 if that series is a volume, 0 if not (a localizer, a single slice).
  vtkIntArray* GetSeriesUsable();
  /// Notes for the user on the series that was read, one sentence each.
  vtkStringArray* GetMessages();
  /// Whether the slices are uneven and an even copy is shown.
  bool GetDisplayResampled();

  /// Dimensions, spacing, origin, and directions of i, j and k of the image, three numbers each. Without this a client
  /// of ParaView knows only the bounds. Zeros before UpdateInformation().
  double* GetLattice() VTK_SIZEHINT(18);

  /// Whether the scanner's image numbers descend along the slices.
  bool GetCountedFromLast();

  /// DICOM Modality of the series: "CT", "MR", ... Empty before UpdateInformation().
  const char* GetModality();
  /// Level and width of the window that the series asks for; width 0 if it asks for none.
  double* GetWindow() VTK_SIZEHINT(2);
  /// The values below which 0, 1, ... 100 percent of the voxels lie, estimated from slices spread over the whole scan.
  /// They are the same on every server. Null before UpdateInformation(), or if the slices cannot be read.
  vtkDoubleArray* GetValueShares();
  /// The part of the patient's body that is as light as lungs, 0 to 1. Air around the body and the foam of the table
  /// are not counted. NaN if the unit is not HU, or if the process does not hold the scan.
  double GetLightPart();
  /// The value of the voxel nearest to a place in the patient, mm, in the frame shown last; NaN outside and in gaps. A
  /// rank that does not hold the voxel reads its slice.
  double ValueAt(double x, double y, double z);

#ifndef __VTK_WRAP__
  /// The series that is read, for the process itself; null before UpdateInformation().
  const palpate::io::Series* FoundSeries() const;
#endif

  /// The number of scans in this process, the bytes of their voxels, and the number of VTK arrays that view them.
  int GetStoredScans();
  vtkIdType GetStoredBytes();
  int GetSharedArrays();

  /// Whether this is a folder, or a file that begins as DICOM does.
  static int CanReadFile(const char* name);

  PalpateDicomReader(const PalpateDicomReader&) = delete;
  PalpateDicomReader& operator=(const PalpateDicomReader&) = delete;

 protected:
  PalpateDicomReader();
  ~PalpateDicomReader() override;
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

 private:
  struct Scan;
  void find();
  void tell(const std::string& message);

  std::string file_name_;
  std::string series_uid_;
  std::string filter_;
  bool show_messages_ = true;
  vtkSmartPointer<vtkStringArray> series_uids_;
  vtkSmartPointer<vtkStringArray> series_labels_;
  vtkSmartPointer<vtkIntArray> series_usable_;
  vtkSmartPointer<vtkStringArray> messages_;
  std::array<double, 18> lattice_{};
  std::array<double, 2> window_{};
  std::unique_ptr<Scan> scan_;  ///< what was found; empty until then
};

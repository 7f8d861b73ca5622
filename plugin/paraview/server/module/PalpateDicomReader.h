#pragma once

/// A DICOM CT or MR series as vtkImageData in patient space (LPS, mm), values in the scan's unit (HU for CT).
///
/// The voxels are the process's own copy (scan_store.h) and are shown without another one. Several images at a position
/// (time, b-value, echo) are time steps 0, 1, ... Oblique scans and gantry tilt are in the DirectionMatrix; unevenly
/// spaced slices are resampled for display. A rank of a parallel server reads the slices of its part and no others (of
/// uneven slices and of several images a position, all).

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

  /// A folder, searched to the bottom, or one file: then the series that the file belongs to.
  void SetFileName(const char* name);
  const char* GetFileName() { return file_name_.c_str(); }
  /// Which series, as in GetSeriesUids(); empty: the file's, or the one with most voxels.
  void SetSeriesUid(const char* uid);
  const char* GetSeriesUid() { return series_uid_.c_str(); }

  /// A filter of the values, as a scene's key "filter" has it; empty: none.
  void SetFilter(const char* json);
  const char* GetFilter() { return filter_.c_str(); }

  /// Of the series found, in the same order, the one that an empty choice means first. Filled by UpdateInformation().
  vtkStringArray* GetSeriesUids();
  vtkStringArray* GetSeriesLabels();
  /// 1 where that series is a volume, 0 where not (a localizer, a single slice).
  vtkIntArray* GetSeriesUsable();
  /// What a user should know of the series read, a sentence each.
  vtkStringArray* GetMessages();
  /// Whether the slices are uneven and an even copy is shown.
  bool GetDisplayResampled();

  /// Of the image: dimensions, spacing, origin, directions of i, j and k, three numbers each. ParaView's clients know
  /// only the bounds otherwise. Zeros before UpdateInformation().
  double* GetLattice() VTK_SIZEHINT(18);

  /// Whether the scanner's image numbers descend along the slices.
  bool GetCountedFromLast();

  /// DICOM Modality of the series: "CT", "MR", ... Empty before UpdateInformation().
  const char* GetModality();
  /// Level and width of the window that the series asks for; width 0 where it asks for none.
  double* GetWindow() VTK_SIZEHINT(2);
  /// The values below which 0, 1, ... 100 percent of the voxels are, from slices spread over the whole scan: the same
  /// on every server. Null before UpdateInformation() and where they cannot be read.
  vtkDoubleArray* GetValueShares();
  /// The value of the voxel nearest to a place in the patient, mm, in the frame shown last; NaN outside and in gaps. On
  /// a rank that does not hold it, its slice is read.
  double ValueAt(double x, double y, double z);

#ifndef __VTK_WRAP__
  /// The series that is read, for the process itself; null before UpdateInformation().
  const palpate::io::Series* FoundSeries() const;
#endif

  /// Of all scans in this process: how many, bytes of voxels, VTK arrays that view them.
  int GetStoredScans();
  vtkIdType GetStoredBytes();
  int GetSharedArrays();

  /// Whether a file begins as DICOM does, or is a folder.
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
  vtkSmartPointer<vtkStringArray> series_uids_;
  vtkSmartPointer<vtkStringArray> series_labels_;
  vtkSmartPointer<vtkIntArray> series_usable_;
  vtkSmartPointer<vtkStringArray> messages_;
  std::array<double, 18> lattice_{};
  std::array<double, 2> window_{};
  std::unique_ptr<Scan> scan_;  ///< what was found; empty until then
};

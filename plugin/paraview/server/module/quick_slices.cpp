#include "plugin/paraview/server/module/quick_slices.h"

#include <vtkAlgorithmOutput.h>
#include <vtkCellData.h>
#include <vtkClientServerInterpreter.h>
#include <vtkClientServerInterpreterInitializer.h>
#include <vtkIdList.h>
#include <vtkImageData.h>
#include <vtkImageSliceRepresentation.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMatrix3x3.h>
#include <vtkNew.h>
#include <vtkPVImageSliceMapper.h>
#include <vtkPVLODActor.h>
#include <vtkPVRenderView.h>
#include <vtkPVSession.h>
#include <vtkPVSessionBase.h>
#include <vtkPVView.h>
#include <vtkPVXMLElement.h>
#include <vtkPointData.h>
#include <vtkProcessModule.h>
#include <vtkProperty.h>
#include <vtkSIProxyDefinitionManager.h>
#include <vtkSmartPointer.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkStructuredData.h>
#include <vtkTrivialProducer.h>
#include <vtkWeakPointer.h>

#include <algorithm>
#include <array>

namespace palpate::plugin {
namespace {

/// The values at index `i` along the first axis.
void take_slice(vtkImageData& image, int i, vtkImageData& slice) {
  const int* const extent = image.GetExtent();
  const vtkIdType row = image.GetDimensions()[0];
  vtkNew<vtkIdList> places;
  places->SetNumberOfIds(image.GetNumberOfPoints() / row);
  std::generate_n(places->GetPointer(0), places->GetNumberOfIds(),
                  [row, place = i - extent[0] - row]() mutable { return place += row; });
  slice.Initialize();
  slice.CopyStructure(&image);
  slice.SetExtent(i, i, extent[2], extent[3], extent[4], extent[5]);
  slice.GetFieldData()->PassData(image.GetFieldData());
  slice.GetPointData()->CopyAllOn();
  slice.GetPointData()->CopyAllocate(image.GetPointData(), places->GetNumberOfIds());
  slice.GetPointData()->CopyData(image.GetPointData(), places);
}

/// The same points and values as `slice`, whose first axis is one point long; here that axis is the last, so that rows
/// are longer than one value.
vtkSmartPointer<vtkImageData> with_long_rows(vtkImageData& slice) {
  const int* const extent = slice.GetExtent();
  const double* const spacing = slice.GetSpacing();
  const double* const d = slice.GetDirectionMatrix()->GetData();
  std::array<double, 3> corner;
  slice.TransformIndexToPhysicalPoint(extent[0], 0, 0, corner.data());
  auto turned = vtkSmartPointer<vtkImageData>::New();
  turned->ShallowCopy(&slice);
  turned->SetExtent(extent[2], extent[3], extent[4], extent[5], 0, 0);
  turned->SetOrigin(corner.data());
  turned->SetSpacing(spacing[1], spacing[2], spacing[0]);
  turned->SetDirectionMatrix(d[1], d[2], d[0], d[4], d[5], d[3], d[7], d[8], d[6]);
  return turned;
}

/// To ParaView this is its base class: it has no name of its own.
class QuickSlices : public vtkImageSliceRepresentation {
 public:
  static vtkObjectBase* make(void*) {
    auto* const made = new QuickSlices;
    made->InitializeObjectBase();
    return made;
  }

  int ProcessViewRequest(vtkInformationRequestKey* request, vtkInformation* in, vtkInformation* out) override {
    vtkAlgorithmOutput* const given =
        request == vtkPVView::REQUEST_RENDER() ? vtkPVRenderView::GetPieceProducer(in, this) : nullptr;
    vtkAlgorithmOutput* const turned = given ? turn(*given) : nullptr;
    if (!turned) return vtkImageSliceRepresentation::ProcessViewRequest(request, in, out);
    if (!vtkPVDataRepresentation::ProcessViewRequest(request, in, out)) return 0;
    SliceMapper->SetInputConnection(turned);
    Actor->GetProperty()->ShadingOff();
    return 1;
  }

 protected:
  int RequestData(vtkInformation* request, vtkInformationVector** in, vtkInformationVector* out) override {
    vtkImageData* const image = vtkImageData::GetData(in[0], 0);
    const bool whole = image && in[0]->GetNumberOfInformationObjects() == 1 && SliceMode == YZ_PLANE &&
                       image->GetDataDimension() == 3 && image->GetCellData()->GetNumberOfArrays() == 0;
    std::array<int, 6> extent{};
    if (whole) in[0]->GetInformationObject(0)->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent.data());
    // Of a part of an image on one of several servers ParaView knows what to show.
    if (!whole || !std::equal(extent.begin(), extent.end(), image->GetExtent())) {
      return vtkImageSliceRepresentation::RequestData(request, in, out);
    }
    image->GetBounds(WholeBounds);
    take_slice(*image, std::min(extent[0] + static_cast<int>(Slice), extent[1]), *SliceData);
    return vtkPVDataRepresentation::RequestData(request, in, out);
  }

 private:
  /// Null if ParaView's own is to be shown.
  vtkAlgorithmOutput* turn(vtkAlgorithmOutput& given) {
    auto* const slice = vtkImageData::SafeDownCast(given.GetProducer()->GetOutputDataObject(given.GetIndex()));
    if (!slice || vtkStructuredData::GetDataDescriptionFromExtent(slice->GetExtent()) != VTK_YZ_PLANE ||
        SliceMapper->GetUseXYPlane())
      return nullptr;
    if (slice != turned_of_ || slice->GetMTime() > turned_at_) {
      turned_of_ = slice;
      turned_at_ = slice->GetMTime();
      turned_->SetOutput(with_long_rows(*slice));
    }
    return turned_->GetOutputPort();
  }

  vtkNew<vtkTrivialProducer> turned_;
  vtkWeakPointer<vtkImageData> turned_of_;
  vtkMTimeType turned_at_ = 0;
};

}  // namespace

void quicken_slices() {
  constexpr const char* name = "PalpateQuickSlices";
  static const bool known = [] {
    vtkClientServerInterpreterInitializer::GetInitializer()->RegisterCallback(
        [](vtkClientServerInterpreter* made) { made->AddNewInstanceFunction(name, &QuickSlices::make); });
    return true;
  }();
  auto* const process = vtkProcessModule::GetProcessModule();  // null if a program uses the reader alone
  auto* const session = process ? vtkPVSessionBase::SafeDownCast(process->GetSession()) : nullptr;
  // A server sends its definitions to its clients, and some do not know the name.
  constexpr auto alone = vtkPVSession::CLIENT | vtkPVSession::SERVERS;
  if (!session || (session->GetProcessRoles() & alone) != alone) return;
  vtkSIProxyDefinitionManager* const definitions = session->GetProxyDefinitionManager();
  vtkPVXMLElement* const slices =
      definitions ? definitions->GetProxyDefinition("representations", "ImageSliceRepresentation", false) : nullptr;
  if (known && slices) slices->SetAttribute("class", name);
}

}  // namespace palpate::plugin

#include "plugin/paraview/client/views/patient_volume.h"

#include <pqDataRepresentation.h>
#include <pqPipelineSource.h>
#include <pqRenderView.h>
#include <vtkAlgorithm.h>
#include <vtkCommand.h>
#include <vtkDataArray.h>
#include <vtkFixedPointVolumeRayCastMapper.h>
#include <vtkImageData.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPVRenderView.h>
#include <vtkPointData.h>
#include <vtkRenderer.h>
#include <vtkSMProperty.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>
#include <vtkSMRenderViewProxy.h>
#include <vtkSmartVolumeMapper.h>
#include <vtkVolume.h>
#include <vtkVolumeCollection.h>
#include <vtkVolumeMapper.h>
#include <vtkVolumeProperty.h>

#include <QTimer>

#include <string_view>
#include <utility>

#include "plugin/paraview/client/jobs/job.h"
#include "plugin/paraview/client/views/body_of.h"
#include "plugin/paraview/client/views/castable.h"
#include "plugin/paraview/client/views/crop_box.h"
#include "plugin/paraview/client/views/event_watch.h"
#include "plugin/paraview/client/views/software_volume.h"

namespace palpate::plugin {
namespace {

vtkPVRenderView& render_view_of(const pqRenderView& view) {
  return *vtkPVRenderView::SafeDownCast(view.getRenderViewProxy()->GetClientSideView());
}

}  // namespace

PatientVolume::PatientVolume(pqRenderView& view, pqPipelineSource& scan, bool hounsfield, std::function<void()> changed)
    : view_(&view), scan_(&scan), hounsfield_(hounsfield), changed_(std::move(changed)) {
  if (pqDataRepresentation* const shown = scan.getRepresentation(&view)) {
    const auto again = [this] { refresh(); };
    QObject::connect(shown, &pqRepresentation::visibilityChanged, &lifetime_, again);
    type_watch_ = std::make_unique<EventWatch>(shown->getProxy()->GetProperty("Representation"),
                                               vtkCommand::ModifiedEvent, again);
  }
  take_image();
  // Its values may have been filtered, or read again.
  QObject::connect(&scan, QOverload<pqPipelineSource*>::of(&pqPipelineSource::dataUpdated), &lifetime_,
                   [this] { take_image(); });
}

void PatientVolume::begin_to_draw() {
  if (std::exchange(waits_, false)) refresh();
}

void PatientVolume::take_image() {
  auto* const reader = scan_ ? vtkAlgorithm::SafeDownCast(scan_->getProxy()->GetClientSideObject()) : nullptr;
  auto* const image = reader ? vtkImageData::SafeDownCast(reader->GetOutputDataObject(0)) : nullptr;
  vtkSMProperty* const times = scan_ ? scan_->getProxy()->GetProperty("TimestepValues") : nullptr;
  const bool one_frame = !times || vtkSMPropertyHelper(times).GetNumberOfElements() <= 1;
  vtkDataArray* const values = image ? image->GetPointData()->GetScalars() : nullptr;
  const bool same = whole_image_ && whole_image_->GetPointData()->GetScalars() == values;
  const bool seek_body = values && one_frame && hounsfield_;
  // Starts the view's own timer after those of the slices. Finding the body of a large scan takes long.
  constexpr int no_wait_ms = 1, most_wait_ms = 3000;
  if (waits_ && !(seek_body && draws_without_card())) {
    QTimer::singleShot(seek_body ? most_wait_ms : no_wait_ms, &lifetime_, [this] { begin_to_draw(); });
  }
  if (!values || same) return;
  whole_image_ = vtkSmartPointer<vtkImageData>::New();
  whole_image_->ShallowCopy(image);
  cut_image_ = nullptr;
  casting_.forget();
  seeking_body_.cancel();
  refresh();
  if (!seek_body) return;
  seeking_body_.ask([image = whole_image_](const Job::Control& control) { return body_of(*image, control.keep_going); },
                    [this](const auto& found, const QString&) {
                      if (found) cut_image_ = *found;
                      waits_ = false;
                      refresh();
                      if (cut_image_ && changed_) changed_();
                    });
}

PatientVolume::~PatientVolume() {
  type_watch_.reset();
  look_watch_.reset();
  casting_.finish();
  seeking_body_.finish();
  box_.reset();
  if (!view_) return;
  vtkRenderer& renderer = *render_view_of(*view_).GetRenderer();
  if (own_) renderer.RemoveVolume(own_);
  if (taken_out_) renderer.AddVolume(taken_out_);
}

void PatientVolume::set_cut(bool cut) {
  cut_ = cut;
  refresh();
}

void PatientVolume::set_cropped(bool cropped) {
  cropped_ = cropped && can_crop();
  refresh();
}

void PatientVolume::set_hidden(bool hidden) {
  if (std::exchange(hidden_, hidden) != hidden) refresh();
}

/// The volume that the representation has put into the view.
vtkVolume* PatientVolume::of_paraview() const {
  if (taken_out_) return taken_out_;
  vtkVolumeCollection& volumes = *render_view_of(*view_).GetRenderer()->GetVolumes();
  for (int n = 0; n < volumes.GetNumberOfItems(); ++n) {
    auto* const volume = vtkVolume::SafeDownCast(volumes.GetItemAsObject(n));
    if (volume != own_) return volume;
  }
  return nullptr;
}

/// Of the view: the representation makes it visible before every picture.
void PatientVolume::take_out(vtkVolume& theirs, bool out) {
  if (out == (taken_out_ != nullptr)) return;
  vtkRenderer& renderer = *render_view_of(*view_).GetRenderer();
  if (out) {
    taken_out_ = &theirs;
    renderer.RemoveVolume(&theirs);
  } else {
    renderer.AddVolume(&theirs);
    taken_out_ = nullptr;
  }
}

/// Under *Advanced* the user can hide the scan, or show it as something else.
bool PatientVolume::is_shown() const {
  pqDataRepresentation* const shown = scan_ ? scan_->getRepresentation(view_) : nullptr;
  if (!shown) return false;
  const char* const type = vtkSMPropertyHelper(shown->getProxy(), "Representation").GetAsString();
  return shown->isVisible() && type && std::string_view(type) == "Volume";
}

void PatientVolume::refresh() {
  if (!view_) return;
  view_->render();  // at the next turn of events
  vtkVolume* const theirs = of_paraview();
  if (!theirs) return;
  const bool cut = cut_ && cut_image_;
  vtkImageData* const image = cut ? cut_image_ : whole_image_;
  const bool cast = image && casting_.can_cast() && can_be_cast(*image) && draws_without_card();
  if (cast && !waits_) casting_.prepare(*image);
  const bool hidden = hidden_ || waits_ || (cast && !casting_.mapper()) || !is_shown();
  const bool ours = !hidden && (cut || cropped_ || cast);
  if (cropped_ && !box_) box_ = std::make_unique<CropBox>(*view_, whole_image_->GetBounds());
  if (box_) box_->set_visible(cropped_);
  if (ours) draw_ours(*theirs, *image, cast);
  if (own_) own_->SetVisibility(ours ? 1 : 0);
  take_out(*theirs, ours || hidden);
}

void PatientVolume::draw_ours(vtkVolume& theirs, vtkImageData& image, bool cast) {
  if (!own_) {
    own_ = vtkSmartPointer<vtkVolume>::New();
    own_->PickableOff();
    render_view_of(*view_).GetRenderer()->AddVolume(own_);
  }
  // Properties set for one also apply to the other.
  if (cast) {
    if (!look_watch_) {
      own_->SetProperty(vtkNew<vtkVolumeProperty>());
      const auto follow = [own = own_.Get(), of = theirs.GetProperty()] {
        light_for_casting(*of, *own->GetProperty());
      };
      follow();
      look_watch_ = std::make_unique<EventWatch>(theirs.GetProperty(), vtkCommand::ModifiedEvent, follow);
    }
    own_->SetMapper(casting_.mapper());
    own_->SetUserMatrix(place_of(image));
  } else {
    look_watch_.reset();
    own_->SetProperty(theirs.GetProperty());
    auto* smart = vtkSmartVolumeMapper::SafeDownCast(own_->GetMapper());
    if (!smart) own_->SetMapper(smart = vtkSmartPointer<vtkSmartVolumeMapper>::New());
    smart->SetInputData(&image);
    own_->SetUserMatrix(nullptr);
  }
  auto& mapper = *vtkVolumeMapper::SafeDownCast(own_->GetMapper());
  if (cropped_) {
    mapper.SetClippingPlanes(box_->planes());
  } else {
    mapper.RemoveAllClippingPlanes();
  }
}

}  // namespace palpate::plugin

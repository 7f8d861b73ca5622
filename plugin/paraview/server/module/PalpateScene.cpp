#include "plugin/paraview/server/module/PalpateScene.h"

#include <vtkDoubleArray.h>
#include <vtkInformation.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkStringArray.h>
#include <vtkTable.h>

#include <exception>

#include "modes/scene/scene.h"
#include "plugin/paraview/server/module/scan_of_image.h"
#include "plugin/report/summary.h"

using namespace palpate;

vtkStandardNewMacro(PalpateScene);

PalpateScene::PalpateScene() {
  SetNumberOfInputPorts(0);
}

void PalpateScene::PrintSelf(ostream& os, vtkIndent indent) {
  Superclass::PrintSelf(os, indent);
  os << indent << "Scene: " << scene_ << "\n" << indent << "Marks: " << marks_ << "\n";
}

void PalpateScene::SetScene(const char* scene) {
  const std::string text = scene ? scene : "";
  if (text == scene_) return;
  scene_ = text;
  Modified();
}

int PalpateScene::RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs) {
  vtkTable& table = *vtkTable::GetData(outputs);
  try {
    const modes::Scene scene = plugin::scene_of(scene_);
    vtkNew<vtkStringArray> names, types, colors;
    vtkNew<vtkIntArray> enabled;
    vtkNew<vtkDoubleArray> strengths;
    names->SetName("Name");
    types->SetName("Type");
    colors->SetName("Color");
    enabled->SetName("Switched on");
    strengths->SetName("Strength (N)");
    for (std::size_t n = 0; n < scene.modes.size(); ++n) {
      const modes::Mode& mode = scene.modes[n];
      names->InsertNextValue(plugin::display_name(scene, n));
      types->InsertNextValue(mode.type);
      colors->InsertNextValue(mode.color);
      enabled->InsertNextValue(mode.enabled ? 1 : 0);
      strengths->InsertNextValue(mode.strength_n.maximum());
    }
    for (vtkAbstractArray* const column :
         {static_cast<vtkAbstractArray*>(names.Get()), static_cast<vtkAbstractArray*>(types.Get()),
          static_cast<vtkAbstractArray*>(colors.Get()), static_cast<vtkAbstractArray*>(enabled.Get()),
          static_cast<vtkAbstractArray*>(strengths.Get())}) {
      table.AddColumn(column);
    }
    return 1;
  } catch (const std::exception& error) {
    vtkErrorMacro(<< error.what());
    return 0;
  }
}

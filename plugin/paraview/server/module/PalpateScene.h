#pragma once

/// A scene as a source in ParaView's pipeline, so that state files, traces and undo hold it: its text is a property,
/// its output a table of its modes.

#include <vtkTableAlgorithm.h>

#include <string>

#include "PalpateServerModule.h"

class PALPATESERVER_EXPORT PalpateScene : public vtkTableAlgorithm {
 public:
  static PalpateScene* New();
  vtkTypeMacro(PalpateScene, vtkTableAlgorithm) void PrintSelf(ostream& os, vtkIndent indent) override;

  /// JSON, the name of a starting scene, or a file; empty: no modes.
  void SetScene(const char* scene);

  PalpateScene(const PalpateScene&) = delete;
  PalpateScene& operator=(const PalpateScene&) = delete;

 protected:
  PalpateScene();
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

 private:
  std::string scene_;
};

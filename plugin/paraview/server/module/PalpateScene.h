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
  /// The marks of all scans, as kept_text() in plugin/report/kept_marks.h writes them. They do not change the output.
  void SetMarks(const char* marks) { marks_ = marks ? marks : ""; }
  /// How the volume is shown, in addition to its colors: "felt" for the felt boundaries. It does not change the output.
  void SetVolumeLook(const char* look) { volume_look_ = look ? look : ""; }

  PalpateScene(const PalpateScene&) = delete;
  PalpateScene& operator=(const PalpateScene&) = delete;

 protected:
  PalpateScene();
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

 private:
  std::string scene_, marks_, volume_look_;
};

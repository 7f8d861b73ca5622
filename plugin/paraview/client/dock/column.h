#pragma once

/// The panel's sections, from top to bottom, and the footer below them.

#include <QWidget>

#include <functional>

#include "plugin/paraview/client/model/correction_model.h"
#include "plugin/paraview/client/model/marks_model.h"
#include "plugin/paraview/client/model/open_views.h"
#include "plugin/paraview/client/model/sharing_model.h"
#include "plugin/paraview/client/panel/stroke_runner.h"
#include "plugin/paraview/client/pipeline/scan_pipeline.h"
#include "plugin/paraview/client/stylus/stylus_section.h"

class QVBoxLayout;

namespace palpate::plugin {

class CurvesSection;
class FilterRow;
class Fold;
class Footer;
class MarksSection;
class ModesSection;
class ProfileSection;
class RecordingsSection;
class ScanSection;
class StructuresSection;
class StylusSection;
class TissueStudy;
class TissuesSection;

class Column : public QWidget {
  Q_OBJECT

 public:
  /// The models that the sections follow.
  struct Follows {
    ScanModel& scans;
    ScanPipeline& readers;
    OpenViews& views;
    SceneModel& scene;
    SessionController& session;
    CorrectionModel& correction;
    MarksModel& marks;
    SharingModel& sharing;
  };
  /// `eye`: returns the volume view's viewpoint.
  Column(const Follows& models, const std::function<Eye()>& eye);
  ~Column() override;

  Fold* scan_fold = nullptr;
  ScanSection* scan = nullptr;
  FilterRow* filter = nullptr;
  TissuesSection* tissues = nullptr;
  TissueStudy* study = nullptr;
  StructuresSection* structures = nullptr;
  StylusSection* stylus = nullptr;
  Fold* marks_fold = nullptr;
  MarksSection* marks = nullptr;
  CurvesSection* curves = nullptr;
  ModesSection* modes = nullptr;
  ProfileSection* profile = nullptr;
  Fold* recordings_fold = nullptr;
  RecordingsSection* recordings = nullptr;
  Footer* footer = nullptr;

 signals:
  void boundaries_wanted(bool shown);
  void crosshair_wanted(bool shown);
  void ras_wanted(bool on);

 private:
  void build_scan(const Follows& models, QVBoxLayout& column);
  QWidget* build_tissues(const Follows& models);
  void build_others(const Follows& models, const std::function<Eye()>& eye, QVBoxLayout& column);
  void show_technical(bool shown);
  Fold* fold(const QString& title, const QString& name, QWidget* section, bool open, QVBoxLayout& column);

  StrokeRunner strokes_;
};

}  // namespace palpate::plugin

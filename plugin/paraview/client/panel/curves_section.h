#pragma once

/// The panel's fourth section: how the strength of a boundary depends on the scan.

#include <QWidget>

#include <memory>
#include <optional>

#include "io/fields/field_source.h"
#include "plugin/paraview/client/jobs/scan_study.h"
#include "plugin/paraview/client/model/scene_model.h"
#include "plugin/paraview/client/panel/curve_editor.h"
#include "plugin/paraview/client/panel/curve_profile.h"

class QComboBox;
class QLabel;

namespace palpate::plugin {

class CurvesSection : public QWidget {
  Q_OBJECT

 public:
  /// Whether holding B shows the scene before the last edit; off while another section shows its own earlier state.
  void set_key_shows_before(bool shows) { key_shows_before_ = shows; }
  CurvesSection(SceneModel& model, SessionController& session, StrokeRunner& strokes, QWidget* parent = nullptr);

  /// Null: there is no scan, or its study has not ended; nothing is shown and nothing can be edited.
  void set_study(const std::shared_ptr<const ScanStudy>& study, const QString& unit);
  /// The sample under the pointer in a slice, marked in the histograms; none: no mark.
  void mark(const std::optional<io::Sample>& pointed);
  CurveProfile& profile() { return *profile_; }

 protected:
  /// While the key B is held, the scene is shown and felt without the last edit.
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void end_before();
  const Counts& counts_of(modes::Datum datum) const;
  void list_modes();
  void show_mode();
  void use_preset(int index);
  std::size_t mode() const;

  SceneModel& model_;
  std::shared_ptr<const ScanStudy> study_;
  QString unit_;
  QComboBox* modes_;
  QComboBox* presets_;
  CurveEditor* strength_;
  CurveEditor* gate_;
  CurveProfile* profile_;
  QLabel* message_;
  bool key_shows_before_ = true;
  bool key_held_ = false;
};

}  // namespace palpate::plugin

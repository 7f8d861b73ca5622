#pragma once

/// The panel's second section: the boundaries that can be felt, each with its switch, color, name and strength.

#include <QWidget>

#include "plugin/paraview/client/panel/scene_model.h"

class QComboBox;
class QGridLayout;
class QLabel;
class QScrollArea;

namespace palpate::plugin {

class TissuesSection : public QWidget {
  Q_OBJECT

 public:
  explicit TissuesSection(SceneModel& model, QWidget* parent = nullptr);

  /// The scene that was proposed for the scan: first of the scenes to choose from.
  void set_proposed(const modes::Scene& scene);

 private:
  void build_rows();
  void show_values();
  void choose_scene(int index);
  void open_file();
  void save_file();

  SceneModel& model_;
  modes::Scene proposed_;
  QComboBox* scenes_;
  QLabel* message_;
  QScrollArea* scroll_;
  QWidget* rows_;
  QGridLayout* grid_ = nullptr;
  std::vector<std::size_t> shown_;  // modes of the rows
  std::vector<std::string> shown_types_;
};

/// A strength as one number: the largest, N.
double strength_of(const modes::Mode& mode);
/// The same curve, as strong as that.
void scale_strength(modes::Mode& mode, double newtons);

}  // namespace palpate::plugin

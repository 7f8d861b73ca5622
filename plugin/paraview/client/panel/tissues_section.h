#pragma once

/// The panel's second section: the boundaries that can be felt, each with its switch, color, name and strength.

#include <QWidget>

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "plugin/paraview/client/model/scan_handle.h"
#include "plugin/paraview/client/model/scene_model.h"
#include "plugin/paraview/client/panel/boundary_row.h"

class QComboBox;
class QGridLayout;
class QLabel;

namespace palpate::plugin {

class TissuesSection : public QWidget {
  Q_OBJECT

 public:
  explicit TissuesSection(SceneModel& model, QWidget* parent = nullptr);

  /// The scene that was proposed for the scan: first of the scenes to choose from.
  void set_proposed(const modes::Scene& scene);
  /// Another scan is shown: nothing was found in it yet. The starting scene that suits it comes first of the others,
  /// and those that are made for other scans last.
  void forget_scan(const ScanHandle& shown);
  /// The scene that the model has came with a state file.
  void set_restored();
  /// What the scene is: where it came from, and whether it was edited since.
  QString scene_in_words() const;

 signals:
  /// The scene as it is can be had again: it was chosen from the list, or written into a file.
  void scene_kept();

 private:
  void list_choices();
  void build_rows();
  void show_values();
  void show_alike();
  void choose_scene(int index);
  void choose(int item, const QString& what);
  int add_choice(const QString& label, const modes::Scene& scene);
  void follow_origin();
  void show_origin();
  void open_file();
  void save_file();

  SceneModel& model_;
  /// A scene to choose from: an item of the box.
  struct Choice {
    QString label;
    modes::Scene scene;
    std::string text;       ///< of what is felt in it; empty: there is none yet
    std::string name = {};  ///< of a starting scene
    QString made_for = {};  ///< what it suits, where that is another kind of scan
  };
  std::vector<Choice> choices_;
  std::map<std::string, int> edited_from_;  // text of an edited scene -> the choice that it was made of
  int choice_ = 0;
  std::optional<int> choosing_;
  bool edited_ = false;
  QComboBox* scenes_;
  QLabel* message_;
  QWidget* rows_;
  QGridLayout* grid_ = nullptr;
  std::vector<std::unique_ptr<BoundaryRow>> boundaries_;
  std::vector<std::string> shown_types_;
};

}  // namespace palpate::plugin

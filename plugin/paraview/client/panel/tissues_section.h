#pragma once

/// The panel's second section: the boundaries that can be felt, each with switch, color, name and strength.

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

  /// The scene found in the scan: the first in the list of scenes. None: nothing was found, and the list says so.
  void set_proposed(const std::optional<modes::Scene>& scene);
  /// Another scan is shown, without a search so far. After the scene proposed for this scan, the list has the starting
  /// scene that suits it, and last the scenes for other types of scan.
  void forget_scan(const ScanHandle& shown);
  /// The model's scene comes from a state file.
  void set_restored();
  /// The origin of the scene, and whether it was edited since.
  QString scene_in_words() const;

 signals:
  /// The present scene is saved: it was chosen from the list, or written to a file.
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
  /// A scene in the list.
  struct Choice {
    QString label;
    modes::Scene scene;
    std::string text;       ///< of the scene; empty: not available yet
    std::string name = {};  ///< of a starting scene
    QString made_for = {};  ///< the type of scan that it suits, if that is not this one
  };
  std::vector<Choice> choices_;
  std::map<std::string, int> edited_from_;  // text of an edited scene -> the choice that it was made from
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

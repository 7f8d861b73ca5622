#pragma once

/// The panel's section of structures: lists the structures outlined on the scan. One press draws a structure or makes
/// it felt.

#include <QWidget>

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "io/structures/structure.h"
#include "plugin/paraview/client/jobs/job.h"
#include "plugin/paraview/client/model/correction_model.h"
#include "plugin/paraview/client/model/session_controller.h"
#include "plugin/paraview/client/panel/made_structure.h"
#include "plugin/paraview/client/panel/outline_margins.h"
#include "plugin/paraview/client/panel/structure_finder.h"
#include "plugin/paraview/client/views/structure_views.h"
#include "plugin/structures/scene_structures.h"

class QDoubleSpinBox;
class QLabel;
class QMenu;
class QSlider;
class QToolButton;
class QTreeWidget;
class QTreeWidgetItem;

namespace palpate::plugin {

class CorrectBox;

class StructuresSection : public QWidget {
  Q_OBJECT

 public:
  StructuresSection(OpenViews& views, SceneModel& model, SessionController& session, CorrectionModel& correction,
                    QWidget* parent = nullptr);
  ~StructuresSection() override;

  /// Searches the folder of a new scan for structures; null: there is no scan.
  void set_scan(std::shared_ptr<const io::Volume> scan, const std::string& folder);
  /// Another frame of the scan. The list stays; everything computed for the previous frame is computed again.
  void set_frame(const std::shared_ptr<const io::Volume>& frame);
  /// Searches these files, too; shows `problem` unless it is empty.
  void add(const std::vector<std::filesystem::path>& files, const QString& problem);
  /// The numbers of structures that can and cannot be felt on the scan, in words; empty if none was found.
  QString in_words() const;
  CorrectBox& correct_box() { return *correct_box_; }
  /// The felt field of the corrected structure; null: no correction, or the structure is not read yet.
  std::shared_ptr<const io::DistanceField> corrected() const;
  /// Whether the corrected structure is visibly drawn.
  bool shows_corrected() const;
  /// The change by its edits, and its margins from structures that the stylus is kept out of; empty: no edits, or not
  /// known yet.
  QString change_in_words() const;
  void tell(const QString& text, bool problem);

 signals:
  void listed();

 protected:
  void dragEnterEvent(QDragEnterEvent* event) override;
  void dropEvent(QDropEvent* event) override;

 private:
  /// A structure that was found, and what is known of it so far.
  struct Entry {
    io::Structure structure;
    std::string why_not;  ///< why it cannot be felt; empty if it can
    Text off;             ///< a message if it is wholly outside the scan; empty if not, or not yet measured
    bool shown = false;
    std::string color;
    std::vector<io::Edit> edits;  ///< the scene's edits of its outline
    MadeStructure made;           ///< the latest result, perhaps with other edits
  };
  using Edit = std::function<void(modes::Scene&)>;

  void build();
  QWidget* build_uses();
  void ask_files();
  void take(const StructureFinder::Found& found);
  void follow_scene();
  void list();
  void show_row(QTreeWidgetItem& item, const Entry& entry) const;
  void make_next();
  void take_made(const MadeStructure& made);
  void follow_drawn();
  const LoadedStructure* felt(const Entry& entry) const;
  void look_whether_off(Entry& entry);
  static double volume_of(const Entry& entry);
  static bool is_edited(const Entry& entry);
  std::vector<double> margins_of(const io::Structure& structure) const;
  void draw();
  void choose_color(std::size_t n);
  void give_color(const io::Structure& structure, const QString& color);
  Entry* chosen();
  void fill_gates(QMenu& menu);
  void use(const QString& what, const Edit& edit);
  void correct(bool on);
  void follow_correction();
  void follow_strokes();
  void measure_margins();
  QString margins_in_words() const;
  std::function<std::shared_ptr<const io::DistanceField>()> outline_within(const io::Structure& structure,
                                                                           double reach_mm) const;
  void look_beside(std::vector<io::Vec3> places, double within_mm,
                   std::function<void(const CorrectionModel::Edges&)> done);
  void find_doubtful(const io::Structure* structure, std::function<void(io::DoubtfulPlaces)> done);
  bool is_corrected(const Entry& entry) const;
  const Entry* corrected_entry() const;

  SceneModel& model_;
  SessionController& session_;
  CorrectionModel& correction_;
  QTreeWidget* list_ = nullptr;
  QSlider* opacity_ = nullptr;
  QDoubleSpinBox* margin_ = nullptr;
  QLabel* message_ = nullptr;
  std::vector<QToolButton*> uses_;
  QToolButton* correct_ = nullptr;
  CorrectBox* correct_box_ = nullptr;

  std::shared_ptr<const io::Volume> scan_;
  std::vector<Entry> entries_;
  bool listing_ = false;
  StructureViews drawn_;
  StructureFinder finder_;
  Job making_{Job::Newer::follows};
  Job doubting_;
  Job looking_beside_;
  OutlineMargins margins_{[this] { follow_correction(); }};
};

}  // namespace palpate::plugin

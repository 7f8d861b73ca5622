#pragma once

/// The panel's first section: from a folder to a scan on the screen.

#include <pqPipelineSource.h>

#include <QPointer>
#include <QWidget>

#include <memory>
#include <string>
#include <vector>

#include "clinical_views.h"
#include "scan_loader.h"

class QComboBox;
class QLabel;
class QListWidget;
class QProgressBar;
class QPushButton;

namespace palpate::plugin {

class ScanSection : public QWidget {
  Q_OBJECT

 public:
  explicit ScanSection(QWidget* parent = nullptr);
  ~ScanSection() override;

  /// Finds the series of a folder or file; where one alone is a volume, shows it.
  void open(const std::string& path);
  /// Takes over a reader that stands in the pipeline and its views as they are: a state file has restored them.
  void adopt(pqPipelineSource& reader);
  /// Whether there is something to be read about the scan that is shown.
  bool has_notes() const;
  ClinicalViews& views() { return views_; }
  pqPipelineSource* source() const { return source_; }

 signals:
  /// The views of the scan that is shown are about to go.
  void closing();
  /// Another scan is in the views.
  void scan_shown(const std::shared_ptr<const palpate::io::Volume>& volume);

 protected:
  void dragEnterEvent(QDragEnterEvent* event) override;
  void dropEvent(QDropEvent* event) override;

 private:
  void build();
  void ask_folder();
  void list(std::shared_ptr<const io::Catalogue> catalogue, const std::string& error);
  void load(std::size_t series);
  struct Loaded {
    std::shared_ptr<const io::Catalogue> catalogue;
    std::string path;
    std::size_t series = 0;
    std::shared_ptr<const io::Volume> volume;  ///< held until the reader has it
  };
  void show(const Loaded& loaded);
  void show_now(const Loaded& loaded);
  void list_windows();
  void say_what_to_know(const Loaded& loaded);
  void apply_window(int choice);
  void set_busy(bool busy, const QString& what = {});
  void tell(const QString& message, bool problem = false);

  QPushButton* open_ = nullptr;
  QListWidget* series_ = nullptr;
  QProgressBar* progress_ = nullptr;
  QPushButton* cancel_ = nullptr;
  QComboBox* window_ = nullptr;
  QLabel* message_ = nullptr;

  std::string path_;
  std::shared_ptr<const io::Catalogue> catalogue_;
  bool showing_ = false;
  QPointer<pqPipelineSource> source_;
  ClinicalViews views_;
  ScanLoader thumbnails_;
  ScanLoader loader_;  // last: its thread is to end before all that its callbacks use
};

}  // namespace palpate::plugin

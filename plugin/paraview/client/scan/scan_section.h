#pragma once

/// The panel's first section: from a folder to a scan on the screen.

#include <pqPipelineSource.h>

#include <QImage>
#include <QPointer>
#include <QStringList>
#include <QWidget>

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "plugin/paraview/client/remote/server_scan.h"
#include "plugin/paraview/client/remote/server_series.h"
#include "plugin/paraview/client/scan/scan_handle.h"
#include "plugin/paraview/client/scan/scan_loader.h"
#include "plugin/paraview/client/views/clinical_views.h"

class pqServer;
class QComboBox;
class QLabel;
class QListWidget;
class QProgressBar;
class QPushButton;
class QSlider;
class QTabBar;
class QVBoxLayout;

namespace palpate::plugin {

class ArchiveTab;

class ScanSection : public QWidget {
  Q_OBJECT

 public:
  explicit ScanSection(QWidget* parent = nullptr);
  ~ScanSection() override;

  /// Finds the series of a folder or file, as the active server names it. Shows it if exactly one of them is a volume.
  void open(const std::string& path);
  /// Shows one of the series that were found, by its number in the catalogue.
  void load(std::size_t series);
  /// Brings the archives in front of the folder.
  void show_archive();
  /// The server has gone, with everything that it read.
  void server_gone();
  /// Takes over a reader that stands in the pipeline and its views as they are: a state file has restored them.
  void adopt(pqPipelineSource& reader);
  /// Asks for a folder and opens it.
  void ask_folder();
  /// Asks for a file that holds whole scans and opens it.
  void ask_file();
  /// The box of gray windows, to be placed where it is always in sight.
  QComboBox& window_box() { return *window_; }
  /// Notes on the scan, and its frames: visible also when the section is folded.
  QWidget& notes() { return *notes_; }
  ClinicalViews& views() { return views_; }
  pqPipelineSource* source() const { return source_; }
  /// The scan that is shown and can be felt; without a volume if there is none.
  const ScanHandle& handle() const { return handle_; }
  /// `filter` returns the filter that is felt, so that a new frame is filtered from the start.
  void set_filter(std::function<io::Filter()> filter) { filter_ = std::move(filter); }
  /// The series that is shown; null if only a server has it.
  const io::Series* series_shown() const;
  /// Why the views show something other than what the stylus would feel, and what to do; empty if they agree.
  QString why_not_felt() const;
  /// The names, in the pipeline, of scans that are visible in a view beside the one that is felt.
  QStringList others_shown() const;

 signals:
  /// Series are looked for anew.
  void finding();
  /// There are several to choose from.
  void listed(const std::shared_ptr<const palpate::io::Catalogue>& catalogue);
  void thumbnail_drawn(std::size_t series, const QImage& picture);
  /// A note or an error message; empty: nothing.
  void said(const QString& message, bool problem);
  /// The views of the scan that is shown are about to go.
  void closing();
  /// A server's scan is in the views, or about to be. It cannot be felt yet (`why` is empty), or not at all (`why` says
  /// the reason).
  void out_of_reach(const QString& why);
  /// Another scan is in the views, and can be felt.
  void scan_shown(const palpate::plugin::ScanHandle& handle);
  /// Another frame of it is in the views, and can be felt.
  void frame_shown(const palpate::plugin::ScanHandle& handle);

 protected:
  void dragEnterEvent(QDragEnterEvent* event) override;
  void dropEvent(QDropEvent* event) override;

 private:
  void build();
  void build_tabs();
  void build_series();
  void build_progress(QVBoxLayout& column);
  void build_window();
  void list(std::shared_ptr<const io::Catalogue> catalogue, const std::string& error);
  void list_rows();
  void draw_thumbnails();
  void leave_other_patient();
  void close_scan();
  struct Loaded {
    std::string path;
    std::string name;  ///< of the series: scan_name()
    std::shared_ptr<const io::Catalogue> catalogue;
    std::size_t series = 0;
    std::shared_ptr<const io::Volume> volume;  ///< held until the reader has it; null: the server has it
    int frame = 0;
  };
  void show(const Loaded& loaded);
  void show_now(const Loaded& loaded);
  void read(const Loaded& loaded, pqServer& server);
  void views_are_made(const Loaded& loaded, const std::string& error);
  bool is_in_paraview() const;
  void take(const Loaded& loaded);
  QWidget* build_frames();
  void go_to_frame(int frame);
  void follow_time();
  void watch_time();
  void show_frame();
  void show_frame_of(const std::shared_ptr<const io::Volume>& volume, int frame);
  int frame_of_time() const;
  io::Filter felt_filter() const;
  void open_on_server();
  void fetch(const std::string& path);
  void fetch_frame(int frame);
  int server_frames() const;
  void ask_copy();
  void adopt_from_server();
  void list_windows();
  void say_what_to_know(const Loaded& loaded);
  void apply_window(int choice);
  void show_window();
  void fit_series();
  void resizeEvent(QResizeEvent* event) override;
  void set_busy(bool busy, const QString& what = {});
  void tell(const QString& message, bool problem = false);

  QTabBar* tabs_ = nullptr;
  ArchiveTab* archive_ = nullptr;
  QWidget* folder_ = nullptr;
  QPushButton* open_ = nullptr;
  QListWidget* series_ = nullptr;
  QProgressBar* progress_ = nullptr;
  QPushButton* cancel_ = nullptr;
  QPushButton* copy_ = nullptr;
  QComboBox* window_ = nullptr;
  QWidget* frames_ = nullptr;
  QSlider* frame_ = nullptr;
  QLabel* frame_text_ = nullptr;
  QLabel* message_ = nullptr;
  QWidget* notes_ = nullptr;

  std::string path_;
  std::shared_ptr<const io::Catalogue> catalogue_;
  std::unique_ptr<ServerSeries> on_server_;  // what the active server found; null: it is this program
  std::vector<std::string> copies_;          // folders of this machine that were named
  int fetching_ = 0;                         // frame that is on its way from the server
  bool showing_ = false;
  int asked_ = 0;  // what was asked for last is shown
  QPointer<pqPipelineSource> source_;
  QPointer<pqPipelineSource> felt_source_;  // what the handle is of
  ScanHandle handle_;
  std::function<io::Filter()> filter_;
  std::size_t series_shown_ = 0;                          // in its catalogue
  std::shared_ptr<const io::Catalogue> catalogue_shown_;  // null: a server's
  std::shared_ptr<const io::Volume> coming_;  // loaded before the views go to it, so that they need not wait
  QMetaObject::Connection time_;
  ClinicalViews views_;
  ScanLoader thumbnails_;
  ServerScan server_scan_;
  ScanLoader frame_loader_;
  ScanLoader loader_;  // last: its thread is to end before all that its callbacks use
};

}  // namespace palpate::plugin

#pragma once

/// The panel's first section: from a folder to a scan on the screen.

#include <QImage>
#include <QWidget>

#include <string>

#include "plugin/paraview/client/model/scan_model.h"

class QCheckBox;
class QLabel;
class QProgressBar;
class QPushButton;
class QTabBar;
class QVBoxLayout;

namespace palpate::plugin {

class ArchiveTab;
class SeriesList;

class ScanSection : public QWidget {
  Q_OBJECT

 public:
  explicit ScanSection(ScanModel& model, QWidget* parent = nullptr);
  ~ScanSection() override;

  /// Opens a folder or file, as the active server names it, and remembers it.
  void open(const std::string& path);
  /// The same, but only after the drop was answered: the program that the drop comes from waits for the answer, and
  /// open() may ask the user a question.
  void open_later(const QString& path);
  /// Shows the tab of archives.
  void show_archive();
  /// Whether another scan was fetched, which the user has not opened yet.
  bool offers_fetched() const;
  /// Lets the user choose a folder, and opens it.
  void ask_folder();
  /// Lets the user choose a file with whole scans, and opens it.
  void ask_file();
  /// Notes on the scan, and its frames: visible also when the section is folded.
  QWidget& notes() { return *notes_; }

 signals:
  /// Another scan was fetched, which the user can open here.
  void fetch_offered();
  void thumbnail_drawn(std::size_t series, const QImage& picture);
  /// Whether positions under the pointer are shown in RAS.
  void ras_wanted(bool on);

 protected:
  void dragEnterEvent(QDragEnterEvent* event) override;
  void dropEvent(QDropEvent* event) override;

 private:
  void build_tabs();
  void build_series();
  void build_progress(QVBoxLayout& column);
  void build_notes();
  void refresh();
  void ask_copy();

  ScanModel& model_;
  QTabBar* tabs_ = nullptr;
  ArchiveTab* archive_ = nullptr;
  std::string fetched_;  // the path opened last, if it came from an archive; else empty
  unsigned requests_before_fetch_ = 0;
  QWidget* folder_ = nullptr;
  SeriesList* series_ = nullptr;
  QProgressBar* progress_ = nullptr;
  QPushButton* cancel_ = nullptr;
  QPushButton* copy_ = nullptr;
  QLabel* message_ = nullptr;
  QWidget* notes_ = nullptr;
};

}  // namespace palpate::plugin

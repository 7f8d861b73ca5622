#pragma once

/// The tab of archives (PACS): search while typing, studies and their series, fetched in the background.

#include <QHash>
#include <QIcon>
#include <QWidget>

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "io/archive/fetch.h"
#include "io/archive/find.h"
#include "plugin/app/fetched.h"
#include "plugin/paraview/client/jobs/job.h"

class QComboBox;
class QImage;
class QLabel;
class QProgressBar;
class QPushButton;
class QTreeWidget;
class QTreeWidgetItem;

namespace palpate::plugin {

class ArchiveSearch;

class ArchiveTab : public QWidget {
  Q_OBJECT

 public:
  explicit ArchiveTab(QWidget* parent = nullptr);
  ~ArchiveTab() override;

  /// `in_use` returns the folders and files that are open, whether fetched in this run or not. They are not deleted
  /// while open.
  void set_in_use(std::function<std::vector<std::filesystem::path>()> in_use) { in_use_ = std::move(in_use); }
  /// Whether a folder was fetched in this run, and is deleted at its end.
  bool has_fetched(const std::string& folder) const { return run_.holds(folder); }
  /// The picture of an opened series, for its line here.
  void set_picture(const QString& series_uid, const QImage& picture);

  /// Offers what was fetched and is not open. Empty: offers nothing.
  void offer(const QString& folder);
  bool offers() const { return !offered_.isEmpty(); }

 signals:
  void fetch_began();
  /// A study or series was fetched into a folder, and can be opened.
  void fetched(const QString& folder);
  /// The user wants what was offered.
  void offer_taken(const QString& folder);

 protected:
  /// Reads the archives again, which may have changed elsewhere.
  void showEvent(QShowEvent* event) override;

 private:
  void build_archives();
  void build_search();
  void build_fetch();
  void list_archives(const QString& chosen);
  std::optional<io::Archive> archive() const;
  void enter_archive();
  void echo();
  void search(bool begun_date);
  void list(const io::Found& found);
  void ask_series();
  void list_series(const QString& study, const std::vector<io::ArchivedSeries>& series);
  void fetch();
  void show_progress(const io::FetchProgress& progress);
  void take(const io::Fetched& fetched, const std::filesystem::path& folder);
  void empty();
  void count_on_disk();
  void set_fetching(bool fetching);
  void close();
  void tell(const QString& message, bool problem = false);

  QComboBox* archives_ = nullptr;
  QPushButton* echo_ = nullptr;
  ArchiveSearch* search_ = nullptr;
  QTreeWidget* found_ = nullptr;
  QPushButton* fetch_ = nullptr;
  QPushButton* offer_ = nullptr;
  QProgressBar* progress_ = nullptr;
  QPushButton* cancel_ = nullptr;
  QLabel* on_disk_ = nullptr;
  QPushButton* empty_ = nullptr;
  QLabel* message_ = nullptr;

  std::function<std::vector<std::filesystem::path>()> in_use_;
  QString offered_;
  std::vector<io::Archive> entered_;
  QHash<QString, QIcon> pictures_;  // by series UID
  std::vector<QString> unlisted_;   // studies whose series are to be requested
  FetchedRun run_;
  Job echoing_;
  Job finding_;
  Job listing_;
  Job counting_;
  Job fetching_;  // last: it must end before run_, which holds its files
};

}  // namespace palpate::plugin

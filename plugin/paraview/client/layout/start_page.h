#pragma once

/// The page in the empty center while no scan is open: ways to open one, and the patients, studies and series of the
/// opened folder.

#include <QScrollArea>
#include <QString>

#include <cstddef>
#include <memory>
#include <vector>

#include "io/series.h"

class QGridLayout;
class QImage;
class QLabel;
class QPushButton;
class QVBoxLayout;

namespace palpate::plugin {

class SeriesCard;

class StartPage : public QScrollArea {
  Q_OBJECT

 public:
  explicit StartPage(QWidget* parent = nullptr);

  /// The series of a folder, as cards; null: none.
  void set_catalogue(const std::shared_ptr<const io::Catalogue>& catalogue);
  void set_picture(std::size_t series, const QImage& picture);
  /// Shows the current activity, or an error.
  void tell(const QString& message, bool problem = false);
  /// Offers a sample scan by this name; empty: none is available.
  void set_sample(const QString& offer);
  void refresh_recent();

 signals:
  void open_wanted();
  void archive_wanted();
  void sample_wanted();
  void folder_wanted(const QString& folder);
  /// A series of the catalogue was chosen.
  void series_wanted(std::size_t series);

 protected:
  void dragEnterEvent(QDragEnterEvent* event) override;
  void dropEvent(QDropEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;

 private:
  struct Study {
    QGridLayout* cards = nullptr;
    std::vector<SeriesCard*> series;
  };
  QWidget* build_ways();
  void add_patient(const io::Series& of);
  void add_study(const io::Series& of);
  void place_cards();

  QLabel* message_ = nullptr;
  QPushButton* sample_ = nullptr;
  QWidget* recent_ = nullptr;
  QWidget* patients_ = nullptr;  // rebuilt for each catalogue
  QVBoxLayout* column_ = nullptr;
  std::vector<Study> studies_;
  std::vector<SeriesCard*> cards_;  // by series, followed by the velocity fields
  int across_ = 0;
};

}  // namespace palpate::plugin

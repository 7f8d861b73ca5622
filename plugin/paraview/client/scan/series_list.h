#pragma once

/// The series of the open folder, for the user to choose from.

#include <QImage>
#include <QListWidget>

#include "plugin/paraview/client/jobs/scan_loader.h"
#include "plugin/paraview/client/model/scan_model.h"

namespace palpate::plugin {

class SeriesList : public QListWidget {
  Q_OBJECT

 public:
  explicit SeriesList(ScanModel& model, QWidget* parent = nullptr);

 signals:
  void thumbnail_drawn(std::size_t series, const QImage& picture);

 protected:
  void resizeEvent(QResizeEvent* event) override;

 private:
  void list();
  void list_files(const FoundList& found);
  void fit();
  void draw_thumbnails(const FoundList& found);

  ScanModel& model_;
  ScanLoader thumbnails_;  // last: its thread must end before the members that its callbacks use are destroyed
};

}  // namespace palpate::plugin

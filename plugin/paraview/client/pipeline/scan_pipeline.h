#pragma once

/// The scan in ParaView: its reader in the pipeline, its views, ParaView's time, and the workers that read files.

#include <pqPipelineSource.h>

#include <QCoreApplication>
#include <QObject>
#include <QPointer>
#include <QStringList>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "plugin/paraview/client/jobs/scan_loader.h"
#include "plugin/paraview/client/model/scan_model.h"
#include "plugin/paraview/client/remote/server_scan.h"
#include "plugin/paraview/client/remote/server_series.h"
#include "plugin/paraview/client/views/clinical_views.h"

class pqServer;

namespace palpate::plugin {

class ScanPipeline : public ScanWorld {
  Q_DECLARE_TR_FUNCTIONS(ScanPipeline)

 public:
  /// Reports to the model what the user changes in the pipeline and in ParaView's time. To be called once.
  void follow(ScanModel& model);

  ClinicalViews& views() { return views_; }
  /// Null if there is none.
  pqPipelineSource* source() const { return source_; }
  /// Takes over a reader of the pipeline with its views as they are, which a state file or Undo has created. After a
  /// state file the previous scan is removed.
  void restore(pqPipelineSource& reader, Brought brought);
  /// The names, in the pipeline, of scans that are visible in a view beside the one that is felt.
  QStringList others_shown() const;
  /// Whether ParaView's own panels are visible: then the notes of the next scan include hints on ParaView's filters.
  void set_advanced(bool advanced) { advanced_ = advanced; }

  bool is_remote() const override;
  void find(const std::string& path, Progress progress, Found found) override;
  void load(const io::Series& series, int frame, Progress progress, Loaded loaded) override;
  void stop() override;
  void load_frame(const io::Series& series, int frame, const io::Filter& filter, Loaded loaded) override;
  void stop_frames() override;
  void show(const SeriesRef& of, int frame, Made made) override;
  void adopt() override;
  void close() override;
  void abandon() override;
  void fetch(const SeriesRef& of, std::optional<int> frame, const io::Filter& filter, std::vector<std::string> places,
             Progress progress, Fetched fetched) override;
  void stop_fetching() override;
  void show_frame(int frame) override;
  int frame_in_views(int frames) const override;
  ViewFacts facts() const override;
  QString notes(const SeriesRef& of, const io::Volume* volume) const override;

 private:
  void show_now(const SeriesRef& of, int frame, const Made& made);
  void read(const SeriesRef& of, int frame, pqServer& server);
  void destroy_reader();
  void fetch_local(const SeriesRef& of, const io::Filter& filter, const Progress& progress, const Fetched& fetched);
  void watch_removed(const pqPipelineSource* removed);
  void watch_added(pqPipelineSource* added);
  void watch_time();
  void take(const ScanHandle& scan);

  ScanModel* model_ = nullptr;
  QPointer<pqPipelineSource> source_;
  std::unique_ptr<ServerSeries> on_server_;  // series found by the active server, in its store
  bool advanced_ = false;                    // ParaView's filters are visible
  bool making_reader_ = false;
  QMetaObject::Connection time_;
  ClinicalViews views_;
  QObject lifetime_;  // its destructor ends the connections to ParaView
  ServerScan server_scan_;
  ScanLoader frame_loader_;
  ScanLoader loader_;  // last: its thread must end before the members that its callbacks use are destroyed
};

}  // namespace palpate::plugin

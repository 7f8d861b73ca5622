#pragma once

/// Fetches the voxels of a server's scan to this machine, which has the stylus: from a local copy with the same hash,
/// or else from the server, once in a session.

#include <pqPipelineSource.h>

#include <QCoreApplication>
#include <QObject>
#include <QPointer>

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "io/volume.h"
#include "plugin/paraview/client/jobs/scan_loader.h"
#include "plugin/paraview/wire/slices_message.h"

namespace palpate::plugin {

/// One scan at a time: a new request cancels the previous one. Everything runs on the UI thread, in steps of about a
/// tenth of a second, between which events are handled. No callback comes after cancel() or destruction.
class ServerScan : public QObject {
  Q_DECLARE_TR_FUNCTIONS(ServerScan)

 public:
  struct Found {
    std::shared_ptr<const io::Volume> volume;  ///< null: not available
    QString said;                              ///< why, or what the user should know about its source
  };
  using Progress = std::function<void(const QString& what, double done)>;
  using Done = std::function<void(const Found& found)>;

  /// `reader`: a PalpateDicomReader that is up to date; `frame`: of its series, from 0. Looks for a copy in these
  /// folders and files of this machine, in this order; missing ones are skipped.
  void get(pqPipelineSource& reader, int frame, std::vector<std::string> places, Progress progress, Done done);
  void cancel();
  bool is_busy() const { return done_ != nullptr; }
  /// Forgets fetched scans, because the server has gone.
  void forget() { fetched_.clear(); }

 private:
  using Step = void (ServerScan::*)();
  void next(Step step, int delay_ms = 0);
  void finish(const std::shared_ptr<const io::Volume>& volume, const QString& said);
  bool ask(SlicesAsked asked, SlicesAnswered& answered);
  void start();
  /// Fetches the next few slices. Returns true when all are complete; before that `step` will be called again.
  bool more(SlicesAsked::What what, Step step);
  bool append_checked(SlicesAnswered& answered, int count);

  void ask_head();
  void look_for_copies();
  void ask_hashes();
  void compare_copies();
  void fetch();

  QPointer<pqPipelineSource> reader_;
  int frame_ = 0;
  std::vector<std::string> places_;
  Progress progress_;
  Done done_;
  unsigned run_ = 0;  // number of the current run; steps of earlier runs are ignored
  io::Volume head_;
  std::vector<ScanCopy> copies_;
  bool differs_ = false;  // a local copy is not the server's scan
  std::vector<std::uint64_t> hashes_;
  io::Volume::Voxels voxels_;
  int slice_ = 0, at_a_time_ = 1;
  std::map<std::string, std::shared_ptr<const io::Volume>> fetched_;  // by hash
  ScanLoader loader_;  // last: its thread must end before the members that its callbacks use are destroyed
};

}  // namespace palpate::plugin

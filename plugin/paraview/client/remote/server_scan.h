#pragma once

/// The voxels of a scan that a server reads, for the stylus, which is on this machine: a copy here where there is the
/// same, by hash; else fetched from the server, once a session.

#include <pqPipelineSource.h>

#include <QObject>
#include <QPointer>

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "io/volume.h"
#include "plugin/paraview/client/scan/scan_loader.h"
#include "plugin/paraview/common/slices_message.h"

namespace palpate::plugin {

/// One scan at a time; a new one gives the last up. All on the UI thread, in steps of about a tenth of a second;
/// meanwhile events are handled. No callback comes after cancel() or destruction.
class ServerScan : public QObject {
 public:
  struct Found {
    std::shared_ptr<const io::Volume> volume;  ///< null: none could be had
    QString said;                              ///< why, or what a user should know of where it comes from
  };
  using Progress = std::function<void(const QString& what, double done)>;
  using Done = std::function<void(const Found& found)>;

  /// `reader`: a PalpateDicomReader that is up to date. Looks for a copy of its series in these folders and files of
  /// this machine, in this order; those that are not there are passed over.
  void get(pqPipelineSource& reader, std::vector<std::string> places, Progress progress, Done done);
  void cancel();
  /// Forgets what was fetched: the server has gone.
  void forget() { fetched_.clear(); }

 private:
  using Step = void (ServerScan::*)();
  void next(Step step, int delay_ms = 0);
  void finish(const std::shared_ptr<const io::Volume>& volume, const QString& said);
  bool ask(SlicesAsked asked, SlicesAnswered& answered);
  void start();
  /// The next few slices; true once all are there. Before that `step` will come again.
  bool more(SlicesAsked::What what, Step step);
  bool append_checked(SlicesAnswered& answered, int count);

  void ask_head();
  void look_for_copies();
  void ask_hashes();
  void compare_copies();
  void fetch();

  QPointer<pqPipelineSource> reader_;
  std::vector<std::string> places_;
  Progress progress_;
  Done done_;
  unsigned run_ = 0;  // counts up: a step of an earlier run is not taken
  io::Volume head_;
  std::vector<ScanCopy> copies_;
  bool differs_ = false;  // a copy here is not the server's scan
  std::vector<std::uint64_t> hashes_;
  io::Volume::Voxels voxels_;
  int slice_ = 0, at_a_time_ = 1;
  std::map<std::string, std::shared_ptr<const io::Volume>> fetched_;  // by hash
  ScanLoader loader_;  // last: its thread is to end before all that its callbacks use
};

}  // namespace palpate::plugin

#pragma once

/// Fetches the files of structures beside a server's scan to this machine, where they are felt. They are kept in a
/// folder that only the user may read, until the scan is closed. A scene uses the server's names for them
/// (plugin/structures/structure_files.h).

#include <pqPipelineSource.h>

#include <QObject>
#include <QPointer>
#include <QTemporaryDir>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include "plugin/paraview/wire/slices_message.h"
#include "plugin/paraview/wire/structure_files_message.h"

namespace palpate::plugin {

/// One scan at a time: a new request cancels the previous one. Everything runs on the UI thread, in small steps between
/// which events are handled. No callback comes after cancel() or destruction.
class ServerStructures : public QObject {
 public:
  /// `said`: why some files are missing; empty if none is.
  using Done = std::function<void(const std::vector<std::filesystem::path>& files, const QString& said)>;

  /// `reader`: a PalpateDicomReader that is up to date.
  void get(pqPipelineSource& reader, Done done);
  /// Also deletes the fetched files.
  void cancel();

 private:
  void next(void (ServerStructures::*step)());
  void ask_files();
  void ask_pieces();
  bool ask(const SlicesAsked& asked, SlicesAnswered& answered);
  void finish(const QString& said);

  QPointer<pqPipelineSource> reader_;
  Done done_;
  unsigned run_ = 0;  // number of the current run; steps of earlier runs are ignored
  std::unique_ptr<QTemporaryDir> folder_;
  std::vector<ServedFile> files_;
  std::vector<std::filesystem::path> places_;  // of each of them, on this machine
  std::vector<std::filesystem::path> here_;    // those that are complete
  std::size_t file_ = 0;
  int piece_ = 0;
};

}  // namespace palpate::plugin

#pragma once

/// Looks for structures in files and folders, in the background: each of them once for a scan.

#include <QString>

#include <filesystem>
#include <functional>
#include <memory>
#include <set>
#include <vector>

#include "io/structures/structure.h"
#include "io/volume.h"
#include "plugin/paraview/client/jobs/job.h"

namespace palpate::plugin {

class StructureFinder {
 public:
  struct Found {
    io::StructureCatalogue catalogue;
    bool asked = false;   ///< for them, by the user
    bool served = false;  ///< by a server
    QString problem;      ///< some of them are not here
  };
  /// Called when all that was asked for meanwhile has been looked into.
  using Take = std::function<void(const Found& found)>;
  using Fail = std::function<void(const QString& why)>;

  StructureFinder(Take take, Fail fail) : take_(std::move(take)), fail_(std::move(fail)) {}

  /// Null: there is none.
  void set_scan(std::shared_ptr<const io::Volume> scan);
  /// Another frame of the same scan: what was found stays.
  void set_frame(std::shared_ptr<const io::Volume> frame) { scan_ = std::move(frame); }
  void look_into(const std::vector<std::filesystem::path>& places);
  void look_into_asked(const std::vector<std::filesystem::path>& places);
  void look_into_served(const std::vector<std::filesystem::path>& places, const QString& problem);

 private:
  Take take_;
  Fail fail_;
  std::shared_ptr<const io::Volume> scan_;
  std::set<std::filesystem::path> looked_into_;
  std::vector<std::filesystem::path> waiting_;
  Found next_;  // but for its catalogue
  Job job_{Job::Newer::follows};
};

}  // namespace palpate::plugin

#pragma once

/// Finds structures in files and folders, in the background. Each file is read once for a scan.

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
    bool asked = false;   ///< the user asked for the search
    bool served = false;  ///< from a server
    QString problem;      ///< why some of them are missing
  };
  /// Called when all places requested so far have been searched.
  using Take = std::function<void(const Found& found)>;
  using Fail = std::function<void(const QString& why)>;

  StructureFinder(Take take, Fail fail) : take_(std::move(take)), fail_(std::move(fail)) {}

  /// Null: no scan.
  void set_scan(std::shared_ptr<const io::Volume> scan);
  /// Another frame of the same scan: the structures found remain.
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
  Found next_;  // except for its catalogue
  Job job_{Job::Newer::follows};
};

}  // namespace palpate::plugin

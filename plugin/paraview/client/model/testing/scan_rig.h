#pragma once

/// A scan model in a fake world, and its signals.

#include <gmock/gmock.h>

#include <QStringList>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "plugin/paraview/client/model/scan_model.h"
#include "plugin/paraview/client/model/testing/made_world.h"

namespace palpate::plugin {

inline io::Series series(const std::string& uid, const std::string& patient, int frames) {
  io::Series one;
  one.uid = uid;
  one.modality = "CT";
  one.usable = true;
  one.identity.patient_name = patient;
  one.frames_per_position = frames;
  return one;
}

inline FoundList folder(const std::string& path, const std::vector<io::Series>& all) {
  auto catalogue = std::make_shared<io::Catalogue>();
  catalogue->series = all;
  return {.path = path, .catalogue = catalogue};
}

inline std::shared_ptr<const io::Volume> voxels() {
  return std::make_shared<const io::Volume>();
}

/// Follows the model as panel and views do, and records its signals.
struct ScanModelFollowed : ::testing::Test {
  ScanModelFollowed() {
    QObject::connect(&model, &ScanModel::leaving, [this] { reported << QStringLiteral("leaving"); });
    QObject::connect(&model, &ScanModel::out_of_reach, [this](const QString& why) {
      reported << QStringLiteral("out of reach ") + why;
      felt = false;
    });
    QObject::connect(&model, &ScanModel::scan_shown, [this](const ScanHandle& scan, Brought brought) {
      reported << (brought == Brought::by_undo ? QStringLiteral("restored ") : QStringLiteral("shown ")) +
                      QString::fromStdString(scan.of.name);
      felt = true;
    });
    QObject::connect(&model, &ScanModel::frame_shown,
                     [this](const ScanHandle& scan) { reported << QStringLiteral("frame %1").arg(scan.frame); });
  }
  QStringList take_reported() { return std::exchange(reported, {}); }

  /// Opens a folder of one series with so many frames, up to its views.
  void show(const std::string& name, int frames = 1, const std::string& patient = "A") {
    model.open("/" + name);
    world.found_.back()(folder("/" + name, {series(name, patient, frames)}), {});
    world.loaded_.back()(voxels(), {});
    world.made_.back()({});
    world.take_asked();
    take_reported();
  }

  MadeWorld world;
  ScanModel model{world};
  QStringList reported;
  bool felt = false;
};

}  // namespace palpate::plugin

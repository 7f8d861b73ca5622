#pragma once

/// A running correction of a liver; the test answers its searches in the scan.

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "modes/scene/scene_json.h"
#include "plugin/paraview/client/model/correction_model.h"
#include "plugin/paraview/client/model/testing/made_text.h"

namespace palpate::plugin::testing {

struct Correcting : ::testing::Test {
  Correcting() {
    scene.open(modes::Scene{});
    liver.file = "/study/liver.dcm";
    liver.number = 3;
    liver.name = "liver";
    model.set_find([this](const io::Structure* structure, auto done) {
      if (!structure) ++not_wanted;
      if (structure) asked.push_back(std::move(done));
    });
    QObject::connect(&model, &CorrectionModel::place_wanted,
                     [this](const io::DoubtfulPlace& place) { gone_to.push_back(place.position_mm.x); });
  }

  void stroke(std::vector<io::Vec3> places) {
    model.press(places.front());
    for (const io::Vec3& place : places) model.move(place);
    model.let_go();
  }
  std::vector<std::string> kinds() const {
    std::vector<std::string> names;
    for (const io::Edit& edit : model.edits()) names.emplace_back(io::name_of(edit));
    return names;
  }
  /// The edits in the pipeline's text.
  std::vector<io::Edit> kept_edits() const {
    const modes::Scene read = modes::scene_from_json(kept.text("Scene"), "scene");
    return read.structures.empty() ? std::vector<io::Edit>() : read.structures.front().edits;
  }
  const modes::Mode* snap() const {
    for (const modes::Mode& mode : scene.scene().modes) {
      if (mode.name == "Scan's edge at liver") return &mode;
    }
    return nullptr;
  }
  std::vector<modes::Mode> planes() const {
    std::vector<modes::Mode> found;
    for (const modes::Mode& mode : scene.scene().modes) {
      if (mode.type == "landmark") found.push_back(mode);
    }
    return found;
  }
  void look_beside() {
    model.set_look_beside([this](std::vector<io::Vec3> places, double within_mm, auto done) {
      if (!places.empty()) beside.push_back({std::move(places), within_mm, std::move(done)});
    });
  }
  static io::DoubtfulPlaces three() {
    io::DoubtfulPlaces found;
    for (const double x : {100.0, 200.0, 300.0}) {
      found.places.push_back({.position_mm = {x, 0, 0}, .normal = {1, 0, 0}, .area_mm2 = x});
    }
    return found;
  }

  MadeText kept;
  SceneModel scene{kept};
  io::Structure liver;
  CorrectionModel model{scene};
  std::vector<std::function<void(io::DoubtfulPlaces)>> asked;
  struct Beside {
    std::vector<io::Vec3> places;
    double within_mm;
    std::function<void(const CorrectionModel::Edges&)> done;
  };
  std::vector<Beside> beside;
  int not_wanted = 0;
  std::vector<double> gone_to;
};

/// As in the panel: each step waits until its files are read.
struct CorrectingSlowly : Correcting {
  CorrectingSlowly() {
    scene.set_read([this](const modes::Scene&, auto done) {
      if (std::exchange(is_read, false)) return false;
      reading.push_back(std::move(done));
      return true;
    });
  }
  void all_is_read() {
    while (!reading.empty()) {
      is_read = true;
      std::exchange(reading, {}).back()({});
    }
  }

  bool is_read = false;  // for the next change
  std::vector<std::function<void(const QString&)>> reading;
};

}  // namespace palpate::plugin::testing

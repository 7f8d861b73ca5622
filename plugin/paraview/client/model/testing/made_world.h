#pragma once

/// A fake ScanWorld: it records requests, and the test answers them when it wants to.

#include <deque>
#include <stdexcept>
#include <string>
#include <vector>

#include "plugin/paraview/client/model/scan_world.h"

namespace palpate::plugin {

class MadeWorld : public ScanWorld {
 public:
  bool is_remote() const override { return remote; }
  void find(const std::string& path, Progress progress, Found found) override {
    asked.push_back("find " + path);
    found_.push_back(std::move(found));
    progress_ = std::move(progress);
  }
  void load(const io::Series& series, int /*frame*/, Progress progress, Loaded loaded) override {
    asked.push_back("load " + series.uid);
    loaded_.push_back(std::move(loaded));
    progress_ = std::move(progress);
  }
  void stop() override { ++stopped; }
  void load_frame(const io::Series& /*series*/, int frame, const io::Filter& filter, Loaded loaded) override {
    filters.push_back(filter);
    asked.push_back("frame " + std::to_string(frame));
    frames_.push_back(std::move(loaded));
  }
  void stop_frames() override { ++frames_stopped; }
  void show(const SeriesRef& of, int /*frame*/, Made made) override {
    asked.push_back("show " + of.name);
    made_.push_back(std::move(made));
    view.in_pipeline = view.seen = true;
  }
  void adopt() override {
    asked.emplace_back("adopt");
    if (!not_adopted.empty()) throw std::runtime_error(not_adopted);
    view.in_pipeline = view.seen = true;
  }
  void close() override {
    asked.emplace_back("close");
    view = {};
  }
  void abandon() override {
    asked.emplace_back("abandon");
    view = {};
  }
  void fetch(const SeriesRef& of, std::optional<int> frame, const io::Filter& filter, std::vector<std::string> places,
             Progress progress, Fetched fetched) override {
    filters.push_back(filter);
    asked.push_back("fetch " + of.name + (frame ? " " + std::to_string(*frame) : ""));
    looked_in = std::move(places);
    fetched_.push_back(std::move(fetched));
    progress_ = std::move(progress);
  }
  void stop_fetching() override { ++fetching_stopped; }
  void show_frame(int frame) override {
    asked.push_back("time " + std::to_string(frame));
    time = frame;
  }
  int frame_in_views(int frames) const override { return time < frames ? time : frames - 1; }
  ViewFacts facts() const override { return view; }
  QString notes(const SeriesRef& of, const io::Volume* /*volume*/) const override {
    return QStringLiteral("notes on ") + QString::fromStdString(of.name);
  }

  /// The requests since the last call.
  std::vector<std::string> take_asked() { return std::exchange(asked, {}); }

  bool remote = false;
  std::string not_adopted;  // why; empty: it is
  int time = 0;
  int stopped = 0, frames_stopped = 0, fetching_stopped = 0;
  ViewFacts view;
  std::vector<std::string> asked, looked_in;
  std::vector<io::Filter> filters;  // of what was to be read through one
  // All requests so far, the latest last; a test may also answer an old one.
  std::deque<Found> found_;
  std::deque<Loaded> loaded_, frames_;
  std::deque<Made> made_;
  std::deque<Fetched> fetched_;
  Progress progress_;
};

}  // namespace palpate::plugin

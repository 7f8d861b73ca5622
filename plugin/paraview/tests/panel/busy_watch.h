#pragma once

/// Measures how long the main thread is busy at a stretch, with and without ParaView's own rendering.

#include <vtkCallbackCommand.h>
#include <vtkNew.h>

#include <QElapsedTimer>
#include <QObject>

#include <algorithm>
#include <vector>

class pqRenderView;
class vtkObject;

class BusyWatch : public QObject {
 public:
  BusyWatch();
  ~BusyWatch() override;

  /// ms, longest first, of all stretches so far, without rendering.
  std::vector<double> without_rendering() const;
  double longest_with_rendering_ms() const;
  /// In chronological order, rendering included.
  struct Stretch {
    double began_ms = 0;  ///< since the watch was made
    double took_ms = 0;
    double processor_ms = 0;  ///< of the main thread; less than elapsed if it waited or other programs ran
    double rendering_ms = 0;  ///< the rendering's part of that
  };
  const std::vector<Stretch>& stretches() const { return stretches_; }
  /// Processor time between consecutive events, ms, longest first: the time for which nothing else could run.
  std::vector<double> events_ms() const;
  bool eventFilter(QObject* to, QEvent* event) override;

 private:
  static void rendered(vtkObject* window, unsigned long event, void* self, void*);
  void watch(pqRenderView& view);
  void end();
  void end_event();

  QElapsedTimer clock_;
  double began_ms_ = 0, began_processor_ms_ = 0, render_began_ms_ = 0, rendering_ms_ = 0;
  bool busy_ = false;
  std::vector<Stretch> stretches_;
  double event_began_ms_ = 0;
  std::vector<double> events_ms_;
  vtkNew<vtkCallbackCommand> rendering_;
};

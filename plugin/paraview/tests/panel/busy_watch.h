#pragma once

/// How long the program's main thread is busy at a stretch, with and without ParaView's own rendering.

#include <QElapsedTimer>
#include <QObject>

#include <algorithm>
#include <vector>

class vtkObject;

class BusyWatch : public QObject {
 public:
  BusyWatch();
  ~BusyWatch() override;

  /// ms, most first, of the stretches since it was made: rendering taken out.
  std::vector<double> without_rendering() const;
  double longest_with_rendering_ms() const { return longest_ms_; }

 private:
  static void rendered(vtkObject* window, unsigned long event, void* self, void*);
  void end();

  QElapsedTimer clock_;
  double began_ms_ = 0, render_began_ms_ = 0, rendering_ms_ = 0, longest_ms_ = 0;
  bool busy_ = false;
  std::vector<double> stretches_;
};

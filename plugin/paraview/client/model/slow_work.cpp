#include "plugin/paraview/client/model/slow_work.h"

#include <QCoreApplication>

namespace palpate::plugin {
namespace {

constexpr double long_s = 0.5;     // shorter work is not what a watch of 2 s waits for
constexpr double short_ago_s = 4;  // the panel tells of it when it answers again

double since(SlowWork::Time then, SlowWork::Time now) {
  return std::chrono::duration<double>(now - then).count();
}

}  // namespace

void SlowWork::note(const QString& what, double seconds, Time ended) {
  if (seconds < long_s) return;
  const bool is_old = !slowest_ || since(slowest_->ended, ended) > short_ago_s;
  if (is_old || seconds >= slowest_->seconds) slowest_ = Work{what, seconds, ended};
}

QString SlowWork::in_words(Time now) const {
  if (!slowest_ || since(slowest_->ended, now) > short_ago_s) return {};
  return QCoreApplication::translate("SessionState", "%1 took %2 s")
      .arg(slowest_->what)
      .arg(slowest_->seconds, 0, 'f', 1);
}

}  // namespace palpate::plugin

#pragma once

/// Asks before an action of ParaView would discard the user's work: the window's close button, File > Exit, File > Load
/// State, a recent state file, a state file dropped on the window, and Edit > Reset Session.

#include <QObject>
#include <QPointer>

#include <functional>

class QAction;
class QMainWindow;
class pqRecentFilesMenu;
class pqServer;

namespace palpate::plugin {

class HostGuards : public QObject {
  Q_OBJECT

 public:
  using May = std::function<bool()>;

  /// `may_end`: whether ParaView may end; `may_replace`: whether everything that is open may be replaced. `still_here`
  /// is called if ParaView's session is the same after an action that was allowed: a file dialog was cancelled, or a
  /// state was loaded.
  HostGuards(QMainWindow& window, May may_end, May may_replace, std::function<void()> still_here,
             QObject* parent = nullptr);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void guard_actions();
  void guard_recent(pqRecentFilesMenu& recent);
  void guard(QAction& action, QObject& done_by, const May& may, const std::function<void()>& go_on);
  void look_afterwards(const QPointer<pqServer>& before);

  QMainWindow& window_;
  May may_end_, may_replace_;
  std::function<void()> still_here_;
};

}  // namespace palpate::plugin

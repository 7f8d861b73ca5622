#pragma once

/// Watches the connection to ParaView's server.

#include <QObject>
#include <QTimer>

#include <vector>

#include <vtkWeakPointer.h>

class pqServer;
class vtkSMSession;

namespace palpate::plugin {

class ServerWatch : public QObject {
  Q_OBJECT

 public:
  explicit ServerWatch(QObject* parent = nullptr);
  ~ServerWatch() override;

  /// Asks the server twice a second while a stylus is held. ParaView itself notices a lost server only at its next
  /// request, or after a minute; that is too late.
  void be_attentive(bool on);

 signals:
  /// The connection broke. Emitted before ParaView reacts, which asks whether to save the state, and ends.
  void lost();
  /// ParaView is about to leave a server normally: everything on it will be removed.
  void leaving();

 private:
  void watch(pqServer& server);
  void on_lost() { emit lost(); }

  struct Watched {
    vtkWeakPointer<vtkSMSession> session;
    unsigned long tag;
  };
  std::vector<Watched> watched_;
  QTimer speaking_;
};

}  // namespace palpate::plugin

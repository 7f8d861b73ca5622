#pragma once

/// Whether the server that ParaView works with is still there.

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

  /// ParaView itself notices only at its next request, or after a minute. While a stylus is held that is too late, so
  /// the server is asked twice a second.
  void be_attentive(bool on);

 signals:
  /// The connection broke. Emitted before ParaView reacts: ParaView asks whether to save the state, and ends.
  void lost();
  /// ParaView is about to leave a server in good order: everything that is on it goes.
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

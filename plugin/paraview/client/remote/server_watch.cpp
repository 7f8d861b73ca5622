#include "plugin/paraview/client/remote/server_watch.h"

#include <pqApplicationCore.h>
#include <pqServer.h>
#include <pqServerManagerModel.h>
#include <vtkPVSessionBase.h>
#include <vtkSMSession.h>

#include "plugin/paraview/client/remote/server_series.h"

namespace palpate::plugin {

ServerWatch::ServerWatch(QObject* parent) : QObject(parent) {
  auto* const model = pqApplicationCore::instance()->getServerManagerModel();
  for (pqServer* const server : model->findItems<pqServer*>()) watch(*server);
  connect(model, &pqServerManagerModel::serverAdded, this, [this](pqServer* server) { watch(*server); });
  connect(model, &pqServerManagerModel::aboutToRemoveServer, this, [this] { emit leaving(); });
  connect(&speaking_, &QTimer::timeout, this, [] {
    if (pqServer* const server = remote_server()) QMetaObject::invokeMethod(server, "heartBeat", Qt::DirectConnection);
  });
}

ServerWatch::~ServerWatch() {
  for (const Watched& one : watched_) {
    if (one.session) one.session->RemoveObserver(one.tag);
  }
}

void ServerWatch::watch(pqServer& server) {
  if (!server.isRemote()) return;
  // Not pqServer's signal: ParaView's own slot, which ends the program, is connected to it before ours could be.
  constexpr float first = 100;
  vtkSMSession& session = *server.session();
  watched_.push_back(
      {&session, session.AddObserver(vtkPVSessionBase::ConnectionLost, this, &ServerWatch::on_lost, first)});
}

void ServerWatch::be_attentive(bool on) {
  constexpr int often_ms = 500;
  on ? speaking_.start(often_ms) : speaking_.stop();
}

}  // namespace palpate::plugin

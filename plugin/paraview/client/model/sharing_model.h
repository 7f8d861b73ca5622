#pragma once

/// Shares the panel's session with 3D Slicer and other clients of OpenIGTLink. Requests of clients go through the
/// models, like the panel's own: they can be undone, and they can neither turn the force on nor raise a limit.

#include <QObject>
#include <QString>
#include <QTimer>

#include <cstddef>
#include <memory>

#include "plugin/openigtlink/job.h"
#include "plugin/openigtlink/server.h"
#include "plugin/openigtlink/sharing.h"
#include "plugin/paraview/client/model/marks_model.h"
#include "plugin/paraview/client/model/scene_model.h"
#include "plugin/paraview/client/model/session_controller.h"

namespace palpate::plugin {

class SharingModel : public QObject {
  Q_OBJECT

 public:
  /// The arguments must outlive it.
  SharingModel(SessionController& session, SceneModel& scene, MarksModel& marks, QObject* parent = nullptr);

  /// Listens on this machine. Returns why that is impossible; empty: it listens.
  QString turn_on(int port);
  /// What is being prepared is cancelled, and ends in the background.
  void turn_off();
  bool is_on() const { return sharing_ != nullptr; }
  /// The port on which it listens; 0: none.
  int port() const { return server_ ? server_->port() : 0; }
  std::size_t clients() const { return clients_; }

 signals:
  /// Sharing was turned on or off, or the number of clients has changed.
  void changed();
  /// A client asks for the scan in a folder.
  void folder_wanted(const QString& folder);

 private:
  void look();
  void send_marks();
  void take_scene(const modes::Scene& scene, const PreparedScene& prepared);
  void take_marks(const std::vector<igtl::Point>& points);

  SessionController& session_;
  SceneModel& scene_;
  MarksModel& marks_;
  std::unique_ptr<igtl::Server> server_;
  std::optional<igtl::Received> received_;  // kept from the first time on: scenes name its files
  igtl::JobThreads threads_;
  std::unique_ptr<igtl::Sharing> sharing_;
  std::size_t clients_ = 0;
  QTimer looks_;
};

}  // namespace palpate::plugin

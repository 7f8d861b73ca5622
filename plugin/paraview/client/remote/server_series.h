#pragma once

/// The series that a server finds in one of its folders.

#include <vtkSmartPointer.h>

#include <memory>
#include <string>
#include <vector>

#include "plugin/paraview/client/model/scan_state.h"

class pqServer;
class vtkSMSourceProxy;

namespace palpate::plugin {

struct ServerSeries {
  std::vector<SeriesOnServer> series;
  /// Keeps what was found in the server's store, so that the reader to come need not look again.
  vtkSmartPointer<vtkSMSourceProxy> finder;
};

/// The active server where it is another program than this one; null if not.
pqServer* remote_server();

/// Looks in a folder of the server, or in the folder of a file there. Blocks while the server reads headers. Throws
/// std::runtime_error where the server has no Palpate plug-in, or finds nothing.
std::unique_ptr<ServerSeries> find_on_server(pqServer& server, const std::string& path);

/// Whether the server can be asked now: ParaView handles events, and so our timers, in the middle of its own requests.
bool is_free(pqServer& server);

/// What a user should know of the series that a reader shows.
std::vector<std::string> messages_of(vtkSMSourceProxy& reader);

}  // namespace palpate::plugin

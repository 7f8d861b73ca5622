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
  /// Keeps the result in the server's store, so that the reader need not search again.
  vtkSmartPointer<vtkSMSourceProxy> finder;
};

/// The active server if it is a separate program; otherwise null.
pqServer* remote_server();

/// Searches a folder of the server, or the folder of a file there. Blocks while the server reads headers. Throws
/// std::runtime_error if the server has no Palpate plug-in, or finds nothing.
std::unique_ptr<ServerSeries> find_on_server(pqServer& server, const std::string& path);

/// Whether a request to the server is possible now: ParaView handles events, and so our timers, during its own
/// requests.
bool is_free(pqServer& server);

/// Messages for the user about the series that a reader shows.
std::vector<std::string> messages_of(vtkSMSourceProxy& reader);

}  // namespace palpate::plugin

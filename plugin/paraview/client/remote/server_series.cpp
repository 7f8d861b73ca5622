#include "plugin/paraview/client/remote/server_series.h"

#include <pqActiveObjects.h>
#include <pqServer.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMSessionClient.h>
#include <vtkSMSessionProxyManager.h>
#include <vtkSMSourceProxy.h>

#include "plugin/messages/messages.h"

namespace palpate::plugin {
namespace {

std::vector<std::string> texts_of(vtkSMProxy& proxy, const char* name) {
  vtkSMPropertyHelper helper(&proxy, name);
  std::vector<std::string> texts;
  for (unsigned n = 0; n < helper.GetNumberOfElements(); ++n) texts.emplace_back(helper.GetAsString(n));
  return texts;
}

}  // namespace

pqServer* remote_server() {
  pqServer* const server = pqActiveObjects::instance().activeServer();
  return server && server->isRemote() ? server : nullptr;
}

std::unique_ptr<ServerSeries> find_on_server(pqServer& server, const std::string& path) {
  auto found = std::make_unique<ServerSeries>();
  found->finder = vtkSmartPointer<vtkSMSourceProxy>::Take(
      vtkSMSourceProxy::SafeDownCast(server.proxyManager()->NewProxy("sources", "PalpateDicomReader")));
  if (!found->finder || !found->finder->GetProperty("SeriesUsable")) {
    throw Refusal(say("server-has-no-palpate-plug"));
  }
  vtkSMSourceProxy& finder = *found->finder;
  vtkSMPropertyHelper(&finder, "ShowMessages", true).Set(0);  // of a series that nobody has chosen
  vtkSMPropertyHelper(&finder, "FileName").Set(path.c_str());
  finder.UpdateVTKObjects();
  finder.UpdatePipelineInformation();
  const auto names = texts_of(finder, "SeriesUids");
  const auto labels = texts_of(finder, "SeriesLabels");
  const vtkSMPropertyHelper usable(&finder, "SeriesUsable");
  for (std::size_t n = 0; n < names.size() && n < labels.size(); ++n) {
    found->series.push_back({names[n], labels[n], usable.GetAsInt(static_cast<unsigned>(n)) != 0});
  }
  if (found->series.empty()) {
    throw Refusal(say("server-finds-no-image-series-there"));
  }
  return found;
}

bool is_free(pqServer& server) {
  auto* const session = vtkSMSessionClient::SafeDownCast(server.session());
  return session && session->IsNotBusy() && !server.isProgressPending();
}

std::vector<std::string> messages_of(vtkSMSourceProxy& reader) {
  reader.UpdatePropertyInformation(reader.GetProperty("Messages"));
  return texts_of(reader, "Messages");
}

}  // namespace palpate::plugin

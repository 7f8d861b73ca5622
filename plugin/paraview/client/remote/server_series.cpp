#include "plugin/paraview/client/remote/server_series.h"

#include <pqActiveObjects.h>
#include <pqServer.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMSessionProxyManager.h>
#include <vtkSMSourceProxy.h>

#include <QCoreApplication>

#include <stdexcept>

namespace palpate::plugin {
namespace {

std::runtime_error refusal(const char* text) {
  return std::runtime_error(QCoreApplication::translate("ServerSeries", text).toStdString());
}

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
    throw refusal("The server has no Palpate plug-in of this version: load Palpate.so there (Tools > Manage Plugins).");
  }
  vtkSMSourceProxy& finder = *found->finder;
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
    throw refusal(
        "The server finds no image series there: choose a folder that it can read, by the server's own names.");
  }
  return found;
}

std::vector<std::string> messages_of(vtkSMSourceProxy& reader) {
  reader.UpdatePropertyInformation(reader.GetProperty("Messages"));
  return texts_of(reader, "Messages");
}

}  // namespace palpate::plugin

#include "plugin/paraview/client/model/scan_state.h"

#include <algorithm>

#include "plugin/app/scan_choice.h"

namespace palpate::plugin {

std::size_t FoundList::count() const {
  return catalogue ? scan_count(*catalogue) : on_server.size();
}

std::optional<std::size_t> FoundList::only() const {
  if (catalogue) return only_scan(*catalogue);
  if (std::ranges::count_if(on_server, &SeriesOnServer::usable) != 1) return std::nullopt;
  return static_cast<std::size_t>(std::ranges::find_if(on_server, &SeriesOnServer::usable) - on_server.begin());
}

SeriesRef FoundList::at(std::size_t series) const {
  if (!catalogue) {
    const SeriesOnServer& one = on_server.at(series);
    return {.path = path, .name = one.name, .label = QString::fromStdString(one.label)};
  }
  return {.path = path,
          .name = scan_name(*catalogue, series),
          .label = QString::fromStdString(scan_label(scan_at(*catalogue, series))),
          .catalogue = catalogue,
          .series = series};
}

}  // namespace palpate::plugin

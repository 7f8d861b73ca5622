#pragma once

#include <QObject>

#include <functional>
#include <string>

namespace palpate::plugin {

/// Opens the folder that the command line of `plugin/run view` names, once ParaView has a server to show it with. With a
/// folder or without one ParaView's welcome is left out: the start page stands there. Both end with `parent`.
void open_first_folder(QObject& parent, const std::function<void(const std::string&)>& open);

}  // namespace palpate::plugin

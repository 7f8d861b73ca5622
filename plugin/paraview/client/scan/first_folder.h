#pragma once

#include <QObject>

#include <functional>
#include <string>

namespace palpate::plugin {

/// A folder named on the command line of `plugin/run view`: opened once ParaView has a server to show it with, without
/// ParaView's welcome in front of it. `parent` ends the wait.
void open_first_folder(QObject& parent, const std::function<void(const std::string&)>& open);

}  // namespace palpate::plugin

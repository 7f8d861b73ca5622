#pragma once

#include <QObject>

#include <functional>
#include <string>

namespace palpate::plugin {

/// Opens the folder on the command line of `plugin/run view` as soon as ParaView has a server. ParaView's welcome
/// dialog is skipped, because the start page replaces it. Both end with `parent`.
void open_first_folder(QObject& parent, const std::function<void(const std::string&)>& open);

}  // namespace palpate::plugin

#pragma once

class QMainWindow;

namespace palpate::plugin {

/// Makes ParaView's *Properties* and *Color Map Editor* follow the active object only while they are visible. Otherwise
/// they would rebuild their widgets for every view and representation of a scan even while hidden.
void follow_while_seen(QMainWindow& window);

}  // namespace palpate::plugin

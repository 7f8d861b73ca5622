#pragma once

class QMainWindow;

namespace palpate::plugin {

/// ParaView's *Properties* and *Color Map Editor* follow what is active only while they are seen. Hidden, they would
/// build their widgets anew for every view and representation that a scan is shown in.
void follow_while_seen(QMainWindow& window);

}  // namespace palpate::plugin

#pragma once

/// Palpate in ParaView's help menu: the guide, which needs no network, and information about this program.

class QMainWindow;

namespace palpate::plugin {

/// From then on F1 opens the guide.
void add_help(QMainWindow& window);

}  // namespace palpate::plugin

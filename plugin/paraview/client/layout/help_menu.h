#pragma once

/// Palpate in ParaView's help menu: the guide, without a network, and what this program is.

class QMainWindow;

namespace palpate::plugin {

/// F1 opens the guide from then on.
void add_help(QMainWindow& window);

}  // namespace palpate::plugin

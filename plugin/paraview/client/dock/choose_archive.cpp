#include <exception>
#include <utility>
#include <vector>

#include "plugin/app/archive_settings.h"
#include "plugin/messages/messages.h"
#include "plugin/paraview/client/dock/parts.h"
#include "plugin/paraview/client/scan/scan_section.h"
#include "plugin/paraview/client/widgets/fold.h"
#include "plugin/paraview/client/words.h"

// Shows what will be sent, marks or an outline, before it is sent.

namespace palpate::plugin {

/// None if no archive is configured (the user is told how to add one), or if the user cancels.
std::optional<io::Archive> PanelParts::choose_archive(const io::Series& of, const SendDialog::Content& content,
                                                      const std::function<void(const QString&)>& tell_problem) {
  std::vector<io::Archive> archives;
  try {
    archives = read_archives();
  } catch (const std::exception& error) {
    tell_problem(QString::fromUtf8(error.what()));
    return std::nullopt;
  }
  if (archives.empty()) {
    tell_problem(words(say("no-archive-here-yet")));
    column->scan_fold->set_open(true);
    column->scan->show_archive();
    return std::nullopt;
  }
  SendDialog dialog(of, content, std::move(archives), &dock);
  if (dialog.exec() != QDialog::Accepted) return std::nullopt;
  return dialog.archive();
}

}  // namespace palpate::plugin

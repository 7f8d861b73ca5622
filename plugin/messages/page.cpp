#include "plugin/messages/page.h"

#include "device/messages.h"
#include "io/messages.h"
#include "modes/messages.h"
#include "plugin/messages/messages.h"
#include "plugin/messages/messages_of_openigtlink.h"
#include "solver/messages.h"

namespace palpate::plugin {

const std::vector<MessageSection>& message_sections() {
  static const std::vector<MessageSection> sections{
      {"Files and series",
       "What is wrong with a single file stands in the list of `palpate info --all` (\"set apart\"), or among a "
       "series' "
       "notes; the rest of the\nfolder is used. A damaged file is damaged at its source, or was cut on "
       "its "
       "way: compare its size with the size at the source, then send it again.",
       {io::messages::series, messages::choices}},
      {"Archives",
       "These are the messages of `palpate archive`, `find`, `fetch`, `send`, `marks` and `export`. A message names "
       "the archive as you do. "
       "Where "
       "a message quotes a status, it\nis the archive's own answer (DICOM PS3.7 Annex C). No message holds a patient's "
       "name or id.",
       {io::messages::archives, messages::kept_archives}},
      {"Structures",
       "What is wrong with a file stands in the list of `palpate structures` (\"set apart\"), or as a note of the "
       "structure.",
       {io::messages::structures, messages::scene_structures}},
      {"Scenes",
       "Each message begins with the place: the file, then the key, such as `modes[2].strength_n`. The keys are in\n"
       "[modes/README.md](../../modes/README.md).",
       {modes::messages::scenes}},
      {"Balances (`palpate solve`)",
       "The answer's `error` has one line for each line that was refused.",
       {messages::balances, solver::messages::balances}},
      {"Sessions, strokes and recordings", "", {messages::sessions}},
      {"OpenIGTLink (`palpate serve`)",
       "If something that a client sends is refused, the answer is a STATUS with this text; `palpate serve` says it on "
       "stderr, "
       "too.",
       {messages::openigtlink}},
      {"Styluses",
       "What happens to the force in each of these faults, and how fast, is described in\n"
       "[device/README.md](../../device/README.md#what-happens-in-each-fault). A test checks it.",
       {device::messages::styluses}},
      {"ParaView and the panel",
       "What the reader and the filters refuse is in ParaView's messages; what the panel refuses is shown in the "
       "section "
       "in which you asked for it.",
       {messages::paraview}},
  };
  return sections;
}

namespace {

constexpr std::string_view head = R"(# Messages: what happened, why, and what to do

Every error and warning of Palpate, on the command line, in ParaView and in the panel. `{}` stands for what varies: a file, a number,
a name. An empty cell means that the message itself says it. This page is made from the tables in the sources (`messages.h` of each folder):
`ninja -C build messages_page` writes it.

On the command line a message begins with `palpate: ` and goes to stderr. The exit code says what happened: 0 done, 1 something in
the input was refused, 2 wrong usage (`--help` on every command), 3 a fault of the program.
)";

std::string in_backticks(std::string_view text) {
  const bool holds_one = text.find('`') != std::string_view::npos;
  return (holds_one ? "`` " : "`") + std::string(text) + (holds_one ? " ``" : "`");
}

std::string line_of(const MessageRow& row) {
  std::string line = "| ";
  for (const Message& message : row.messages) {
    if (message.id.empty()) continue;
    line += (&message == row.messages ? "" : "<br>") + in_backticks(message.text);
  }
  return line.append(" | ").append(row.why).append(" | ").append(row.what_to_do).append(" |\n");
}

}  // namespace

std::string message_page() {
  std::string page(head);
  for (const MessageSection& section : message_sections()) {
    page.append("\n## ").append(section.title).append("\n\n");
    if (!section.introduction.empty()) page.append(section.introduction).append("\n\n");
    page += "| message | why | what to do |\n|---|---|---|\n";
    for (const auto& table : section.tables) {
      for (const MessageRow& row : table) page += line_of(row);
    }
  }
  return page;
}

}  // namespace palpate::plugin

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
       "notes; the rest of the\nfolder is used. A file that came damaged is damaged where it came from or was cut on "
       "its "
       "way: compare its size there, then send it again.",
       {io::messages::series, messages::choices}},
      {"Archives",
       "Of `palpate archive`, `find`, `fetch`, `send`, `marks` and `export`. A message names the archive as you do. "
       "Where "
       "one quotes a status, it\nis the archive's own answer (DICOM PS3.7 Annex C). None holds a patient's name or id.",
       {io::messages::archives, messages::kept_archives}},
      {"Structures",
       "What is wrong with a file stands in the list of `palpate structures` (\"set apart\"), or as a note of the "
       "structure.",
       {io::messages::structures, messages::scene_structures}},
      {"Scenes",
       "Every one begins with where: the file, then the key, such as `modes[2].strength_n`. The keys are in\n"
       "[modes/README.md](../../modes/README.md).",
       {modes::messages::scenes}},
      {"Balances (`palpate solve`)",
       "In the answer's `error`, one line for each line that was refused.",
       {messages::balances, solver::messages::balances}},
      {"Sessions, strokes and recordings", "", {messages::sessions}},
      {"OpenIGTLink (`palpate serve`)",
       "What a client sends and is refused is answered by a STATUS with this text; `palpate serve` says it on stderr, "
       "too.",
       {messages::openigtlink}},
      {"Styluses",
       "What becomes of the force in each of these faults, and how fast, is in\n"
       "[device/README.md](../../device/README.md#what-every-fault-comes-to) and its own test.",
       {device::messages::styluses}},
      {"ParaView and the panel",
       "What the reader and the filters refuse is in ParaView's messages; what the panel refuses stands in the section "
       "that was asked.",
       {messages::paraview}},
  };
  return sections;
}

namespace {

constexpr std::string_view head = R"(# Messages: what happened, why, and what to do

Every error and warning of Palpate, on the command line, in ParaView and in the panel. `{}` stands for what differs: a file, a number,
a name. An empty cell: the message says it. This page is made of the tables in the sources (`messages.h` of each folder):
`ninja -C build messages_page` writes it.

On the command line a message begins with `palpate: ` and goes to stderr. The exit code says whose turn it is: 0 done, 1 something in
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

#pragma once

/// The subcommands of `palpate`, mostly one file each.

namespace CLI {
class App;
}

namespace palpate::plugin {

// Each adds its subcommand to the program; the subcommand's callback does the work, prints to stdout and throws
// InputRefused or WrongUsage.
void add_info(CLI::App& program);
void add_structures(CLI::App& program);
void add_sample(CLI::App& program);
void add_suggest(CLI::App& program);
void add_plan(CLI::App& program);
void add_profile(CLI::App& program);
void add_probe(CLI::App& program);
void add_record(CLI::App& program);
void add_serve(CLI::App& program);
void add_replay(CLI::App& program);
void add_compare(CLI::App& program);
void add_compare_structures(CLI::App& structures);  ///< a subcommand of `structures`
void add_correct(CLI::App& program);
void add_suspects(CLI::App& program);
void add_solve(CLI::App& program);
void add_devices(CLI::App& program);
void add_archive(CLI::App& program);
void add_find(CLI::App& program);
void add_fetch(CLI::App& program);
void add_send(CLI::App& program);
void add_marks(CLI::App& program);
void add_export(CLI::App& program);

}  // namespace palpate::plugin

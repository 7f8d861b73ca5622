"""What plugin/run mutate prints: the outcome of each slip and the table, and what an earlier run printed."""

import pathlib
import re

from mutants import code_of

SEEN = ("seen", "timed out")
SURVIVED = ("survived", "not run", "unsteady")  # the last at tests that fail without the slip, too


class Account:
    """How many slips had which outcome, by module and operator."""

    def __init__(self):
        self.counts = {}

    def add(self, module, operator, outcome):
        self.counts[module, operator, outcome] = self.counts.get((module, operator, outcome), 0) + 1

    def tell(self, mutant, outcome):
        self.add(mutant.module, mutant.name, outcome)
        print(f"{outcome}: {mutant if outcome in SURVIVED else mutant.title()}", flush=True)

    def repeat(self, line):
        """What another run told of a slip that is not judged again."""
        outcome, module, _, _, operator = re.split(r": |(?<=\w):(?=\d)", line)
        self.add(module, operator, outcome)
        print(line)

    def count(self, *outcomes, module=None, operator=None):
        return sum(count for (m, o, outcome), count in self.counts.items()
                   if outcome in outcomes and module in (None, m) and operator in (None, o))

    def table(self):
        """By module, and of each operator how many of those that were judged were seen."""
        modules = sorted({module for module, _, _ in self.counts})
        rows = [["", *modules, "all"]]
        for operator in [None, *sorted({operator for _, operator, _ in self.counts})]:
            cells = []
            for module in [*modules, None]:
                seen, lost = (self.count(*outcomes, module=module, operator=operator) for outcomes in (SEEN, SURVIVED))
                cells.append(f"{seen}/{seen + lost}" if seen + lost else "")
            rows.append([operator or "seen of judged", *cells])
        for name in ("equivalent", "not C++"):
            rows.append([name, *(str(self.count(name, module=module)) for module in [*modules, None])])
        return "\n".join(f"| {' | '.join(row)} |" for row in [rows[0], ["---"] * len(rows[0]), *rows[1:]])


def survivors_told(file):
    """The keys of the slips that survived in a run whose output is in a file. The line numbers there are of no account."""
    told = re.findall(r"^(?:survived|not run|unsteady): (?:[^:\n]+: )?([^:\n]+):\d+: .*\n    - (.*)\n    \+ ?(.*)$", pathlib.Path(file).read_text(), flags=re.M)
    return {(path, code_of(before), code_of(after)) for path, before, after in told}


def others_told(file):
    """The lines that tell of the slips that did not survive."""
    return re.findall(r"^(?:seen|timed out|equivalent|not C\+\+): [^:\n]+: [^:\n]+:\d+: .*$", pathlib.Path(file).read_text(), flags=re.M)

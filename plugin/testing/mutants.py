"""What plugin/run mutate changes: the product's files, their lines, and the slips that each line can have."""

import pathlib
import re
import subprocess

from slips import NOT_MUTATED, enumerations, slips_by_line

ROOT = pathlib.Path(__file__).resolve().parents[2]
EQUIVALENT = ROOT / ".ci" / "equivalent_mutants"

# A module's own tests, and what they need. The later ones are tested with all before them.
MODULES = {
    "solver": ("solver_tests", "solver"),
    "device": ("device_tests", "device"),
    "io": ("io_tests", "io;testdata"),
    "modes": ("modes_tests", "solver;io;modes;testdata"),
    "plugin": ("plugin_tests", "solver;io;device;modes;testdata;plugin"),
}


def git(*arguments):
    return subprocess.run(["git", *arguments], cwd=ROOT, capture_output=True, text=True, check=True).stdout


def code_of(line):
    """A line without its comment, which may be worded anew."""
    return re.sub(r"\s*//.*$", "", line).strip()


class Mutant:
    def __init__(self, module, path, number, before, slip):
        self.module = module  # whose sample it is of
        self.path, self.number, self.before = path, number, before
        self.name, self.after, self.together = slip
        self.place = None  # of its byte among those that tell what was run
        self.marked = False  # it is compiled alone, but its line tells that it is run
        self.no_code = False  # it does not compile

    def key(self):
        return (self.path, code_of(self.before), code_of(self.after))

    def title(self):
        return f"{self.module}: {self.path}:{self.number}: {self.name}"

    def __str__(self):
        return f"{self.title()}\n    - {self.before.strip()}\n    + {self.after.strip()}"


def is_mutated(name):
    return name.split("/")[0] in MODULES and name.endswith((".cpp", ".h")) and not NOT_MUTATED.search(name)


def sources(folder):
    files = git("ls-files", "-co", "--exclude-standard", folder).split()
    return [f for f in files if is_mutated(f) and (ROOT / f).exists()]


def changed_lines(since):
    """file -> numbers of the lines that differ from `since`."""
    lines, path = {}, None
    for line in git("diff", "-U0", since, "--", *MODULES).splitlines():
        if line.startswith("+++ "):
            path = line[6:] if line.startswith("+++ b/") else None
        elif line.startswith("@@") and path:
            first, _, count = re.search(r"\+(\d+)(,(\d+))?", line).groups()
            lines.setdefault(path, set()).update(range(int(first), int(first) + int(count or 1)))
    return lines


def mutants_by_line(module, path, enums, wanted=None):
    text = (ROOT / path).read_text()
    lines = text.splitlines()
    return [[Mutant(module, path, number, lines[number - 1], slip) for slip in slips] for number, slips in slips_by_line(text, wanted, enums)]


def all_enumerations():
    """The values of each enumeration of the product; of two with one name, none."""
    found = {}
    for path in git("ls-files", "*.h", "*.cpp").split():
        for name, values in enumerations((ROOT / path).read_text(errors="replace")).items():
            found.setdefault(name, []).append(values)
    return {name: values[0] for name, values in found.items() if len(values) == 1}


def equivalents():
    keys = set()
    if EQUIVALENT.exists():
        for line in EQUIVALENT.read_text().splitlines():
            parts = [part.strip() for part in line.split(" | ")]
            if len(parts) == 4 and not line.startswith("#"):
                keys.add((parts[0], code_of(parts[1]), code_of(parts[2])))
    return keys

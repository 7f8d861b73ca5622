#!/usr/bin/env python3
"""Puts small slips into the core, one at a time, and tells which of them no test of their module sees.

    plugin/run mutate                      the lines changed since main (or since --since COMMIT)
    plugin/run mutate solver               a seeded sample of a folder's lines (any path below a module)
    plugin/run mutate io/fields --count 200 --seed 7 --seconds 3600

Works in copies of the tree under build/mutate; the tree itself is not touched. Slips that cannot be seen since they
change nothing are named, with the reason, in .ci/equivalent_mutants.
"""

import argparse
import os
import pathlib
import queue
import random
import re
import shutil
import subprocess
import sys
import threading
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
WORK = ROOT / "build" / "mutate"
EQUIVALENT = ROOT / ".ci" / "equivalent_mutants"

# A module's own tests, and what they need. The later ones are tested with all before them.
MODULES = {
    "solver": ("solver_tests", "solver"),
    "device": ("device_tests", "device"),
    "io": ("io_tests", "io;testdata"),
    "modes": ("modes_tests", "solver;io;modes;testdata"),
    "plugin": ("plugin_tests", "solver;io;device;modes;testdata;plugin"),
}
NOT_MUTATED = re.compile(r"(_test|_benchmark|_main)\.(cpp|h)$|/(testing|peers|fuzz|paraview|bench)/")
SKIPPED_LINE = re.compile(r"^\s*(#|using |namespace|template|static_assert|friend |public:|private:|case |///|//|\*)")

# Each: a name, what is looked for in code without comments and strings, and what takes its place.
SWAPS = [
    ("plus for minus", r" \+ ", " - "),
    ("minus for plus", r" - ", " + "),
    ("times for over", r" \* ", " / "),
    ("over for times", r" / ", " * "),
    ("add for subtract", r" \+= ", " -= "),
    ("subtract for add", r" -= ", " += "),
    ("less for not more", r" < ", " <= "),
    ("not more for less", r" <= ", " < "),
    ("more for not less", r" > ", " >= "),
    ("not less for more", r" >= ", " > "),
    ("turned comparison", r" < ", " > "),
    ("turned comparison", r" > ", " < "),
    ("equal for different", r" == ", " != "),
    ("different for equal", r" != ", " == "),
    ("and for or", r" && ", " || "),
    ("or for and", r" \|\| ", " && "),
    ("least for most", r"\bstd::min\b", "std::max"),
    ("most for least", r"\bstd::max\b", "std::min"),
    ("no negation", r"(?<=[ (])!(?=[A-Za-z(])", ""),
    ("other sign", r"(?<=[=(,?:] )-(?=[A-Za-z0-9(])|(?<=\()-(?=[A-Za-z(])|(?<=return )-(?=[A-Za-z0-9(])", ""),
    ("y for x", r"\.x\b(?!\()", ".y"),
    ("z for y", r"\.y\b(?!\()", ".z"),
    ("x for z", r"\.z\b(?!\()", ".x"),
    ("down for up", r"\+\+(?=[A-Za-z])", "--"),
    ("false for true", r"\btrue\b", "false"),
    ("true for false", r"\bfalse\b", "true"),
]
NUMBER = re.compile(r"(?<![\w.])(\d+\.\d+(?:e-?\d+)?|\d+)(?![\w.])")
STATEMENT = re.compile(r"^\s+(?:[\w.\[\]>-]+ [+\-*/|&]?= .*|(?:\+\+|--)?[\w.:>-]+\([^;]*\)|(?:\+\+|--)[\w.>-]+);\s*$")


def masked(text):
    """The text with comments and strings blanked, place by place."""
    pattern = r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\''
    return re.sub(pattern, lambda m: re.sub(r"[^\n]", " ", m.group()), text, flags=re.S)


def closing(line, begin):
    """Where the parenthesis that opens at `begin` closes, and its commas; None where that is on another line."""
    depth, commas = 0, []
    for at in range(begin, len(line)):
        if line[at] in "([{":
            depth += 1
        elif line[at] in ")]}":
            depth -= 1
            if depth == 0:
                return at, commas
        elif line[at] == "," and depth == 1:
            commas.append(at)
    return None


def slips_of(line, code):
    """(name, line with the slip) for each slip that a line of code can have."""
    found = []
    for name, pattern, other in SWAPS:
        for match in re.finditer(pattern, code):
            found.append((name, line[: match.start()] + other + line[match.end() :]))
    for match in NUMBER.finditer(code):
        number = match.group()
        other = "1" if float(number) == 0 else "2" if float(number) == 1 else None
        if other is None:
            other = str(2 * float(number)) if re.search(r"[.e]", number) else str(2 * int(number))
        elif "." in number:
            other += ".0"
        found.append(("another number", line[: match.start()] + other + line[match.end() :]))
    for match in re.finditer(r"\bstd::clamp\(", code):
        end = closing(code, match.end() - 1)
        if end and len(end[1]) == 2:
            found.append(("no clamp", line[: match.start()] + line[match.end() - 1 : end[1][0]] + line[end[0] :]))
    for match in re.finditer(r"\bif \((?!constexpr)", code):
        end = closing(code, match.end() - 1)
        if end:
            begin = match.end()
            found.append(("no guard", line[:begin] + "false && (" + line[begin : end[0]] + ")" + line[end[0] :]))
    if STATEMENT.match(code) and not re.match(r"^\s*(return|throw|const|auto|static|delete|break|continue)\b", code):
        found.append(("statement left out", re.match(r"\s*", line).group() + ";"))
    return found


class Mutant:
    def __init__(self, path, number, name, before, after):
        self.path, self.number, self.name, self.before, self.after = path, number, name, before, after

    def key(self):
        return (self.path, self.before.strip(), self.after.strip())

    def __str__(self):
        return f"{self.path}:{self.number}: {self.name}\n    - {self.before.strip()}\n    + {self.after.strip()}"


def git(*arguments):
    return subprocess.run(["git", *arguments], cwd=ROOT, capture_output=True, text=True, check=True).stdout


def sources(folder):
    files = git("ls-files", "-co", "--exclude-standard", folder).split()
    return [f for f in files if f.endswith((".cpp", ".h")) and not NOT_MUTATED.search(f) and (ROOT / f).exists()]


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


def mutants_by_line(path, wanted=None):
    """A list of each line's mutants, lines without any left out."""
    text = (ROOT / path).read_text()
    lines, codes = text.splitlines(), masked(text).splitlines()
    result = []
    for number, (line, code) in enumerate(zip(lines, codes), 1):
        if (wanted is not None and number not in wanted) or SKIPPED_LINE.match(line):
            continue
        slips = [Mutant(path, number, name, line, after) for name, after in slips_of(line, code) if after != line]
        if slips:
            result.append(slips)
    return result


def equivalents():
    keys = set()
    if EQUIVALENT.exists():
        for line in EQUIVALENT.read_text().splitlines():
            parts = [part.strip() for part in line.split(" | ")]
            if len(parts) == 4 and not line.startswith("#"):
                keys.add(tuple(parts[:3]))
    return keys


class Bench:
    """A copy of the tree with a build folder of its own."""

    def __init__(self, module, number):
        self.target, modules = MODULES[module]
        self.tree = WORK / f"{module}-{number}"
        self.build = self.tree / "build"
        self.log = ""
        files = git("ls-files", "-co", "--exclude-standard").split("\n")
        for name in filter(None, files):
            source, copy = ROOT / name, self.tree / name
            if not source.is_file():
                continue
            # Its contents decide, not its time: the last slip may have been left in the copy.
            if not copy.exists() or copy.read_bytes() != source.read_bytes():
                copy.parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(source, copy)
        self.environment = {"CCACHE_BASEDIR": str(self.tree), "CCACHE_NOHASHDIR": "1"}
        # A slip may leave a variable unused: that is for the tests to see, not for the compiler.
        self.run(["cmake", "--preset", "release", "-DPALPATE_TESTS=ON", "-DPALPATE_TOGETHER=OFF", "-DPALPATE_WERROR=OFF",
                  f"-DPALPATE_MODULES={modules}"], 600)
        if self.make(3600) != 0:
            sys.exit(f"mutate: {self.target} does not build without any slip:\n{self.log[-2000:]}")
        began = time.time()
        if self.test(1800) != 0:
            sys.exit(f"mutate: {self.target} fails without any slip:\n{self.log[-2000:]}")
        self.usual = time.time() - began

    def run(self, command, seconds, **more):
        environment = {**os.environ, **self.environment, **more}
        process = subprocess.Popen(command, cwd=self.tree, env=environment, stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT, start_new_session=True)
        try:
            out, _ = process.communicate(timeout=seconds)
            self.log = out.decode(errors="replace")
            return process.returncode
        except BaseException as error:
            os.killpg(process.pid, 9)  # with what a slip has started
            process.communicate()
            if isinstance(error, subprocess.TimeoutExpired):
                return -1
            raise

    def make(self, seconds, **more):
        return self.run(["ninja", "-C", str(self.build), self.target], seconds, **more)

    def test(self, seconds):
        return self.run([str(self.build / "bin" / self.target), "--gtest_fail_fast", "--gtest_brief=1"], seconds)

    def try_slip(self, mutant):
        """seen, survived or not C++."""
        path = self.tree / mutant.path
        original = path.read_text()
        lines = original.split("\n")
        assert lines[mutant.number - 1] == mutant.before
        lines[mutant.number - 1] = mutant.after
        path.write_text("\n".join(lines))
        try:
            if self.make(900, CCACHE_DISABLE="1") != 0:
                return "not C++"
            return "survived" if self.test(20 + 5 * self.usual) == 0 else "seen"
        finally:
            path.write_text(original)


def work(benches, chosen, deadline, known):
    results, lock, waiting = [], threading.Lock(), queue.Queue()
    for mutant in chosen:
        waiting.put(mutant)

    def serve(bench):
        while time.time() < deadline:
            try:
                mutant = waiting.get_nowait()
            except queue.Empty:
                return
            outcome = bench.try_slip(mutant)
            if outcome == "survived" and mutant.key() in known:
                outcome = "equivalent"
            with lock:
                results.append((mutant, outcome))
                if outcome == "survived":
                    print(f"survived: {mutant}", flush=True)

    threads = [threading.Thread(target=serve, args=(bench,)) for bench in benches]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return results


def main():
    parser = argparse.ArgumentParser(prog="plugin/run mutate", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", nargs="?", help="a module or a path below one; without it, changed lines")
    parser.add_argument("--since", help="commit that lines are changed since (default: where main was left, else HEAD~1)")
    parser.add_argument("--count", type=int, default=200, help="lines, one slip each (default 200)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=1800, help="no new slip is begun after these (default 1800)")
    parser.add_argument("--jobs", type=int, default=1, help="copies of the tree that work beside each other")
    parser.add_argument("--least", type=float, default=0, help="fail below this score")
    parser.add_argument("--list", action="store_true", help="only say which slips were chosen")
    options = parser.parse_args()

    if options.folder:
        files = {path: None for path in sources(options.folder.rstrip("/"))}
        if not files:
            sys.exit(f"mutate: {options.folder} holds no sources; modules are: {' '.join(MODULES)}")
    else:
        since = options.since
        if not since:
            base = subprocess.run(["git", "merge-base", "HEAD", "main"], cwd=ROOT, capture_output=True, text=True)
            head = git("rev-parse", "HEAD").strip()
            since = base.stdout.strip() if base.returncode == 0 and base.stdout.strip() != head else "HEAD~1"
        files = {path: lines for path, lines in changed_lines(since).items()
                 if path.endswith((".cpp", ".h")) and not NOT_MUTATED.search(path) and (ROOT / path).exists()}

    generator = random.Random(options.seed)
    lines = [line for path in sorted(files) for line in mutants_by_line(path, files[path])]
    generator.shuffle(lines)
    chosen = [generator.choice(line) for line in lines[: options.count]]
    print(f"{len(lines)} lines can have a slip; {len(chosen)} are tried, seed {options.seed}", flush=True)
    if options.list:
        print("\n".join(map(str, chosen)))
        return
    known, total, began = equivalents(), {}, time.time()
    for module in MODULES:
        own = [mutant for mutant in chosen if mutant.path.split("/")[0] == module]
        if not own:
            continue
        benches = [Bench(module, n) for n in range(max(1, options.jobs))]
        print(f"{module}: its tests take {benches[0].usual:.1f} s", flush=True)
        for mutant, outcome in work(benches, own, began + options.seconds, known):
            total[outcome] = total.get(outcome, 0) + 1
    seen, survived = total.get("seen", 0), total.get("survived", 0)
    tried = sum(total.values())
    score = seen / (seen + survived) if seen + survived else 1.0
    print(f"{tried} of {len(chosen)} slips tried in {time.time() - began:.0f} s: {seen} seen, {survived} survived, "
          f"{total.get('equivalent', 0)} known to change nothing, {total.get('not C++', 0)} not C++")
    print(f"score {score:.3f}")
    sys.exit(1 if score < options.least else 0)


if __name__ == "__main__":
    main()

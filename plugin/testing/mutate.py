#!/usr/bin/env python3
"""Puts small slips into the core, one at a time, and tells which of them no test of their module sees.

    plugin/run mutate                      the lines changed since main (or since --since COMMIT)
    plugin/run mutate solver               a seeded sample of a folder's lines (any path below a module)
    plugin/run mutate io/fields --count 200 --seed 7 --seconds 3600

Works in copies of the tree under build/mutate; the tree itself is not touched. A slip is judged by those of its module's
test suites that run its line, nearest and quickest first; which those are is found once (some minutes a module) and kept.
Slips that cannot be seen since they change nothing are named, with the reason, in .ci/equivalent_mutants.
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

import reach

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
# Folders whose tests are a program of their own, which alone judges them.
OWN_TESTS = {"io/archive/": "archive_tests", "io/results/": "archive_tests"}
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
ROOM = re.compile(r"^\s*[\w:<>]+ \w+\[$|\bstd::array<[\w:]+, $")  # an array's length: more of it changes nothing
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
        if ROOM.search(code[: match.start()]):
            continue
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


def near_suites(path, suites):
    """Those of the suites whose tests stand in the file's folder: most slips are seen there."""
    near = reach.files_of_suites((ROOT / path).parent.glob("*_test.cpp"))
    return [suite for suite in suites if near.keys() & set(suite.split("/"))]


def target_of(path):
    """The program that tests a file, and the modules that it needs."""
    target, modules = MODULES[path.split("/")[0]]
    return next((own for folder, own in OWN_TESTS.items() if path.startswith(folder)), target), modules


class Bench:
    """A copy of the tree with a build folder of its own, and one with counters where tests are chosen by them."""

    def __init__(self, target, modules, number):
        self.target = target
        self.tree = WORK / f"{target}-{number}"
        self.build = self.tree / "build"
        self.log = ""
        self.files = [name for name in git("ls-files", "-co", "--exclude-standard").split("\n") if name and (ROOT / name).is_file()]
        for name in self.files:
            source, copy = ROOT / name, self.tree / name
            # Its contents decide, not its time: the last slip may have been left in the copy.
            if not copy.exists() or copy.read_bytes() != source.read_bytes():
                copy.parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(source, copy)
        self.environment = {"CCACHE_BASEDIR": str(self.tree), "CCACHE_NOHASHDIR": "1"}
        self.modules = modules
        # A slip may leave a variable unused: that is for the tests to see, not for the compiler.
        self.configure("release", "-DCMAKE_CXX_FLAGS_RELEASE=-O1")
        if self.make(3600) != 0:
            sys.exit(f"mutate: {target} does not build without any slip:\n{self.log[-2000:]}")
        self.suites = reach.suites_of(self.build / "bin" / target)
        self.reach = None

    def configure(self, preset, *more):
        if self.run(["cmake", "--preset", preset, "-DPALPATE_TESTS=ON", "-DPALPATE_TOGETHER=OFF", "-DPALPATE_WERROR=OFF",
                     f"-DPALPATE_MODULES={self.modules}", *more], 600) != 0:
            sys.exit(f"mutate: cmake failed:\n{self.log[-2000:]}")

    def find_reach(self):
        """Which suites run which lines, by a build with counters."""
        core = [name for name in self.files if is_mutated(name)]
        tests = [name for name in self.files if name.endswith("_test.cpp")]
        self.configure("coverage")
        counters = self.tree / "build" / "coverage"
        if self.run(["ninja", "-C", str(counters), self.target], 7200) != 0:
            sys.exit(f"mutate: {self.target} does not build with counters:\n{self.log[-2000:]}")
        return reach.reach_of(self.tree, counters, self.target, set(core), tests, self.run, WORK / f"{self.target}.reach.json")

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

    def passes(self, suites):
        """Whether these suites pass; a slip may also make them run for ever."""
        usual = sum(self.reach.suites[suite]["seconds"] for suite in suites) if self.reach else 60
        chosen = ":".join(f"{suite}.*" for suite in suites) + "-*.DISABLED_*"
        return self.run([str(self.build / "bin" / self.target), "--gtest_fail_fast", "--gtest_brief=1",
                         "--gtest_filter=" + chosen], 20 + 5 * usual) == 0

    def try_slip(self, mutant):
        """seen, survived (or not run: by no test) or not C++."""
        near = near_suites(mutant.path, self.suites)
        rounds = [near]
        if self.reach:
            running = self.reach.of(mutant.path, mutant.number)
            if not running:
                return "not run"
            rounds = [[suite for suite in near if suite in running], [suite for suite in running if suite not in near]]
        path = self.tree / mutant.path
        original = path.read_text()
        lines = original.split("\n")
        assert lines[mutant.number - 1] == mutant.before
        lines[mutant.number - 1] = mutant.after
        path.write_text("\n".join(lines))
        try:
            if self.make(900, CCACHE_DISABLE="1") != 0:
                return "not C++"
            return "survived" if all(self.passes(suites) for suites in rounds if suites) else "seen"
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
            outcome = "equivalent" if mutant.key() in known else bench.try_slip(mutant)
            with lock:
                results.append((mutant, outcome))
                if outcome in ("survived", "not run"):
                    print(f"{outcome}: {mutant}", flush=True)

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
    parser.add_argument("--seconds", type=float, default=1800, help="no new slip of a test program is begun after these (default 1800)")
    parser.add_argument("--jobs", type=int, default=1, help="copies of the tree that work beside each other")
    parser.add_argument("--least", type=float, default=0, help="fail below this score")
    parser.add_argument("--near", action="store_true",
                        help="only the tests of a slip's own folder: quick, and what survives may be seen by others")
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
                 if is_mutated(path) and (ROOT / path).exists()}

    generator = random.Random(options.seed)
    lines = [line for path in sorted(files) for line in mutants_by_line(path, files[path])]
    generator.shuffle(lines)
    chosen = [generator.choice(line) for line in lines[: options.count]]
    print(f"{len(lines)} lines can have a slip; {len(chosen)} are tried, seed {options.seed}", flush=True)
    if options.list:
        print("\n".join(map(str, chosen)))
        return
    known, total, began = equivalents(), {}, time.time()
    for target, modules in sorted({target_of(mutant.path) for mutant in chosen}):
        own = [mutant for mutant in chosen if target_of(mutant.path)[0] == target]
        benches = [Bench(target, modules, n) for n in range(max(1, options.jobs))]
        if not options.near:
            found = benches[0].find_reach()
            print(f"{target}: its suites take {sum(suite['seconds'] for suite in found.suites.values()):.0f} s", flush=True)
            for bench in benches:
                bench.reach = found
        for mutant, outcome in work(benches, own, time.time() + options.seconds, known):
            total[outcome] = total.get(outcome, 0) + 1
    seen, survived = total.get("seen", 0), total.get("survived", 0) + total.get("not run", 0)
    tried = sum(total.values())
    score = seen / (seen + survived) if seen + survived else 1.0
    print(f"{tried} of {len(chosen)} slips tried in {time.time() - began:.0f} s: {seen} seen, {survived} survived "
          f"({total.get('not run', 0)} of them run by no test), {total.get('equivalent', 0)} known to change nothing, "
          f"{total.get('not C++', 0)} not C++")
    print(f"score {score:.3f}")
    sys.exit(1 if score < options.least else 0)


if __name__ == "__main__":
    main()

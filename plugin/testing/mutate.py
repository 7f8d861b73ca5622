#!/usr/bin/env python3
"""Puts small slips into the core, and tells which of them no test of their module sees.

    plugin/run mutate                      the lines changed since main (or since --since COMMIT)
    plugin/run mutate solver               a seeded sample of a folder's lines (any path below a module)
    plugin/run mutate io/dicom io/fields   a sample of each; FOLDER+FOLDER is one sample of both
    plugin/run mutate io/fields --count 200 --seed 7 --seconds 3600 | tee told
    plugin/run mutate device --equivalents         those of .ci/equivalent_mutants: one that a test sees is none
    plugin/run mutate io/fields --again told       only what survived there, after tests were written: what was told of
                                                   the others is repeated, so that the table is of all

Works in a copy of the tree under build/mutate; the tree itself is not touched. All slips that can be are compiled into one
program and chosen at run time (slip.h); the others are compiled one by one. A slip is judged by those of its module's tests
that run its place, nearest and quickest first. Slips that cannot be seen since they change nothing are named, with the
reason, in .ci/equivalent_mutants.
"""

import argparse
import itertools
import os
import pathlib
import queue
import random
import re
import shutil
import subprocess
import sys
import tempfile
import threading
import time

from slips import COMPILES_ALIKE, NOT_MUTATED, enumerations, masked, slips_by_line

ROOT = pathlib.Path(__file__).resolve().parents[2]
WORK = ROOT / "build" / "mutate"
EQUIVALENT = ROOT / ".ci" / "equivalent_mutants"
SLIP_H = ROOT / "plugin" / "testing" / "slip.h"
LONGEST_TEST_S = 600
PLACES = 4096  # `most` in slip.h
TIMED_OUT = 1000
SEEN = ("seen", "timed out")
SURVIVED = ("survived", "not run", "unsteady")  # the last at tests that fail without the slip, too

# A module's own tests, and what they need. The later ones are tested with all before them.
MODULES = {
    "solver": ("solver_tests", "solver"),
    "device": ("device_tests", "device"),
    "io": ("io_tests", "io;testdata"),
    "modes": ("modes_tests", "solver;io;modes;testdata"),
    "plugin": ("plugin_tests", "solver;io;device;modes;testdata;plugin"),
}
# Folders whose tests are a program of their own, which alone judges them.
OWN_TESTS = {"io/archive/": "archive_tests", "io/results/": "results_tests", "plugin/paraview/client/model/": "paraview_model_tests"}
NEEDS_PARAVIEW = {"paraview_model_tests"}


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


def git(*arguments):
    return subprocess.run(["git", *arguments], cwd=ROOT, capture_output=True, text=True, check=True).stdout


def survivors_told(file):
    """The keys of the slips that survived in a run whose output is in a file. The line numbers there are of no account."""
    told = re.findall(r"^(?:survived|not run|unsteady): (?:[^:\n]+: )?([^:\n]+):\d+: .*\n    - (.*)\n    \+ ?(.*)$", pathlib.Path(file).read_text(), flags=re.M)
    return {(path, code_of(before), code_of(after)) for path, before, after in told}


def others_told(file):
    """The lines that tell of the slips that did not survive."""
    return re.findall(r"^(?:seen|timed out|equivalent|not C\+\+): [^:\n]+: [^:\n]+:\d+: .*$", pathlib.Path(file).read_text(), flags=re.M)


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


def target_of(path):
    """The program that tests a file, and the modules that it needs."""
    target, modules = MODULES[path.split("/")[0]]
    return next((own for folder, own in OWN_TESTS.items() if path.startswith(folder)), target), modules


def suites_near(path):
    """The suites whose tests stand in the file's folder: most slips are seen there."""
    return {suite for test in (ROOT / path).parent.glob("*_test.cpp")
            for suite in re.findall(r"^(?:TYPED_)?TEST(?:_[FP])?\((\w+),", test.read_text(), flags=re.M)}


def begins_statement(lines, number):
    """Whether a statement begins on a line: what stands in front of the line of another would change that one."""
    before = next((line for line in reversed(masked("\n".join(lines[: number - 1])).split("\n")) if line.strip()), ";")
    return before.rstrip().endswith((";", "{", "}"))


def with_slips(path, mutants):
    """The text of a file in which slips are chosen at run time, or only tell that their line is run."""
    lines = (ROOT / path).read_text().split("\n")
    for mutant in mutants:
        line = f"slip::on(@); {mutant.before}" if mutant.marked else mutant.together
        if mutant.marked and not begins_statement(lines, mutant.number):
            mutant.place, mutant.marked = None, True  # its suites are not told: all judge it
            continue
        lines[mutant.number - 1] = line.replace("{@}", f"{{{mutant.place}}}").replace("on(@)", f"on({mutant.place})")
    # Here, and not for every file by an option: what has no slip is compiled as ever, and found in ccache.
    return f'#include "{SLIP_H.relative_to(ROOT).as_posix()}"\n#line 1\n' + "\n".join(lines)


def is_near(test, suites):
    """Whether a test, "Prefix/Suite/0.Name/1", is of one of these suites."""
    return not suites.isdisjoint(test.split(".")[0].split("/"))


def batches(tests, seconds_of, first_s=1.0, most=500):
    """The tests in their order, in parts that take four times as long as the one before: most slips are seen at once."""
    batch, seconds = [], 0.0
    for test in tests:
        batch.append(test)
        seconds += seconds_of(test)
        if seconds >= first_s or len(batch) == most:
            yield batch
            batch, seconds, first_s = [], 0.0, 4 * first_s
    if batch:
        yield batch


class Bench:
    """A copy of the tree with a build of a test program in it."""

    def __init__(self, target, modules):
        self.target, self.tree = target, WORK / target
        self.build, self.logs = self.tree / "build", threading.local()
        self.program = self.build / "bin" / target
        names = git("ls-files", "-co", "--exclude-standard").split("\n")
        self.files = [name for name in names if name and (ROOT / name).is_file()]
        # What has no slip is found in ccache as other builds left it; what has one is not kept there. A slip may leave a
        # variable unused: that is for the tests to see, not for the compiler.
        careless = WORK / "careless"
        WORK.mkdir(parents=True, exist_ok=True)
        # A precompiled header serves only the options that it was made with.
        careless.write_text('#!/bin/sh\ncase "$*" in *cmake_pch*) exec "$@" -w -Wno-narrowing ;; esac\nexec "$@" -w -Wno-narrowing -O1\n')
        careless.chmod(0o755)
        self.environment = {"CCACHE_BASEDIR": str(self.tree), "CCACHE_NOHASHDIR": "1", "CCACHE_SLOPPINESS": "pch_defines,time_macros",
                            "CCACHE_READONLY": "1", "CCACHE_PREFIX": str(careless)}
        for name in self.files:
            self.write(name, (ROOT / name).read_bytes())
        if self.run(["cmake", "--preset", "developer", "-DPALPATE_TESTS=ON", f"-DPALPATE_MODULES={modules}",
                     f"-DPALPATE_PARAVIEW={'ON' if target in NEEDS_PARAVIEW else 'OFF'}"], 600) != 0:
            sys.exit(f"mutate: cmake failed:\n{self.log()[-2000:]}")

    def log(self):
        """What the last command of this thread printed."""
        return getattr(self.logs, "last", "")

    def write(self, name, data):
        """Changes a file of the copy if its contents differ: its time would have all compiled again."""
        copy = self.tree / name
        if not copy.exists() or copy.read_bytes() != data:
            copy.parent.mkdir(parents=True, exist_ok=True)
            copy.write_bytes(data)
            shutil.copymode(ROOT / name, copy)

    def run(self, command, seconds, **more):
        """The exit code of a command in the copy; TIMED_OUT where it took too long."""
        process = subprocess.Popen(command, cwd=self.tree, env={**os.environ, **self.environment, **more},
                                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT, start_new_session=True)
        try:
            out, _ = process.communicate(timeout=seconds)
            self.logs.last = out.decode(errors="replace")
            return process.returncode
        except BaseException as error:
            os.killpg(process.pid, 9)  # with what a slip has started
            process.communicate()
            if isinstance(error, subprocess.TimeoutExpired):
                return TIMED_OUT
            raise

    def make(self, **more):
        return self.run(["ninja", "-C", str(self.build), "-k", "0", self.target], 7200, **more) == 0

    def compile_together(self, mutants):
        """Compiles all slips that can be into one program; of the others, only what tells that their line is run."""
        for place, mutant in enumerate(mutants):
            mutant.place = place
            mutant.marked = mutant.together is None
        left = list(mutants)
        while True:
            by_file = {}
            for mutant in left:
                by_file.setdefault(mutant.path, []).append(mutant)
            for path in {mutant.path for mutant in mutants}:
                self.write(path, with_slips(path, by_file.get(path, [])).encode())
            if self.make():
                break
            # The tree itself may lie in a folder of such a name.
            named = set(re.findall(r"((?:solver|io|modes|device|plugin)/[\w./]+):(\d+)", self.log().replace(f"{self.tree}/", "")))
            wrong = [mutant for mutant in left if (mutant.path, str(mutant.number)) in named]
            if not wrong:  # an error without a line of a slip: all of the files that it names
                files = {path for path, _ in named}
                wrong = [mutant for mutant in left if mutant.path in files]
                if not wrong:
                    sys.exit(f"mutate: {self.target} does not build without any slip:\n{self.log()[-2000:]}")
                for mutant in wrong:
                    mutant.marked = True
            for mutant in wrong:
                mutant.no_code = mutant.name in COMPILES_ALIKE
                if mutant.marked or mutant.no_code:
                    left.remove(mutant)
                mutant.marked = True
        for mutant in mutants:
            if mutant not in left:
                mutant.place, mutant.marked = None, True

    def look_at_tests(self, jobs, named, near=None):
        """How long each test takes, and which places it runs. Where some are near, others only if they are quick."""
        listed = subprocess.run([self.program, "--gtest_list_tests"], capture_output=True, text=True, check=True).stdout
        names, suite = [], ""
        for line in listed.splitlines():
            if line.startswith("  "):
                names.append(f"{suite}.{line.split()[0]}")
            elif not line.startswith("Running"):
                suite = line.split()[0].rstrip(".")
        self.tests = {}

        def look(test):
            with tempfile.NamedTemporaryFile() as places:
                places.write(bytes(PLACES))
                places.flush()
                began = time.time()
                near_it = near is None or is_near(test, near)
                code = self.outcome_of([test], LONGEST_TEST_S if near_it else 3, PALPATE_SLIPS_RUN=places.name)
                if code == 0:
                    self.tests[test] = (time.time() - began, pathlib.Path(places.name).read_bytes())
                elif near_it or code != TIMED_OUT:
                    print(f"{test} fails without any slip, and is left out:\n{self.log()[-800:]}", flush=True)

        left_out = re.compile(r"Shared|DISABLED_")
        serve(look, [test for test in names if named.search(test) and not left_out.search(test)], jobs, time.time() + 7200)
        print(f"{self.target}: {len(self.tests)} tests take {sum(seconds for seconds, _ in self.tests.values()):.0f} s", flush=True)

    def outcome_of(self, tests, seconds, **more):
        """The exit code of the program for these tests."""
        with tempfile.TemporaryDirectory() as folder:  # tests of two slips at once do not share files
            return self.run([str(self.program), "--gtest_fail_fast", "--gtest_brief=1", f"--gtest_filter={':'.join(tests)}-*.DISABLED_*"],
                            seconds, TMPDIR=folder, TEST_TMPDIR=folder, PALPATE_TEST_SECONDS=str(LONGEST_TEST_S), **more)

    def judge(self, mutant, without_it=True, quickly=False, **more):
        """seen, timed out (seen, too), survived, not run (by no test), or unsteady: its test fails without the slip, too."""
        running = [test for test, (_, ran) in self.tests.items() if mutant.place is None or ran[mutant.place]]
        if not running:
            return "not run"
        near = suites_near(mutant.path)
        if quickly:
            running = [test for test in running if is_near(test, near) or self.tests[test][0] < 0.5]
        unsteady = False
        for tests in batches(sorted(running, key=lambda test: self.tests[test][0] * (1 if is_near(test, near) else 4)),
                             lambda test: self.tests[test][0]):
            usual = sum(self.tests[test][0] for test in tests)
            code = self.outcome_of(tests, 20 + 5 * usual, **more)
            if code == TIMED_OUT:  # a slip may also make them run for ever
                return "timed out"
            if code != 0:
                failed = re.findall(r"^\[  FAILED  \] ([\w/]+\.[\w/]+)", self.log(), flags=re.M) or tests
                if not without_it or self.outcome_of(sorted(set(failed)), 20 + 5 * usual) == 0:
                    return "seen"
                unsteady = True
        return "unsteady" if unsteady else "survived"

    def judge_alone(self, mutant):
        """The same of a slip that is compiled by itself, and so cannot be left out; or not C++."""
        lines = (ROOT / mutant.path).read_text().split("\n")
        lines[mutant.number - 1] = mutant.after
        before = (self.tree / mutant.path).read_bytes()
        self.write(mutant.path, "\n".join(lines).encode())
        try:
            return self.judge(mutant, without_it=False) if self.make(CCACHE_DISABLE="1") else "not C++"
        finally:
            self.write(mutant.path, before)


def serve(function, items, jobs, deadline):
    """Calls the function with each item, on several threads; none is begun after the deadline."""
    waiting = queue.Queue()
    for item in items:
        waiting.put(item)

    def work():
        while time.time() < deadline:
            try:
                function(waiting.get_nowait())
            except queue.Empty:
                return

    threads = [threading.Thread(target=work) for _ in range(jobs)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()


def try_slips(bench, mutants, account, options):
    lock = threading.Lock()

    def tell(mutant, outcome):
        with lock:
            account.tell(mutant, outcome)

    bench.compile_together(mutants)
    near = set().union(*(suites_near(mutant.path) for mutant in mutants)) if options.quickly else None
    bench.look_at_tests(options.jobs, re.compile(options.suites), near)
    alone = [mutant for mutant in mutants if mutant.marked]
    together = [mutant for mutant in mutants if not mutant.marked]
    print(f"{bench.target}: {len(together)} slips are chosen at run time, {len(alone)} are compiled alone", flush=True)
    for mutant in [mutant for mutant in alone if mutant.no_code]:
        tell(mutant, "not C++")
        alone.remove(mutant)
    deadline = time.time() + options.seconds
    serve(lambda mutant: tell(mutant, bench.judge(mutant, quickly=options.quickly, PALPATE_SLIP=str(mutant.place))), together, options.jobs, deadline)
    serve(lambda mutant: tell(mutant, bench.judge_alone(mutant)), alone, 1, deadline)


def chosen_of(module, files, options, enums):
    """The slips of a module's sample."""
    lines = [line for path in sorted(files) for line in mutants_by_line(module, path, enums, files[path])]
    if options.equivalents:
        known = equivalents()
        one_of_line = {(mutant.path, mutant.number): mutant for line in lines for mutant in line if mutant.key() in known}
        chosen = list(one_of_line.values())
    elif options.again:
        # Of all lines: those that have changed since would have the seed choose others.
        told = survivors_told(options.again)
        chosen = list({mutant.key(): mutant for line in lines for mutant in line if mutant.key() in told}.values())
    else:
        generator = random.Random(options.seed)
        generator.shuffle(lines)
        chosen = [generator.choice(line) for line in lines[: options.count]]
    if options.without_headers:
        chosen = [mutant for mutant in chosen if not mutant.path.endswith(".h")]
    print(f"{module}: {len(lines)} lines can have a slip; {len(chosen)} are tried, seed {options.seed}", flush=True)
    return chosen


def lines_to_change(options):
    """module -> file -> numbers of its lines, or None for all."""
    if options.folders:
        modules = {module: {path: None for folder in module.split("+") for path in sources(folder.rstrip("/"))} for module in options.folders}
        for module, files in modules.items():
            if not files:
                sys.exit(f"mutate: {module} holds no sources; modules are: {' '.join(MODULES)}")
        return modules
    since = options.since
    if not since:
        base = subprocess.run(["git", "merge-base", "HEAD", "main"], cwd=ROOT, capture_output=True, text=True)
        head = git("rev-parse", "HEAD").strip()
        since = base.stdout.strip() if base.returncode == 0 and base.stdout.strip() != head else "HEAD~1"
    return {"changed lines": {path: lines for path, lines in changed_lines(since).items() if is_mutated(path) and (ROOT / path).exists()}}


def main():
    parser = argparse.ArgumentParser(prog="plugin/run mutate", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="*", metavar="FOLDER", help="a module or a path below one; without any, changed lines")
    parser.add_argument("--since", help="commit that lines are changed since (default: where main was left, else HEAD~1)")
    parser.add_argument("--count", type=int, default=200, help="lines of each FOLDER, one slip each (default 200)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=1800, help="no new slip of a test program is begun after these (default 1800)")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="slips that are judged beside each other")
    parser.add_argument("--least", type=float, default=0, help="fail below this score")
    parser.add_argument("--again", metavar="FILE", help="only those that survived in the run that printed this file")
    parser.add_argument("--suites", default="", metavar="REGEX", help="judge by the tests that match alone")
    parser.add_argument("--without-headers", action="store_true",
                        help="leave out the slips of the sample that lie in headers, after which most is compiled anew")
    parser.add_argument("--equivalents", action="store_true",
                        help="those of .ci/equivalent_mutants")
    parser.add_argument("--quickly", action="store_true",
                        help="by the tests of a slip's folder and those of others that take less than half a second: more survive")
    parser.add_argument("--list", action="store_true", help="only say which slips were chosen")
    options = parser.parse_args()

    enums = all_enumerations()
    samples = [chosen_of(module, files, options, enums) for module, files in lines_to_change(options).items()]
    # In turn, so that each has its share of the time.
    chosen = [mutant for turn in itertools.zip_longest(*samples) for mutant in turn if mutant]
    if options.list:
        print("\n".join(map(str, chosen)))
        return
    account, known, began = Account(), equivalents(), time.time()
    for line in others_told(options.again) if options.again else []:
        account.repeat(line)
    judged = [mutant for mutant in chosen if options.equivalents or mutant.key() not in known]
    for mutant in chosen:
        if mutant not in judged:
            account.tell(mutant, "equivalent")
    for target, modules in sorted({target_of(mutant.path) for mutant in judged}):
        own = [mutant for mutant in judged if target_of(mutant.path)[0] == target][:PLACES]
        try_slips(Bench(target, modules), own, account, options)
    seen, survived = account.count(*SEEN), account.count(*SURVIVED)
    score = seen / (seen + survived) if seen + survived else 1.0
    print(f"\n{account.table()}\n")
    print(f"{len(chosen)} slips chosen; judged in {time.time() - began:.0f} s, with those repeated: {seen} seen "
          f"({account.count('timed out')} of them by taking too long), {survived} survived ({account.count('not run')} of them run by no "
          f"test, {account.count('unsteady')} at a test that fails without the slip, too), {account.count('equivalent')} known to change "
          f"nothing, {account.count('not C++')} not C++")
    print(f"score {score:.3f}")
    sys.exit(1 if score < options.least else 0)


if __name__ == "__main__":
    main()

"""Which test suites of a module run which lines of the core: what `plugin/run mutate` chooses tests by.

Clang's counters tell it: each suite runs alone in a build with counters. What a suite runs is kept in a file, for as long
as neither the core's sources nor the suite's own file differ.
"""

import hashlib
import json
import os
import re
import shutil
import subprocess
import time

LONGEST_SUITE_S = 900


class Reach:
    """What each suite runs: `suites[name]` holds its seconds, and `lines[file]` the numbers of the lines that it runs."""

    def __init__(self, suites, counted):
        self.suites, self.counted = suites, {path: set(numbers) for path, numbers in counted.items()}
        for suite in suites.values():
            suite["lines"] = {path: set(numbers) for path, numbers in suite["lines"].items()}

    def of(self, path, number):
        """The suites that run a line, quick ones first; all of them where no counter stands for the line."""
        counted = number in self.counted.get(path, ())
        return sorted((name for name, suite in self.suites.items() if not counted or number in suite["lines"].get(path, ())),
                      key=lambda name: self.suites[name]["seconds"])


def digest(paths):
    total = hashlib.sha256()
    for path in sorted(paths):
        total.update(str(path).encode() + b"\0" + path.read_bytes())
    return total.hexdigest()


def files_of_suites(tests):
    """suite -> the files that define tests of it."""
    found = {}
    for test in tests:
        for suite in re.findall(r"^(?:TYPED_)?TEST(?:_[FP])?\((\w+),", test.read_text(), flags=re.M):
            found.setdefault(suite, set()).add(test)
    return found


def suites_of(program):
    listed = subprocess.run([program, "--gtest_list_tests"], capture_output=True, text=True, check=True,
                            env={**os.environ, "LLVM_PROFILE_FILE": "/dev/null"}).stdout
    names = [line.split()[0].rstrip(".") for line in listed.splitlines() if line[:1].strip() and not line.startswith("Running")]
    return [name for name in names if not re.search(r"Shared|DISABLED_", name)]


def lines_run(tree, build, program, profiles, core):
    """(file -> lines that have a counter, file -> lines that ran) of the profiles that a run left."""
    found = [str(path) for path in profiles.glob("*.profraw")]
    merged = profiles / "merged"
    if subprocess.run(["llvm-profdata-14", "merge", "--failure-mode=all", "-sparse", "-o", merged, *found],
                      capture_output=True).returncode != 0:
        return {}, {}  # killed before it wrote
    told = subprocess.run(["llvm-cov-14", "export", "-format=lcov", f"-instr-profile={merged}", program],
                          capture_output=True, text=True, check=True).stdout
    counted, ran, path = {}, {}, None
    for line in told.splitlines():
        if line.startswith("SF:"):
            full = (build / line[3:]).resolve()  # relative where ccache has made it so
            path = str(full.relative_to(tree)) if full.is_relative_to(tree) else None
            path = path if path in core else None
        elif path and line.startswith("DA:"):
            number, count = map(int, line[3:].split(",")[:2])
            counted.setdefault(path, set()).add(number)
            if count > 0:
                ran.setdefault(path, set()).add(number)
    return counted, ran


def reach_of(tree, build, target, core, tests, run, kept):
    """Of the program `target` in `build`, a build with counters of `tree`. core: the sources whose lines are asked for;
    tests: the files of tests; run(command, seconds, **environment) runs a command; kept: the file where answers are kept."""
    tree = tree.resolve()
    before = json.loads(kept.read_text()) if kept.exists() else {}
    of_core = digest(tree / path for path in core)
    if before.get("core") != of_core:
        before = {"core": of_core, "counted": {}, "suites": {}}
    program, profiles = build / "bin" / target, build / "profiles"
    files, suites = files_of_suites(tree / path for path in tests), {}
    counted = {path: set(numbers) for path, numbers in before["counted"].items()}
    for suite in suites_of(program):
        key = digest(files.get(re.sub(r".*/(?=\D)|/\d+$", "", suite), ()))
        if before["suites"].get(suite, {}).get("key") == key:
            suites[suite] = before["suites"][suite]
            continue
        shutil.rmtree(profiles, ignore_errors=True)
        profiles.mkdir()
        began = time.time()
        run([str(program), f"--gtest_filter={suite}.*-*.DISABLED_*", "--gtest_brief=1"], LONGEST_SUITE_S,
            LLVM_PROFILE_FILE=str(profiles / "%p.profraw"))  # a file a process: some tests start programs
        seconds = time.time() - began
        with_counter, ran = lines_run(tree, build, program, profiles, core)
        for path, numbers in with_counter.items():
            counted.setdefault(path, set()).update(numbers)
        suites[suite] = {"key": key, "seconds": seconds, "lines": {path: sorted(numbers) for path, numbers in ran.items()}}
    kept.write_text(json.dumps({"core": of_core, "counted": {path: sorted(numbers) for path, numbers in counted.items()},
                                "suites": suites}))
    return Reach(suites, counted)

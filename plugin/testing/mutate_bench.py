"""Where plugin/run mutate judges slips: a copy of the tree, in which test programs are built with slips and run."""

import os
import pathlib
import queue
import re
import shutil
import subprocess
import sys
import tempfile
import threading
import time

from mutants import MODULES, ROOT, git
from slips import COMPILES_ALIKE, masked

WORK = ROOT / "build" / "mutate"
SLIP_H = ROOT / "plugin" / "testing" / "slip.h"
LONGEST_TEST_S = 600
PLACES = 4096  # `most` in slip.h
TIMED_OUT = 1000

# Folders whose tests are a program of their own, which alone judges them.
OWN_TESTS = {"io/archive/": "archive_tests", "io/results/": "results_tests", "plugin/paraview/client/model/": "paraview_model_tests"}
NEEDS_PARAVIEW = {"paraview_model_tests"}


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

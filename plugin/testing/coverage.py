#!/usr/bin/env python3
"""Which lines and branches of the core its tests run, by folder.

    plugin/run coverage                  all modules' tests together
    plugin/run coverage solver device    these modules, each run by its own tests alone
    plugin/run coverage --files io       by file

Builds with clang's own counters under build/coverage. A line that runs is not yet a line that is tested: that is what
`plugin/run mutate` asks.
"""

import argparse
import json
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = ROOT / "build" / "coverage"
# In the order of the arrows; what a module needs is built with it.
NEEDS = {
    "solver": ["solver"],
    "io": ["io", "testdata"],
    "device": ["device"],
    "modes": ["solver", "io", "testdata", "modes"],
    "plugin": ["solver", "io", "device", "modes", "testdata", "plugin"],
}
# Besides a module's own tests: those that need an archive, where they are built.
MORE_TESTS = {"io": ["archive_tests", "results_tests"], "plugin": ["command_archive_tests"]}
ORDER = ["solver", "io", "device", "modes", "testdata", "plugin"]
NOT_COUNTED = ("_test.cpp", "_benchmark.cpp")


def run(*command, **more):
    subprocess.run(list(map(str, command)), cwd=ROOT, check=True, **more)


def is_counted(path, modules):
    parts = path.parts
    return parts[0] in modules and "testing" not in parts and not path.name.endswith(NOT_COUNTED)


def folder_of(path):
    return "/".join(path.parts[:2]) if len(path.parts) > 2 else path.parts[0]


def main():
    parser = argparse.ArgumentParser(prog="plugin/run coverage", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("modules", nargs="*", default=[], help=f"of: {' '.join(NEEDS)} (default: all)")
    parser.add_argument("--files", action="store_true", help="a line for each file, not for each folder")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    options = parser.parse_args()
    modules = options.modules or list(NEEDS)
    for module in modules:
        if module not in NEEDS:
            sys.exit(f"coverage: no module '{module}'; there are: {' '.join(NEEDS)}")

    needed = {name for module in modules for name in NEEDS[module]}
    run("cmake", "--preset", "coverage", f"-DPALPATE_MODULES={';'.join(m for m in ORDER if m in needed)}",
        stdout=subprocess.DEVNULL)
    targets = [f"{module}_tests" for module in modules]
    for target in (more for module in modules for more in MORE_TESTS.get(module, [])):
        if subprocess.run(["ninja", "-C", str(BUILD), "-t", "query", target], capture_output=True).returncode == 0:
            targets.append(target)
    run("ninja", "-C", BUILD, f"-j{options.jobs}", "--quiet", *targets)

    profiles, failed = BUILD / "profiles", []
    subprocess.run(["rm", "-rf", str(profiles)], check=True)
    for target in targets:
        # A file a process: some tests start programs, and some of those are killed. No limit of time: all of the tests are
        # in one process here, and one that is ended has counted nothing.
        environment = {**os.environ, "LLVM_PROFILE_FILE": str(profiles / f"{target}-%p.profraw"), "PALPATE_TEST_SECONDS": "0"}
        print(f"running {target}", file=sys.stderr, flush=True)
        code = subprocess.run([str(BUILD / "bin" / target), "--gtest_brief=1"], cwd=BUILD, env=environment,
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode
        if code != 0:
            failed.append(target)
    merged = profiles / "all.profdata"
    run("llvm-profdata-14", "merge", "--failure-mode=all", "-sparse", "-o", merged, *profiles.glob("*.profraw"))

    programs = [BUILD / "bin" / target for target in targets]
    programs += [program for program in (BUILD / "bin" / "palpate", BUILD / "bin" / "palpate-bench")
                 if "plugin" in modules and program.exists()]
    objects = [word for program in programs[1:] for word in ("-object", str(program))]
    text = subprocess.run(["llvm-cov-14", "export", "-summary-only", f"-instr-profile={merged}", str(programs[0]),
                           *objects], cwd=ROOT, check=True, capture_output=True, text=True).stdout
    rows = {}
    for file in json.loads(text)["data"][0]["files"]:
        path = (BUILD / file["filename"]).resolve()  # relative where ccache has made it so
        if not path.is_relative_to(ROOT) or path.is_relative_to(ROOT / "build"):
            continue
        path = path.relative_to(ROOT)
        if not is_counted(path, modules):
            continue
        row = rows.setdefault(str(path) if options.files else folder_of(path), [0, 0, 0, 0])
        summary = file["summary"]
        for at, kind in ((0, "lines"), (2, "branches")):
            row[at] += summary[kind]["covered"]
            row[at + 1] += summary[kind]["count"]

    def percent(covered, count):
        return f"{100 * covered / count:6.1f} %" if count else "       -"

    print(f"{'':<44}{'lines':>18}{'branches':>20}")
    total = [sum(row[n] for row in rows.values()) for n in range(4)]
    for name, row in [*sorted(rows.items()), ("together", total)]:
        print(f"{name:<44}{percent(row[0], row[1])} {'of ' + str(row[1]):<10}{percent(row[2], row[3])} of {row[3]}")
    if failed:
        sys.exit(f"coverage: failed meanwhile, so that less may have run: {' '.join(failed)}")


if __name__ == "__main__":
    main()

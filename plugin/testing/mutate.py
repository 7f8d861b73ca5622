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
import random
import re
import subprocess
import sys
import threading
import time

from mutants import MODULES, ROOT, all_enumerations, changed_lines, equivalents, git, is_mutated, mutants_by_line, sources
from mutate_account import SEEN, SURVIVED, Account, others_told, survivors_told
from mutate_bench import PLACES, Bench, serve, suites_near, target_of


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

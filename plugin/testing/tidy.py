#!/usr/bin/env python3
"""clang-tidy over the product's files, as a build folder compiles them: plugin/run's stage `tidy`.

    plugin/testing/tidy.py CLANG_TIDY BUILD_FOLDER [--since COMMIT] [FILE...]

Files that are compiled together are read together, because most of the time is what they include. clang's analyzer looks
for paths through solver, modes and device; over DCMTK's, Qt's and VTK's headers it would take an hour. With FILE, a part
of a path, only those. With --since only the folders in which a file differs from that commit's; all of them where the
repository does not have it. What was found good is not read again until it or something that it includes changes: what was read
and its contents' hashes stand in PALPATE_TIDY_CACHE (default ~/.cache/palpate/tidy).
"""

import concurrent.futures
import functools
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
OURS = f"{re.escape(str(ROOT))}/(solver|io|modes|device|plugin|testdata)/.*\\.(h|cpp)"
# haply_service: what it includes of Boost.Beast takes clang-tidy ten minutes.
NOT_READ = re.compile(r"_(test|benchmark)\.cpp$|/tests?/|_tests\.dir|/testing/|/peers/|/fuzz/|PalpatePanelTest|palpate_fake|haply_service")


CACHE = pathlib.Path(os.environ.get("PALPATE_TIDY_CACHE") or pathlib.Path.home() / ".cache" / "palpate" / "tidy")


def from_root(text):
    """The same wherever the tree lies."""
    return text.replace(str(ROOT), "")


@functools.cache
def hash_of(path):
    try:
        return hashlib.sha256(from_root(pathlib.Path(path).read_text(errors="surrogateescape")).encode(errors="surrogateescape")).hexdigest()
    except OSError:
        return None


def is_known_good(record):
    """Whether all that was read when it was found good is as it was then."""
    try:
        return all(hash_of(path.replace("@", str(ROOT), 1)) == hash for path, hash in json.loads(record.read_text()).items())
    except (OSError, ValueError):
        return False


def keep(record, dependencies):
    """Notes what was read: a list that the compiler wrote for make."""
    paths = dependencies.read_text().split(":", 1)[1].replace("\\\n", " ").split()
    record.parent.mkdir(parents=True, exist_ok=True)
    new = record.with_suffix(f".{os.getpid()}")
    new.write_text(json.dumps({path.replace(str(ROOT), "@", 1): hash_of(path) for path in paths}))
    new.replace(record)


def folder_of(path, build):
    """The module of a file, also of one that CMake wrote to include several; None where it is not ours."""
    if path.is_relative_to(build):
        return path.relative_to(build).parts[0] if path.parent.name == "Unity" else None
    return path.relative_to(ROOT).parts[0] if path.is_relative_to(ROOT) else None


def name_of(path):
    return "/" + path.relative_to(ROOT).as_posix()


def options_of(folder, path):
    # What is together is included as .cpp.
    checks = ["-bugprone-suspicious-include"]
    options = []
    if folder in ("solver", "modes", "device"):
        words = ["-analyzer-opt-analyze-headers"]
        if "scene" in path.name or "haply" in path.name:  # JSON's templates: shorter paths, or they take minutes
            words += ["-analyzer-config", "mode=shallow"]
        options = ["--extra-arg=-Wshadow", *(f"--extra-arg={part}" for word in words for part in ("-Xclang", word))]
    else:
        checks.append("-clang-analyzer-*")
    if folder in ("plugin", "testdata") or "scene" in path.name:
        # It reads the body of every function: over the templates of CLI11 and JSON that is half of all time.
        checks.append("-performance-unnecessary-value-param")
    if "paraview" in name_of(path):
        checks.append("-cppcoreguidelines-virtual-class-destructor")  # of VTK's classes, which count their users
    if "paraview_server" in name_of(path) or "paraview/server/" in name_of(path):
        checks += ["-readability-identifier-naming", "-bugprone-parent-virtual-call"]  # VTK's names, and its way
    return ["--checks=" + ",".join(checks), *options]


def changed_folders(commit):
    """The folders of the files that differ from a commit's, or None: all may."""
    if subprocess.run(["git", "cat-file", "-e", commit + "^{commit}"], cwd=ROOT, capture_output=True).returncode != 0:
        return None
    names = subprocess.run(["git", "diff", "--name-only", commit], cwd=ROOT, check=True, capture_output=True, text=True).stdout
    if ".clang-tidy" in names.split():
        return None
    return {(ROOT / name).parent for name in names.splitlines() if name.endswith((".h", ".cpp"))}


def folders_read(path, build):
    """The folders of what a file holds: its own, or those of the files that CMake wrote it to include."""
    if not path.is_relative_to(build):
        return {path.parent}
    return {pathlib.Path(name).parent for name in re.findall(r'^#include "(.*\.cpp)"', path.read_text(), re.MULTILINE)}


def main():
    program, build, *only = sys.argv[1:]
    since = only[1] if only[:1] == ["--since"] else None
    only = only[2:] if since else only
    build = (ROOT / build).resolve()
    entries = {pathlib.Path(entry["file"]).resolve(): entry["command"] for entry in json.loads((build / "compile_commands.json").read_text())}
    work = [(path, folder) for path in entries if (folder := folder_of(path, build)) and not NOT_READ.search(name_of(path))]
    work = [(path, folder) for path, folder in work if not only or any(part in name_of(path) for part in only)]
    if not work:
        sys.exit("tidy.py: there is no file to read")
    changed = changed_folders(since) if since else None
    if changed is not None:
        work = [(path, folder) for path, folder in work if folders_read(path, build) & changed]
    work.sort(key=lambda one: (one[0].parent.name != "Unity", str(one[0])))  # the long ones first
    version = subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout
    rules = version + (ROOT / ".clang-tidy").read_text()

    def look(one):
        path, folder = one
        began = time.monotonic()
        options = [f"--header-filter={OURS}", *options_of(folder, path)]
        asked = from_root("\0".join([rules, name_of(path), entries[path], *options]))
        record = CACHE / hashlib.sha256(asked.encode()).hexdigest()
        if is_known_good(record):
            return path, None, 0
        with tempfile.TemporaryDirectory() as folder:
            read = pathlib.Path(folder) / "read"
            command = [program, "--quiet", "-p", build, *options, f"--extra-arg=-Wp,-MD,{read}", path]
            done = subprocess.run(list(map(str, command)), cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            if done.returncode == 0 and read.exists():
                keep(record, read)
        return path, done, time.monotonic() - began

    failed = good = 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for number, (path, done, seconds) in enumerate(pool.map(look, work), 1):
            if done is None:
                good += 1
                continue
            print(f"[{number}/{len(work)}] {path.relative_to(ROOT)}: {seconds:.0f} s", flush=True)
            if done.returncode != 0:
                failed += 1
                print(done.stdout, done.stderr, sep="\n", flush=True)
    print(f"{len(work)} read: {good} of them as they were when found good, {failed} with findings")
    sys.exit(failed > 0)


if __name__ == "__main__":
    main()

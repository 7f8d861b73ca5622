"""Scenes that last, in ParaView itself: a state file restored by another program and loaded in one that runs, a trace replayed in pvpython, undo.

Arguments as in panel_program.py.
"""

import os

import patience
from panel_program import PLUGINS, SCRATCH, TEST_PLUGIN, ball, main, phantom, run, scratch

MOST_LEFT_BYTES = 170000  # a round; a third of the phantom's voxels


def same(one, other):
    """Whether two runs wrote the same files, to the last byte."""
    for what in "scene.json", "layout.txt", "stroke.txt":
        texts = [open(scratch(f"story-{run}-{what}")).read() for run in (one, other)]
        if texts[0] == texts[1] and texts[0].strip():
            continue
        lines = [text.splitlines() for text in texts]
        differing = [pair for pair in zip(*lines) if pair[0] != pair[1]]
        print(f"{what}: {len(lines[0])} and {len(lines[1])} lines, {len(differing)} differ: {differing[:3]}")
        return False
    return True


def saved_and_restored():
    folder = ball()
    return (run("a_session_is_saved", folder)
            and run("a_session_is_restored", arguments=["--state=" + scratch("story.pvsm")])
            and same("saved", "restored")
            and run("a_session_is_loaded", phantom("other", "slab"))
            and same("restored", "loaded"))


REPLAY = """
from paraview import servermanager, simple
simple.LoadPlugin({plugin!r}, remote=True, ns=globals())
exec(compile(open({trace!r}).read(), {trace!r}, "exec"))
sources = {{proxy.GetXMLName(): proxy for proxy in simple.GetSources().values()}}
open({out!r} + "-scene.json", "w").write(sources["PalpateScene"].Scene)
forces = servermanager.Fetch(sources["PalpateForceProfile"]).GetColumnByName("Force vector (N)")
with open({out!r} + "-stroke.txt", "w") as file:
    for n in range(forces.GetNumberOfTuples()):
        file.write(" " + " ".join("%.17g" % x for x in forces.GetTuple3(n)) + "\\n")
"""


def traced_and_replayed():
    if not run("a_session_is_traced", PALPATE_DROP=ball()):
        return False
    server = os.path.join(os.path.dirname(PLUGINS), "Palpate", "Palpate.so")
    script = scratch("story-replay.py")
    with open(script, "w") as file:
        file.write(REPLAY.format(plugin=server, trace=scratch("story-trace.py"), out=scratch("story-replayed")))
    done = patience.run(["pvpython", "--force-offscreen-rendering", script], 150)
    if done.returncode != 0:
        print(f"traced: FAILED: the trace does not run in pvpython:\n{done.stdout[:1500]}\n...\n{done.stdout[-1500:]}")
        return False
    for what in "scene.json", "stroke.txt":
        if open(scratch("story-traced-" + what)).read() != open(scratch("story-replayed-" + what)).read():
            print(f"traced: FAILED: the trace gives another {what}")
            return False
    print("traced: the trace gives the same scene and forces")
    return True


def grown(scenario, **how):
    """Bytes of live heap a round, between two rounds of a program of its own; None where it fails."""
    first, last = (int(n) for n in os.environ.get("PALPATE_ROUNDS", "3,8").split(","))
    said = []
    if not run(scenario, longest_s=400 + 60 * last, said=said, PALPATE_ROUNDS=f"{first},{last}", **how):
        return None
    held = [int(line.split()[-2]) for line in said if "after round" in line]
    return (held[1] - held[0]) / (last - first)


def rounds_leave_nothing():
    """Of the panel's own: less a round than what ParaView keeps without it, and a third of a phantom's voxels."""
    probing = grown("rounds_of_probing", PALPATE_DROP=ball())
    without = grown("without_the_panel", plugins=[TEST_PLUGIN])
    if probing is None or without is None:
        return False
    print(f"heap: {probing / 1e3:.0f} kB a round with the panel, {without / 1e3:.0f} kB without it", flush=True)
    return probing - without < MOST_LEFT_BYTES


main({
    "undone": lambda: run("twenty_edits_are_undone", ball()),
    "saved": saved_and_restored,
    "traced": traced_and_replayed,
}, {  # a measurement
    "heap": rounds_leave_nothing,
})

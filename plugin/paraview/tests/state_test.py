"""The plug-in's sources and filters are ParaView's like any other: state files, Python traces, undo, time."""

import json
import os
import sys

import patience
from palpate_test import (PLUGIN, PROGRAMS, SCRATCH, core_info, expect, expect_all_near, expect_near, fetch, main,
                          open_series, phantom, run)
from paraview import servermanager, simple, smtrace
from paraview.modules.vtkRemotingServerManager import vtkSMProxyManager, vtkSMUndoStack, vtkSMUndoStackBuilder


def scene_of(newtons):
    return json.dumps({"version": 1, "name": "one surface", "modes": [
        {"type": "surface", "name": "skin", "side": "entering",
         "strength_n": {"of": "gradient_per_mm", "nodes": [[20, 0], [100, newtons]]}}]})


def build(scene):
    """A reader and every filter, with nothing left as it is by default."""
    reader = open_series(phantom("oblique"), core_info(phantom("oblique"))["uid"])
    reader.UpdatePipeline()
    fields = simple.PalpateFields(Input=reader, Gradient=1, Scalemm=2.5, Mode="skin", Scene=scene)
    surface = simple.PalpateTissueSurface(Input=reader, Values=[-480, -200])
    profile = simple.PalpateForceProfile(Input=reader, From=[-22, 3, 1], To=[5, -2, 0], Speedmms=80, Scene=scene)
    for proxy in (fields, surface, profile):
        proxy.UpdatePipeline()


def results():
    """What the sources of the session give, by the kind of their proxy."""
    found = {}
    for proxy in simple.GetSources().values():
        proxy.UpdatePipeline()
        kind, data = proxy.GetXMLName(), fetch(proxy)
        if kind == "PalpateDicomReader":
            found[kind] = [*data.GetBounds(), *data.GetPointData().GetArray("HU").GetRange()]
        elif kind == "PalpateFields":
            found[kind] = [x for name in ("Gradient magnitude", "Felt strength") for x in data.GetPointData().GetArray(name).GetRange()]
        elif kind == "PalpateTissueSurface":
            found[kind] = [data.GetNumberOfPoints(), *data.GetBounds()]
        else:
            forces = data.GetColumnByName("Force (N)")
            found[kind] = [forces.GetValue(n) for n in range(0, forces.GetNumberOfTuples(), 10)]
    return found


def expect_same(found, wanted, what):
    expect(sorted(found) == sorted(wanted) and len(wanted) == 4, f"{what}: {sorted(found)}")
    for kind, numbers in wanted.items():
        expect_all_near(found[kind], numbers, 0, f"{what}: {kind}")


def a_state_file_brings_everything_back():
    build(scene_of(1.25))
    wanted = results()
    expect_near(wanted["PalpateFields"][3], 1.25, 1e-6, "strongest felt strength")
    state = os.path.join(SCRATCH, "whole.pvsm")
    simple.SaveState(state)
    simple.ResetSession()
    expect(not simple.GetSources(), "the session is not empty")
    simple.LoadState(state)
    expect_same(results(), wanted, "after a state file")


def a_trace_does_the_same_again():
    config = smtrace.start_trace()
    config.SetFullyTraceSupplementalProxies(False)
    build(scene_of(0.75))
    trace = smtrace.stop_trace()
    wanted = results()
    expect("PalpateFields" in trace and "PalpateForceProfile" in trace, f"the trace is\n{trace}")
    script, out = os.path.join(SCRATCH, "trace.py"), os.path.join(SCRATCH, "trace.json")
    with open(script, "w") as file:
        file.write("import json, sys\nfrom paraview import simple\n"
                   f"simple.LoadPlugin({PLUGIN!r}, remote=True, ns=globals())\n{trace}\n"
                   f"sys.argv[1:] = {[PROGRAMS, PLUGIN, SCRATCH]!r}\nsys.path.insert(0, {os.path.dirname(os.path.abspath(__file__))!r})\n"
                   f"import state_test\njson.dump(state_test.results(), open({out!r}, 'w'))\n")
    done = patience.run(["pvpython", "--force-offscreen-rendering", script], 120)
    assert done.returncode == 0, done.stdout[-3000:]
    with open(out) as file:
        expect_same(json.load(file), wanted, "after the trace")


def edits_are_undone_and_redone():
    # As the program does it: its undo stack records what a set of changes does to proxies.
    manager, stack, builder = vtkSMProxyManager.GetProxyManager(), vtkSMUndoStack(), vtkSMUndoStackBuilder()
    stack.SetStackDepth(20)
    builder.SetUndoStack(stack)
    manager.SetUndoStackBuilder(builder)
    try:
        reader = open_series(phantom("straight"))
        fields = simple.PalpateFields(Input=reader, Scene=scene_of(0.0))
        surface = simple.PalpateTissueSurface(Input=reader, Values=[-480])

        def strongest():
            return fetch(fields).GetPointData().GetArray("Felt strength").GetRange()[1]

        def step(back):
            done = stack.Undo() if back else stack.Redo()
            servermanager.ProxyManager().SMProxyManager.UpdateRegisteredProxies(1)  # as the program does next
            return done == 1

        for n in range(1, 21):
            builder.Begin(f"edit {n}")
            fields.Scene = scene_of(n / 10)
            surface.Values = [-480 + n]
            builder.End()
            builder.PushToStack()
        expect_near(strongest(), 2.0, 1e-6, "after 20 edits")
        for n in range(19, -1, -1):
            expect(step(back=True), f"undo to {n}")
            expect(fields.Scene == scene_of(n / 10) and list(surface.Values) == [-480 + n], f"the text of edit {n}")
        expect_near(strongest(), 0.0, 1e-6, "after undoing all")
        expect(step(back=False), "redo")
        expect_near(strongest(), 0.1, 1e-6, "after redoing one")
    finally:
        manager.SetUndoStackBuilder(None)


def felt_strength_follows_the_scenes_text():
    fields = simple.PalpateFields(Input=open_series(phantom("straight")))
    for newtons in (0.5, 1.5, 0.25):
        fields.Scene = scene_of(newtons)
        expect_near(fetch(fields).GetPointData().GetArray("Felt strength").GetRange()[1], newtons, 1e-6, "strongest")
    file = os.path.join(SCRATCH, "felt.json")
    with open(file, "w") as out:
        out.write(scene_of(0.9))
    fields.Scene = file
    expect_near(fetch(fields).GetPointData().GetArray("Felt strength").GetRange()[1], 0.9, 1e-6, "of a scene's file")


def images_of_several_times_are_time_steps():
    folder = os.path.join(SCRATCH, "flow")
    if not os.path.isdir(folder):
        run("palpate-testdata", "flow", "-o", folder, "--size", "16,16,16", "--spacing", "6,6,6", "--times", "3")
    series = [s for s in json.loads(run("palpate", "info", folder, "--json"))["series"] if s["frames_per_position"] == 3]
    expect(len(series) > 0, "no series of three times")
    reader = open_series(folder, series[-1]["uid"])
    reader.UpdatePipelineInformation()
    expect(list(reader.TimestepValues) == [0, 1, 2], f"time steps {reader.TimestepValues}")
    ranges = []
    for time in (0, 1, 2, 0.6, 7):
        reader.UpdatePipeline(time)
        ranges.append(servermanager.Fetch(reader).GetPointData().GetScalars().GetRange())
    expect(len(set(ranges[:3])) == 3, f"times look alike: {ranges}")
    expect(ranges[3] == ranges[1] and ranges[4] == ranges[2], f"between and after the steps: {ranges}")


if __name__ == "__main__":
    main([a_state_file_brings_everything_back, a_trace_does_the_same_again, edits_are_undone_and_redone,
          felt_strength_follows_the_scenes_text, images_of_several_times_are_time_steps])

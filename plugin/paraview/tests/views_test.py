"""The clinician's layout from within ParaView: letters, cameras, places under the pointer, values and pixels agree.

Runs in plain Python 3 under xvfb-run with the folder of the built programs, the plug-ins' list and a scratch folder as
arguments; starts ParaView with itself as the script.
"""

import ctypes
import json
import os
import random
import re
import shutil
import subprocess
import sys
import time
import traceback

import patience

INSIDE = os.environ.get("PALPATE_VIEWS_TEST")
PROGRAMS, PLUGINS, SCRATCH = json.loads(INSIDE) if INSIDE else sys.argv[1:4]
FOLDER, RESULT = os.path.join(SCRATCH, "views-wedge"), os.path.join(SCRATCH, "views.txt")
LEVEL, WIDTH = 300, 2800
PHANTOM = ["wedge", "--size", "72,64,56", "--spacing", "0.9,1,1.1", "--orientation", "0.8,0.6,0,-0.48,0.64,0.6",
           "--window", f"{LEVEL},{WIDTH}"]
LETTERS = {"L": (0, 1), "R": (0, -1), "P": (1, 1), "A": (1, -1), "H": (2, 1), "F": (2, -1)}


def expect(condition, message):
    if not condition:
        raise AssertionError(message)


def run_events(seconds):
    # ParaView's own, which is in this process already.
    with open("/proc/self/maps") as maps:
        qt = ctypes.CDLL(next(line.split()[-1] for line in maps if re.search(r"libQt[56]Core\.so", line)))
    process = qt._ZN16QCoreApplication13processEventsE6QFlagsIN10QEventLoop17ProcessEventsFlagEEi
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        process(0, 20)


class View:
    """One view, as a person meets it: texts, pixels, the mouse."""

    def __init__(self, proxy):
        self.window, self.interactor = proxy.GetRenderWindow(), proxy.GetInteractor()
        self.view = proxy.GetClientSideView()
        self.size = self.window.GetSize()

    def texts(self):
        props = self.view.GetNonCompositedRenderer().GetViewProps()
        return [p for p in (props.GetItemAsObject(n) for n in range(props.GetNumberOfItems())) if p.IsA("vtkTextActor")]

    def letters(self):
        """At the right, left, top and bottom edge."""
        return [text.GetInput() for text in self.texts()[:4]]

    def corner(self):
        return self.texts()[4].GetInput()

    def mouse(self, event, at):
        self.interactor.SetEventInformation(*at, 0, 0, "\0", 0, None)
        self.interactor.InvokeEvent(event)

    def under(self, at):
        """Place (L, P, H; mm) and value (or None) that are told of a pixel."""
        self.mouse("MouseMoveEvent", at)
        text = self.texts()[5].GetInput()
        found = re.fullmatch(r"([LR]) ([\d.]+) ([PA]) ([\d.]+) ([HF]) ([\d.]+) mm(?:   (-?[\d.]+) HU)?", text)
        expect(found, f"under the pointer it says {text!r}")
        place = [LETTERS[found[n]][1] * float(found[n + 1]) for n in (1, 3, 5)]
        return place, None if found[7] is None else float(found[7])

    def gray(self, at):
        from paraview.vtk import vtkUnsignedCharArray
        pixels = vtkUnsignedCharArray()
        self.window.Render()
        self.window.GetPixelData(*at, *at, 0, pixels, 0)
        return pixels.GetTuple(0)


def expect_letters_agree(name, view):
    """What a letter says lies that way: the place told grows in its direction, and in no other as fast."""
    x, y = view.size[0] // 2, view.size[1] // 2
    letters = view.letters()
    for letter, (dx, dy) in zip(letters, ((40, 0), (-40, 0), (0, 40), (0, -40))):
        expect(letter and all(c in LETTERS for c in letter), f"{name}: letters {letters}")
        (a, _), (b, _) = view.under((x, y)), view.under((x + dx, y + dy))
        moved = [q - p for p, q in zip(a, b)]
        axis, sign = LETTERS[letter[0]]
        expect(sign * moved[axis] > 0 and abs(moved[axis]) == max(map(abs, moved)), f"{name}: towards {letter} it is {moved}")
        for second in letter[1:]:
            axis, sign = LETTERS[second]
            expect(sign * moved[axis] > 0, f"{name}: towards {letter} it is {moved}")
    print(f"{name}: {letters}")


def expect_values_and_pixels_agree(name, view):
    random.seed(2)
    points = [tuple(int(random.uniform(0.25, 0.75) * s) for s in view.size) for _ in range(40)]
    told = [(at, *view.under(at)) for at in points]
    places = [f"--at={','.join(map(str, place))}" for _, place, _ in told]
    core = json.loads(subprocess.run([os.path.join(PROGRAMS, "palpate"), "sample", FOLDER, "--json", *places], check=True,
                                     capture_output=True, text=True).stdout)
    seen = set()
    for (at, place, value), sample in zip(told, core):
        if sum(g * g for g in sample.get("gradient_per_mm", [1e9])) > 1:
            continue  # at an edge the place as written, to a tenth of a millimeter, is not the pixel's
        expect(value is not None and abs(value - sample["value"]) < 1, f"{name} at {place}: told {value}, core {sample}")
        gray = 255 * min(max((value - LEVEL) / WIDTH + 0.5, 0), 1)
        pixel = view.gray(at)
        expect(max(abs(c - gray) for c in pixel) < 4, f"{name} at {at}: pixel {pixel} for {value} HU, not {gray:.0f}")
        seen.add(value)
    expect(len(seen) >= 2, f"{name}: only {seen} HU seen")
    print(f"{name}: {len(told)} places, values {sorted(seen)}")


def expect_the_mouse_works(view):
    corner = view.corner()
    expect(f"W {WIDTH}  L {LEVEL}" in corner, f"the series' own window is not shown: {corner!r}")
    number = int(re.search(r"(\d+) / ", corner)[1])
    view.mouse("MouseWheelForwardEvent", (100, 100))
    expect(f"{number + 1} / " in view.corner(), f"the wheel led from {corner!r} to {view.corner()!r}")
    view.mouse("MouseWheelBackwardEvent", (100, 100))
    view.mouse("LeftButtonPressEvent", (100, 100))
    view.mouse("MouseMoveEvent", (160, 100))
    view.mouse("LeftButtonReleaseEvent", (160, 100))
    width = float(re.search(r"W (\d+)", view.corner())[1])
    expect(width > 1.1 * WIDTH and f"L {LEVEL}" in view.corner(), f"a drag to the right made it {view.corner()!r}")


def expect_the_marker_agrees(view):
    view.window.Render()
    at = {text.GetInput(): text.GetPosition() for text in view.texts()}
    expect(sorted(at) == sorted(LETTERS), f"the marker says {sorted(at)}")
    expect(at["H"][1] > at["F"][1] and at["L"][0] > at["R"][0], f"seen from the front: {at}")
    camera = view.view.GetActiveCamera()
    camera.Azimuth(180)
    view.window.Render()
    at = {text.GetInput(): text.GetPosition() for text in view.texts()}
    expect(at["H"][1] > at["F"][1] and at["L"][0] < at["R"][0], f"seen from behind: {at}")
    camera.Azimuth(180)


def check():
    from paraview import servermanager
    waited = patience.Patience(90)
    views = {}
    while len(views) < 4 or "" in views["Axial"].letters():
        expect(not waited.is_over(), f"the scan is not shown: views {sorted(views)}")
        run_events(1)
        proxies = servermanager.ProxyManager().GetProxiesInGroup("views")
        views = {key[0]: View(proxy.SMProxy) for key, proxy in proxies.items() if key[0] in ("Axial", "Coronal", "Sagittal", "Volume")}
    run_events(2)
    views = {name: View(proxies[key].SMProxy) for key in proxies for name in [key[0]] if name in views}
    for name in ("Axial", "Coronal", "Sagittal"):
        expect_letters_agree(name, views[name])
        expect_values_and_pixels_agree(name, views[name])
    expect_the_mouse_works(views["Axial"])
    expect_the_marker_agrees(views["Volume"])


def inside():
    try:
        check()
        told = "passed"
    except BaseException:
        told = traceback.format_exc()
    with open(RESULT, "w") as file:
        file.write(told)
    sys.stdout.flush()
    os._exit(0)  # closing the program is another test's


def outside():
    for old in (FOLDER, os.path.join(SCRATCH, "views-home")):
        shutil.rmtree(old, ignore_errors=True)
    if os.path.exists(RESULT):
        os.remove(RESULT)
    subprocess.run([os.path.join(PROGRAMS, "palpate-testdata"), "phantom", *PHANTOM, "-o", FOLDER], check=True)
    os.makedirs(os.path.join(SCRATCH, "views-home"))
    environment = dict(os.environ, PALPATE_OPEN=FOLDER, PV_PLUGIN_CONFIG_FILE=PLUGINS, LIBGL_ALWAYS_SOFTWARE="1",
                       PYTHONPATH=os.path.dirname(os.path.abspath(__file__)),
                       HOME=os.path.join(SCRATCH, "views-home"), PALPATE_VIEWS_TEST=json.dumps([PROGRAMS, PLUGINS, SCRATCH]))
    done = patience.run(["paraview", f"--script={os.path.abspath(__file__)}"], 240, env=environment)
    print(done.stdout[-3000:])
    told = open(RESULT).read() if os.path.exists(RESULT) else f"ParaView ended with {done.returncode}"
    print(told)
    sys.exit(told != "passed")


inside() if INSIDE else outside()

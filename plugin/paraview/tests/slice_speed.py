"""How fast slices of a CT of 512 x 512 x 140 move: run by hand, prints a table.

    xvfb-run -a pvpython plugin/paraview/tests/slice_speed.py build/bin \\
        build/lib/paraview-5.11/plugins/Palpate/Palpate.so build/plugin/paraview/tests/scratch

The views are set up as the clinician's layout sets them up: ParaView's slice representation, a gray map, 300 x 300.
"""

import time

from palpate_test import PHANTOMS, PLUGIN, open_series, phantom
from paraview import simple

PHANTOMS["ct"] = ["shell", "--radius", "80", "--size", "512,512,140", "--spacing", "0.5,0.5,1.2", "--noise", "20"]
PLANES = {"axial": ("XY Plane", 140), "coronal": ("XZ Plane", 512), "sagittal": ("YZ Plane", 512)}
MOVES = 60


def slice_view(reader, mode):
    view = simple.CreateView("RenderView")
    view.ViewSize, view.CameraParallelProjection, view.UseFXAA = [300, 300], 1, 0
    shown = simple.Show(reader, view, "UniformGridRepresentation")
    shown.SetRepresentationType("Slice")
    shown.SliceMode = mode
    simple.ColorBy(shown, ("POINTS", "HU"))
    simple.ResetCamera(view)
    simple.Render(view)
    return view, shown


simple.LoadPlugin(PLUGIN, remote=False, ns=vars(simple))
reader = open_series(phantom("ct"))
reader.UpdatePipeline()
print("plane      Hz, median   slowest of %d, ms   processor time of one, ms (all cores; independent of the machine's load)" % MOVES)
for name, (mode, slices) in PLANES.items():
    view, shown = slice_view(reader, mode)
    taken, busy = [], time.process_time()
    for n in range(MOVES):
        shown.Slice = slices // 4 + n * slices // (2 * MOVES)
        began = time.perf_counter()
        simple.Render(view)
        taken.append(time.perf_counter() - began)
    busy = (time.process_time() - busy) / MOVES
    taken.sort()
    print(f"{name:9}  {1 / taken[MOVES // 2]:10.1f}   {1000 * taken[-1]:17.0f}   {1000 * busy:12.0f}")

"""In ParaView's own window, after a fresh installation: the plug-in is there, its panel too, and a phantom opens and is seen."""

import os
import traceback


def seen():
    from paraview import simple

    assert hasattr(simple, "PalpateDICOMSeries"), "the reader is not loaded"
    scan = simple.PalpateDICOMSeries(FileName="/root/phantom")
    scan.UpdatePipeline()
    extent = scan.GetDataInformation().GetExtent()
    assert tuple(extent) == (0, 31, 0, 31, 0, 31), f"the phantom's extent is {extent}"
    with open("/proc/self/maps", encoding="utf-8") as maps:
        assert any(line.rstrip().endswith("/PalpatePanel.so") for line in maps), "the panel is not loaded"
    view = simple.GetActiveViewOrCreate("RenderView")
    simple.Show(scan, view)
    simple.Render(view)


with open("/root/loaded.txt", "w", encoding="utf-8") as said:
    try:
        seen()
        said.write("passed\n")
    except BaseException:  # whatever it is, the test reads it
        said.write(traceback.format_exc())
os._exit(0)

"""A tissue's surface beside ParaView's Contour, in turn in one run: run by hand, prints a table.

    build/bin/palpate-testdata phantom sphere --radius 120 --size 512,512,248 --spacing 0.7,0.7,1.2 --noise 15 -o /tmp/ct
    pvpython plugin/paraview/tests/surface_speed.py build/lib/paraview-5.11/plugins/Palpate/Palpate.so /tmp/ct [VALUE]

Of five runs each, the least seconds and the least of a processor, and the memory that the first of them took at most
beyond what was held. Both give normals; the tissue surface gives each point's value, too.
"""

import resource
import sys
import time

from paraview import simple

RUNS = 5


def processor_seconds():
    usage = resource.getrusage(resource.RUSAGE_SELF)
    return usage.ru_utime + usage.ru_stime


def memory_mib(what):
    with open("/proc/self/status") as file:
        return next(int(line.split()[1]) for line in file if line.startswith(what)) / 1024


def peak_mib(run):
    """Memory that a call takes at most beyond what is held before it."""
    with open("/proc/self/clear_refs", "w") as file:
        file.write("5")  # the peak counts anew
    held = memory_mib("VmRSS")
    run()
    return memory_mib("VmHWM") - held


def main():
    plugin, series = sys.argv[1:3]
    simple.LoadPlugin(plugin, remote=False, ns=vars(simple))
    reader = simple.PalpateDICOMSeries(FileName=series)
    reader.UpdatePipeline()
    scalars = reader.GetClientSideObject().GetOutputDataObject(0).GetPointData().GetScalars()
    # pvpython doubles the sign of a negative value.
    value = float(sys.argv[3].replace("--", "-")) if len(sys.argv) > 3 else sum(scalars.GetRange()) / 2
    makers = {"tissue surface": lambda: simple.PalpateTissueSurface(Input=reader, Values=[value]),
              "Contour": lambda: simple.Contour(Input=reader, ContourBy=["POINTS", scalars.GetName()], Isosurfaces=[value])}
    least, most = {}, {}
    for _ in range(RUNS):
        for name, make in makers.items():
            proxy = make()
            began, processor = time.monotonic(), processor_seconds()
            peak = peak_mib(proxy.UpdatePipeline)
            times = (time.monotonic() - began, processor_seconds() - processor)
            least[name] = tuple(map(min, times, least.get(name, times)))
            most.setdefault(name, (proxy.GetClientSideObject().GetOutputDataObject(0).GetNumberOfCells(), peak))
            simple.Delete(proxy)
            del proxy
    for name, (seconds, processor) in least.items():
        triangles, peak = most[name]
        print(f"{name:15} {seconds:6.2f} s {processor:6.2f} s of a processor {peak:6.0f} MiB at most {triangles:9} triangles")
    ours, theirs = least.values()
    print(f"tissue surface / Contour: {ours[0] / theirs[0]:.2f}, of a processor {ours[1] / theirs[1]:.2f}")


main()

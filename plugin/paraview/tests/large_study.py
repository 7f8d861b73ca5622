"""What a scan of gigabytes takes on two ranks: run by hand, writes the scan under build/ and prints a table.

    python3 plugin/paraview/tests/large_study.py build/bin build/lib/paraview-5.11/plugins/Palpate/Palpate.so build/large \\
        [--slices 4096] [--ranks 2] [--felt 1]

Each slice is 512 x 512 of 16 bits: 4096 of them are 2 GiB. Every rank tells its part, its memory and its time after
each step. Nothing is rendered. --felt 0 leaves the fields out, which take most of the time.
"""

import json
import os
import subprocess
import sys
import time

EDGE = 512
SCENE = json.dumps({"version": 1, "name": "one surface", "modes": [
    {"type": "surface", "name": "skin", "side": "entering",
     "strength_n": {"of": "gradient_per_mm", "nodes": [[20, 0], [200, 1.5]]}}]})


def elements(data, at):
    """(tag, where it begins, where its value is, where it ends) of a data set in explicit little endian."""
    while at < len(data):
        tag = data[at:at + 2][::-1] + data[at + 2:at + 4][::-1]
        head = at
        if data[at + 4:at + 6] in (b"OB", b"OW", b"SQ", b"UN", b"UT", b"UC", b"OF", b"UR"):
            value, length = at + 12, int.from_bytes(data[at + 8:at + 12], "little")
        else:
            value, length = at + 8, int.from_bytes(data[at + 6:at + 8], "little")
        if length == 0xFFFFFFFF:
            raise ValueError("a sequence of unknown length")
        at = value + length
        yield tag.hex(), head, value, at


def write_series(programs, folder, slices):
    """A few slices of a sphere, over and over with positions of their own: quick, and as large as is wanted."""
    few = 64
    model = folder.rsplit("-", 1)[0] + "-model"
    if not os.path.isdir(model):
        subprocess.run([os.path.join(programs, "palpate-testdata"), "phantom", "sphere", "--radius", "25", "--size",
                        f"{EDGE},{EDGE},{few}", "--noise", "15", "-o", model], check=True)
    os.makedirs(folder)
    files = []
    for name in sorted(os.listdir(model)):
        with open(os.path.join(model, name), "rb") as file:
            data = file.read()
        files.append((data, list(elements(data, 132))))
    for n in range(slices):
        data, found = files[n % few]
        texts = {"00020003": f"2.25.1{n:09d}", "00080018": f"2.25.1{n:09d}", "00200013": str(n + 1),
                 "00200032": f"-255.5\\-255.5\\{n - slices // 2}"}
        out, at = [], 0
        for tag, head, value, end in found:
            if tag in texts:
                text = texts[tag].encode()
                text += b"\0" * (len(text) % 2) if tag in ("00020003", "00080018") else b" " * (len(text) % 2)
                out += [data[at:head], data[head:head + 6], len(text).to_bytes(2, "little"), text]
                at = end
            elif tag == "00020000":  # length of the group: left out, as the standard allows readers to expect
                out.append(data[at:head])
                at = end
        out.append(data[at:])
        with open(os.path.join(folder, f"{n:05d}.dcm"), "wb") as file:
            file.write(b"".join(out))


def memory_mib(what):
    with open("/proc/self/status") as file:
        return next(int(line.split()[1]) for line in file if line.startswith(what)) / 1024


def on_a_rank(plugin, folder, felt):
    from paraview import simple
    from vtkmodules.vtkParallelCore import vtkMultiProcessController
    simple.LoadPlugin(plugin, remote=False, ns=vars(simple))
    rank = vtkMultiProcessController.GetGlobalController().GetLocalProcessId()
    start = memory_mib("VmRSS")

    def tell(step, proxy, began):
        data = proxy.GetClientSideObject().GetOutputDataObject(0)
        what = data.GetExtent() if data.IsA("vtkImageData") else f"{data.GetNumberOfCells()} triangles"
        print(f"rank {rank}  {step:15} {str(what):36} {memory_mib('VmRSS') - start:8.0f} {memory_mib('VmHWM') - start:8.0f}"
              f" {time.monotonic() - began:7.1f}", flush=True)

    began = time.monotonic()
    reader = simple.PalpateDICOMSeries(FileName=folder)
    reader.UpdatePipelineInformation()
    tell("headers", reader, began)
    steps = [("read", lambda: reader), ("surface", lambda: simple.PalpateTissueSurface(Input=reader, Values=[-480]))]
    if felt:
        steps.append(("felt strength", lambda: simple.PalpateFields(Input=reader, GradientMagnitude=0, Scene=SCENE)))
    for step, make in steps:
        began = time.monotonic()
        proxy = make()
        proxy.UpdatePipeline()
        tell(step, proxy, began)


def main():
    programs, plugin, folder = (os.path.abspath(a) for a in sys.argv[1:4])
    options = dict(zip(sys.argv[4::2], map(int, sys.argv[5::2])))
    slices, ranks = options.get("--slices", 4096), options.get("--ranks", 2)
    series = f"{folder}-{slices}"
    if not os.path.isdir(series):
        write_series(programs, series, slices)
    print(f"{EDGE} x {EDGE} x {slices}: {EDGE * EDGE * slices / 2**29:.2f} GiB of voxels, {ranks} ranks\n"
          f"        step            part                                  now, MiB  most, MiB   time, s")
    environment = dict(os.environ, PALPATE_LARGE=json.dumps([plugin, series, options.get("--felt", 1)]), PYTHONDONTWRITEBYTECODE="1")
    done = subprocess.run(["mpiexec", "--allow-run-as-root", "--oversubscribe", "-n", str(ranks), "pvbatch", "--sym",
                           "--force-offscreen-rendering", os.path.abspath(__file__)], env=environment, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    lines = done.stdout.splitlines()
    print("\n".join(sorted(line for line in lines if line.startswith("rank"))))
    if done.returncode != 0:
        print("\n".join(lines[-20:]))
        sys.exit(1)


if os.environ.get("PALPATE_LARGE"):
    on_a_rank(*json.loads(os.environ["PALPATE_LARGE"]))
else:
    main()

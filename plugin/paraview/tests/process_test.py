"""What the plug-in brings into ParaView's process: one copy of the voxels, given back; no second VTK."""

import os

from palpate_test import PHANTOMS, expect, fetch, main, open_series, phantom
from paraview import simple

PHANTOMS["large"] = ["sphere", "--radius", "40", "--size", "320,320,160"]
PHANTOMS["small"] = ["sphere", "--radius", "40", "--size", "160,160,120"]
VOXELS = {"large": 320 * 320 * 160, "small": 160 * 160 * 120}


def resident_bytes():
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def held():
    """Voxels in the store, bytes, and arrays that view them: as a reader that reads nothing tells."""
    teller = simple.PalpateDICOMSeries()
    use = [teller.GetProperty(name) for name in ("StoredScans", "StoredBytes", "SharedArrays")]
    for value in use:
        teller.SMProxy.UpdatePropertyInformation(value.SMProperty)
    numbers = [value[0] for value in use]
    simple.Delete(teller)
    return numbers


def open_and_close(name):
    reader = open_series(phantom(name))
    reader.UpdatePipeline()
    expect(reader.GetDataInformation().GetNumberOfPoints() == VOXELS[name], f"the {name} phantom")
    simple.Delete(reader)


def voxels_are_held_once():
    open_and_close("large")  # what DCMTK and ParaView keep for ever is there now
    before, voxel_bytes = resident_bytes(), 2 * VOXELS["large"]
    readers = [open_series(phantom("large")) for _ in range(2)]
    for reader in readers:
        reader.UpdatePipeline()
    scans, stored, arrays = held()
    expect((scans, stored) == (1, voxel_bytes) and arrays >= 2, f"{scans} scans of {stored} bytes, {arrays} arrays")
    grown = resident_bytes() - before
    print(f"  two readers of {voxel_bytes / 1e6:.1f} MB of voxels: {grown / 1e6:.1f} MB more")
    expect(grown < 1.25 * voxel_bytes, f"{grown} bytes for {voxel_bytes} bytes of voxels shown twice")


def fifty_rounds_leave_nothing():
    open_and_close("small")
    before = resident_bytes()
    for _ in range(50):
        open_and_close("small")
    expect(held() == [0, 0, 0], f"still held: {held()}")
    grown = resident_bytes() - before
    print(f"  50 rounds of {2 * VOXELS['small'] / 1e6:.1f} MB: {grown / 1e6:+.1f} MB")
    expect(grown < 2 * VOXELS["small"], f"{grown} bytes more after 50 rounds")


def there_is_one_vtk():
    fetch(simple.PalpateTissueSurface(Input=open_series(phantom("straight")), Values=[-480]))
    with open("/proc/self/maps") as file:
        libraries = {line.split()[-1] for line in file if ".so" in line}
    expect(any("PalpateServer" in library for library in libraries), "the plug-in is not in this process")
    strangers = [library for library in libraries if "libvtk" in library and "9.1" in library]
    expect(not strangers, f"a second VTK: {strangers}")


main([voxels_are_held_once, fifty_rounds_leave_nothing, there_is_one_vtk])

"""The same numbers from a server of its own, serial and on two ranks, as from the process itself."""

import os
import socket
import subprocess
import sys

from palpate_test import PLUGIN, Probe, expect, expect_all_near, fetch, open_series, phantom
from paraview import servermanager, simple

MPIEXEC, PVSERVER = sys.argv[4:6]
SCENE = "ct-skin-and-bone"


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def serve(ranks):
    """A server on loopback, and its port once it listens."""
    port = free_port()
    command = [PVSERVER, f"--server-port={port}", "--force-offscreen-rendering"]
    if ranks > 1:
        command = [MPIEXEC, "--allow-run-as-root", "--oversubscribe", "-n", str(ranks), *command]
    # pvpython is an MPI process itself; its own ranks' settings would confuse those of the server.
    alone = {name: value for name, value in os.environ.items() if not name.startswith(("OMPI_", "PMIX_", "OPAL_"))}
    server = subprocess.Popen(command, env=alone, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    for line in server.stdout:
        if "Accepting connection" in line:
            return server, port
    raise RuntimeError(f"{' '.join(command)} ended with {server.wait()}")


def numbers():
    """What the filters make of the phantoms: sums and sizes that a part left out, or counted twice, would change."""
    found = {}
    for name in ("straight", "tilted", "uneven"):
        reader = open_series(phantom(name))
        reader.UpdatePipeline()
        found[f"{name}: bounds"] = reader.GetDataInformation().GetBounds()
        found[f"{name}: range"] = reader.PointData["HU"].GetRange()
        if name != "uneven":
            probe = Probe(reader)
            found[f"{name}: shares"] = probe.shares()
            found[f"{name}: values"] = [probe.value_at(p) for p in ((0, 0, 0), (5, -16, 20), (-3, 4, -25), (10, 10, 17))]
        fields = simple.PalpateFields(Input=reader, Gradient=1, Scene=SCENE)
        fields.UpdatePipeline()
        # What only tells neighboring ranks' voxels apart would take 2 bytes of each of a rank's own.
        expect("vtkGhostType" not in [*fields.PointData.keys(), *fields.CellData.keys()], f"{name}: marks are passed on")
        for array in ("Gradient magnitude", "Felt strength"):
            found[f"{name}: {array}"] = fields.PointData[array].GetRange()
        # Integrals are reduced over the ranks: every cell has to be there once.
        sums = fetch(simple.IntegrateVariables(Input=fields))
        found[f"{name}: volume"] = [sums.GetCellData().GetArray("Volume").GetValue(0)]
        found[f"{name}: integral"] = [sums.GetPointData().GetArray("Gradient magnitude").GetValue(0)]
        surface = simple.PalpateTissueSurface(Input=reader, Values=[-480])
        area = fetch(simple.IntegrateVariables(Input=surface))
        found[f"{name}: area"] = [area.GetCellData().GetArray("Area").GetValue(0)]
        found[f"{name}: surface"] = surface.GetDataInformation().GetBounds()
        profile = simple.PalpateForceProfile(Input=reader, From=[-22, 3, 1], To=[5, -2, 0], Scene=SCENE)
        table = servermanager.Fetch(profile)
        forces = table.GetColumnByName("Force (N)")
        found[f"{name}: forces"] = [forces.GetValue(n) for n in range(forces.GetNumberOfTuples())]
    return found


def same_numbers_from(ranks, wanted):
    server, port = serve(ranks)
    try:
        simple.Connect("127.0.0.1", port)
        simple.LoadPlugin(PLUGIN, remote=True, ns=vars(simple))
        expect(servermanager.ActiveConnection.GetNumberOfDataPartitions() == ranks, f"not {ranks} ranks")
        for key, values in numbers().items():
            size = max(abs(value) for value in values)
            expect_all_near(values, wanted[key], 1e-6 * (1 + size), f"{ranks} ranks, {key}")
        simple.Disconnect()
    finally:
        server.terminate()
        server.wait(30)


simple.LoadPlugin(PLUGIN, remote=False, ns=vars(simple))
own = numbers()
expect(len(own["tilted: forces"]) > 100 and max(own["tilted: forces"]) > 0.3, "nothing is felt along the stroke")
for count in (1, 2):
    same_numbers_from(count, own)
    print(f"{count} ranks: {len(own)} results the same")

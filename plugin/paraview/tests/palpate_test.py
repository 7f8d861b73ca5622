"""What the tests of the plug-in share: phantoms, the core's own numbers, and the plug-in itself.

Every test runs in pvpython with the folder of the built programs, the plug-in's file and a scratch folder as arguments.
"""

import hashlib
import json
import os
import random
import subprocess
import sys

from paraview import servermanager, simple

PROGRAMS, PLUGIN, SCRATCH = sys.argv[1:4]

# What `palpate-testdata phantom` is told, by the name of the phantom. No two spacings alike, so that no swap goes unseen.
PHANTOMS = {
    "straight": ["sphere", "--radius", "18", "--spacing", "1,0.8,1.5", "--size", "60,70,40"],
    "oblique": ["sphere", "--radius", "18", "--spacing", "1,0.8,1.5", "--size", "60,70,40",
                "--orientation", "0.8,0.6,0,-0.48,0.64,0.6"],
    "tilted": ["sphere", "--radius", "18", "--spacing", "1,0.8,1.5", "--size", "60,80,40", "--tilt", "20"],
    "uneven": ["sphere", "--radius", "18", "--spacing", "1,0.8,1.5", "--size", "60,70,40", "--uneven", "0.2"],
    "noisy": ["sphere", "--radius", "18", "--spacing", "1,0.8,1.5", "--size", "60,70,40", "--noise", "60", "--window", "35,80"],
    "missing": ["sphere", "--radius", "18", "--spacing", "1,0.8,1.5", "--size", "60,70,40", "--missing", "19,20"],
}


def phantom(name):
    """The folder of a phantom, made on first use."""
    told = hashlib.sha1(" ".join(PHANTOMS[name]).encode()).hexdigest()[:8]
    folder = os.path.join(SCRATCH, f"{name}-{told}")
    if not os.path.isdir(folder):
        run("palpate-testdata", "phantom", *PHANTOMS[name], "-o", folder)
    return folder


def run(program, *arguments):
    done = subprocess.run([os.path.join(PROGRAMS, program), *arguments], capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(f"{program} {' '.join(arguments)}: {done.stderr}")
    return done.stdout


def core_info(folder):
    """The first series of a folder as the core sees it."""
    return json.loads(run("palpate", "info", folder, "--json"))["series"][0]


def core_samples(folder, points, *more):
    """Value and gradient at points (mm), as the core samples them."""
    at = [word for p in points for word in ("--at", "%.17g,%.17g,%.17g" % tuple(p))]
    return json.loads(run("palpate", "sample", folder, *at, "--json", *more))


def open_series(path, uid=""):
    reader = simple.PalpateDICOMSeries(FileName=path)
    if uid:
        reader.SeriesUID = uid
    return reader


def fetch(proxy):
    """What a source or filter gives, in this process, so that tests also hold for a remote server."""
    proxy.UpdatePipeline()
    return servermanager.Fetch(proxy)


def texts(proxy, name):
    """A list of texts that a proxy tells; ParaView gives a list of one as its text."""
    value = proxy.GetPropertyValue(name)
    return [value] if isinstance(value, str) else list(value or [])


class Probe:
    """What the program asks the server for: single values, and how they are spread."""

    def __init__(self, reader):
        self.proxy = servermanager.ProxyManager().SMProxyManager.NewProxy("misc", "PalpateValueProbe")
        self.proxy.GetProperty("Reader").AddProxy(reader.SMProxy)
        self.proxy.UpdateVTKObjects()

    def numbers(self, name):
        told = self.proxy.GetProperty(name)
        self.proxy.UpdatePropertyInformation(told)
        return [told.GetElement(n) for n in range(told.GetNumberOfElements())]

    def value_at(self, place):
        for axis, x in enumerate(place):
            self.proxy.GetProperty("Position").SetElement(axis, x)
        self.proxy.UpdateVTKObjects()
        return self.numbers("Value")[0]

    def shares(self):
        return self.numbers("Shares")


def expect(condition, message):
    if not condition:
        raise AssertionError(message)


def expect_near(actual, wanted, tolerance, message):
    if not abs(actual - wanted) <= tolerance:
        raise AssertionError(f"{message}: {actual!r}, not {wanted!r} to within {tolerance:g}")


def expect_all_near(actual, wanted, tolerance, message):
    expect(len(actual) == len(wanted), f"{message}: {len(actual)} values, not {len(wanted)}")
    for n, (a, w) in enumerate(zip(actual, wanted)):
        expect_near(a, w, tolerance, f"{message} [{n}]")


def delete_all():
    for proxy in list(simple.GetSources().values()):
        simple.Delete(proxy)


def main(tests):
    """Runs every test and fails with the first that fails."""
    random.seed(1)
    simple.LoadPlugin(PLUGIN, remote=True, ns=vars(simple))
    for test in tests:
        print(f"{test.__name__} ...", flush=True)
        test()
        delete_all()
    print("all passed")

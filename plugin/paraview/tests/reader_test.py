"""The reader against the core: geometry, values, series, frames."""

import bisect
import json
import math
import os
import random
import shutil

from palpate_test import (SCRATCH, Probe, core_info, core_samples, expect, expect_all_near, expect_near, fetch, main,
                          open_series, phantom, run)
from paraview import simple
from voxel_ball import SIZE, value_at, write_nifti, write_nrrd

EVEN = ("straight", "oblique", "tilted")


def geometry_is_the_cores():
    for name in EVEN:
        info, image = core_info(phantom(name)), fetch(open_series(phantom(name)))
        matrix = [image.GetDirectionMatrix().GetElement(r, c) for c in range(3) for r in range(3)]
        step = info["step_mm"]
        length = sum(s * s for s in step) ** 0.5
        expect(list(image.GetDimensions()) == info["dimensions"], f"{name}: dimensions {image.GetDimensions()}")
        expect_all_near(image.GetSpacing(), [*info["spacing_mm"][:2], length], 1e-9, f"{name}: spacing")
        expect_all_near(image.GetOrigin(), info["origin_mm"], 1e-9, f"{name}: origin")
        expect_all_near(matrix, info["direction_i"] + info["direction_j"] + [s / length for s in step], 1e-9,
                        f"{name}: direction")
    expect(sum(matrix[3 + r] * matrix[6 + r] for r in range(3)) > 0.3, "the tilted phantom is not tilted")


def voxels_are_the_cores():
    for name in EVEN:
        image = fetch(open_series(phantom(name)))
        ids = [random.randrange(image.GetNumberOfPoints()) for _ in range(40)]
        samples = core_samples(phantom(name), [image.GetPoint(n) for n in ids])
        scalars = image.GetPointData().GetScalars()
        expect(scalars.GetName() == "HU" and scalars.GetDataTypeAsString() == "short", f"{name}: {scalars.GetName()}")
        expect_all_near([scalars.GetValue(n) for n in ids], [s["value"] for s in samples], 0, f"{name}: value")
        info, found = core_info(phantom(name)), scalars.GetRange()
        # ParaView's range is that of all voxels.
        expect((info["minimum_with_padding"], info["maximum_with_padding"]) == found, f"{name}: range {found}")


def uneven_slices_are_shown_where_they_are():
    for name in ("uneven", "missing"):
        reader = open_series(phantom(name))
        image = fetch(reader)
        expect(reader.GetPropertyValue("DisplayResampled"), f"{name}: not said to be resampled")
        scalars = image.GetPointData().GetScalars()
        ids = [random.randrange(image.GetNumberOfPoints()) for _ in range(60)]
        gaps = 0
        for n, sample in zip(ids, core_samples(phantom(name), [image.GetPoint(n) for n in ids])):
            if "value" in sample:
                expect_near(scalars.GetValue(n), sample["value"], 0.51, f"{name}: value at {image.GetPoint(n)}")
            else:
                gaps += 1
                expect_near(scalars.GetValue(n), -1000, 0, f"{name}: value in a gap")
        expect((gaps > 0) == (name == "missing"), f"{name}: {gaps} points in gaps")


def a_series_is_chosen():
    folder = os.path.join(SCRATCH, "two")
    shutil.rmtree(folder, ignore_errors=True)
    for name in ("straight", "tilted"):
        shutil.copytree(phantom(name), os.path.join(folder, name))
    reader = open_series(folder)
    reader.UpdatePipelineInformation()
    uids = list(reader.GetPropertyValue("SeriesUids"))
    wanted = core_info(phantom("straight"))["uid"]
    expect(len(uids) == 2 and wanted in uids, f"series found: {uids}")
    listed = json.loads(run("palpate", "info", folder, "--json"))["series"]
    first = [series for series in listed if series["first_choice"]]
    expect(len(first) == 1, "one of them is the best to feel first")
    expect(list(fetch(reader).GetDimensions()) == first[0]["dimensions"], "without a choice it is the best to feel first")
    for series in listed:
        reader.SeriesUID = series["uid"]
        expect(list(fetch(reader).GetDimensions()) == series["dimensions"], "the series chosen by its UID")
    one_file = os.path.join(folder, "straight", sorted(os.listdir(os.path.join(folder, "straight")))[3])
    expect(fetch(open_series(one_file)).GetDimensions() == (60, 70, 40), "the whole series of a file")


def what_cannot_be_read_is_refused():
    for path in (os.path.join(SCRATCH, "absent"), os.path.dirname(os.path.abspath(__file__))):
        reader = open_series(path)
        reader.UpdatePipelineInformation()
        expect(reader.GetDataInformation().GetNumberOfPoints() == 0, f"{path} gave an image")
    reader = open_series(phantom("straight"), "1.2.3")
    reader.UpdatePipelineInformation()
    expect(reader.GetDataInformation().GetNumberOfPoints() == 0, "a series that is not there gave an image")


def single_values_are_the_cores():
    for name in ("straight", "tilted", "missing"):
        reader = open_series(phantom(name))
        reader.UpdatePipeline()
        probe, image = Probe(reader), fetch(reader)
        places = [image.GetPoint(random.randrange(image.GetNumberOfPoints())) for _ in range(30)]
        told = 0
        for place, sample in zip(places, core_samples(phantom(name), places)):
            value = probe.value_at(place)
            if name != "missing":  # the copy that is shown has voxels between those of the scan
                expect_near(value, sample["value"], 0, f"{name} at {place}")
            expect(math.isnan(value) == ("value" not in sample), f"{name} at {place}: {value}, core {sample}")
            told += not math.isnan(value)
        expect(told > 20, f"{name}: {told} values")
        expect(math.isnan(probe.value_at((500, 0, 0))), "a value outside the scan")


def the_spread_of_values_is_that_of_the_voxels():
    reader = open_series(phantom("noisy"))
    reader.UpdatePipeline()
    shares, scalars = Probe(reader).shares(), fetch(reader).GetPointData().GetScalars()
    values = sorted(scalars.GetValue(n) for n in range(scalars.GetNumberOfTuples()))
    expect(len(shares) == 101, f"{len(shares)} shares")
    for percent in range(5, 100, 5):
        below = bisect.bisect_left(values, shares[percent]) / len(values)
        expect_near(below, percent / 100, 0.03, f"voxels below {shares[percent]}")
    lean = open_series(phantom("noisy"))  # before it has been loaded: from some slices on disk
    lean.UpdatePipelineInformation()
    simple.Delete(reader)
    expect(Probe(lean).shares() == shares, "other shares from the files than from the voxels")


def the_window_of_the_series_is_told():
    for name, wanted in (("noisy", [35, 80]), ("straight", [0, 0])):
        reader = open_series(phantom(name))
        reader.UpdatePipelineInformation()
        expect(list(reader.GetPropertyValue("Window")) == wanted, f"{name}: {list(reader.GetPropertyValue('Window'))}")
        expect(reader.GetPropertyValue("Modality") == "CT", f"{name}: modality")


def other_files_are_read():
    """A ball in an oblique lattice, as NIfTI and NRRD: each voxel has the value of its place."""
    for write, name in ((write_nifti, "ball.nii.gz"), (write_nrrd, "ball.nrrd")):
        image = fetch(open_series(write(os.path.join(SCRATCH, name))))
        expect(list(image.GetDimensions()) == [SIZE] * 3, f"{name}: dimensions {image.GetDimensions()}")
        scalars, inside = image.GetPointData().GetScalars(), 0
        for n in (random.randrange(image.GetNumberOfPoints()) for _ in range(400)):
            place = image.GetPoint(n)
            inside += value_at(place) > 0
            expect_near(scalars.GetValue(n), value_at(place), 1, f"{name}: value at {place}")
        expect(inside > 20, f"{name}: {inside} places in the ball")


def paraview_keeps_its_own_readers():
    """What ParaView opens by itself it goes on to open so; what it cannot is the plug-in's."""
    for name, wanted in (("ball.nii.gz", "PalpateDicomReader"), ("ball.nrrd", "NrrdReader")):
        reader = simple.OpenDataFile(os.path.join(SCRATCH, name))
        expect(reader is not None and reader.SMProxy.GetXMLName() == wanted,
               f"{name} is opened by {reader and reader.SMProxy.GetXMLName()}")


main([geometry_is_the_cores, voxels_are_the_cores, uneven_slices_are_shown_where_they_are, a_series_is_chosen,
      what_cannot_be_read_is_refused, single_values_are_the_cores, the_spread_of_values_is_that_of_the_voxels,
      the_window_of_the_series_is_told, other_files_are_read, paraview_keeps_its_own_readers])

"""The filters against the core and against geometry: surfaces, fields, force profiles."""

import json
import math
import os
import random

from palpate_test import (SCRATCH, core_info, core_samples, expect, expect_all_near, expect_near, fetch, main,
                          open_series, phantom, run)
from paraview import simple

SCENE = json.dumps({
    "version": 1,
    "name": "one surface",
    "modes": [{"type": "surface", "name": "skin", "side": "entering",
               "strength_n": {"of": "gradient_per_mm", "nodes": [[20, 0], [200, 1.5]]}},
              {"type": "friction", "name": "drag", "strength_n": {"of": "value", "nodes": [[-500, 0], [40, 0.2]]}}],
})
RADIUS, HALF = 18, (-1000 + 40) / 2  # the phantom is a ball of 40 HU in air: its surface is where the mean of both is


def distances(surface):
    """Largest and mean distance (mm) of the points from the ball's surface, and largest angle (degrees) of the normals."""
    points, normals = surface.GetPoints(), surface.GetPointData().GetNormals()
    count = surface.GetNumberOfPoints()
    expect(count > 3000, f"{count} points")
    worst, total, leaning = 0, 0, 1
    for n in range(count):
        p, normal = points.GetPoint(n), normals.GetTuple(n)
        length = math.dist(p, (0, 0, 0))
        worst, total = max(worst, abs(length - RADIUS)), total + length - RADIUS
        leaning = min(leaning, sum(a * b for a, b in zip(p, normal)) / length)
    return worst, total / count, math.degrees(math.acos(leaning))


def surfaces_are_in_the_right_place():
    # The distance from the ball's center, calculated at the points of the scan: what the filter makes of it is geometry alone.
    for name in ("straight", "oblique", "tilted"):
        voxel = min(core_info(phantom(name))["spacing_mm"])
        from_center = simple.Calculator(Input=open_series(phantom(name)), ResultArrayName="inside",
                                        Function="-sqrt(coordsX^2 + coordsY^2 + coordsZ^2)")
        from_center.UpdatePipeline()
        worst, _, angle = distances(fetch(simple.PalpateTissueSurface(Input=from_center, Values=[-RADIUS])))
        print(f"  {name}: {worst:.4f} mm and {angle:.2f} degrees at most")
        expect(worst < 0.1 * voxel, f"{name}: a point is {worst:.3f} mm off, voxels of {voxel} mm")
        expect(angle < 3, f"{name}: a normal is {angle:.1f} degrees off")


def surfaces_are_where_the_ball_is():
    # A voxel shows the mean over its box; between two of them a sharp edge is found to a sixth of a voxel, no better.
    for name in ("straight", "oblique", "tilted", "uneven"):
        voxel = max(core_info(phantom(name))["spacing_mm"])
        surface = fetch(simple.PalpateTissueSurface(Input=open_series(phantom(name)), Values=[HALF]))
        worst, mean, _ = distances(surface)
        print(f"  {name}: {worst:.3f} mm at most, {mean:+.4f} mm on average")
        expect(worst < voxel / 6, f"{name}: a point of the surface is {worst:.3f} mm off, voxels of {voxel} mm")
        expect(abs(mean) < 0.02 * voxel, f"{name}: the surface is {mean:.4f} mm off on average")


def fields_are_the_cores():
    for name in ("straight", "oblique", "tilted", "uneven", "missing"):
        image = fetch(simple.PalpateFields(Input=open_series(phantom(name)), Gradient=1, Scene=SCENE))
        data = image.GetPointData()
        arrays = [data.GetArray(a) for a in ("Gradient", "Gradient magnitude", "Felt strength")]
        ids = [random.randrange(image.GetNumberOfPoints()) for _ in range(30)]
        ids += [n for n in range(0, image.GetNumberOfPoints(), 7) if arrays[1].GetValue(n) > 100][:30]
        for n, sample in zip(ids, core_samples(phantom(name), [image.GetPoint(n) for n in ids])):
            where = f"{name} at {image.GetPoint(n)}"
            gradient = sample.get("gradient_per_mm", [0, 0, 0])
            length = math.dist(gradient, (0, 0, 0))
            tolerance = 1e-5 * 500  # single precision, of gradients that reach 500 HU/mm here
            expect_all_near(arrays[0].GetTuple(n), gradient, tolerance, f"{where}: gradient")
            expect_near(arrays[1].GetValue(n), length, tolerance, f"{where}: magnitude")
            wanted = 1.5 * min(max((length - 20) / 180, 0), 1)
            expect_near(arrays[2].GetValue(n), wanted, tolerance / 100, f"{where}: felt strength")


def one_mode_is_felt_alone():
    fields = simple.PalpateFields(Input=open_series(phantom("straight")), Scene=SCENE, Mode="drag", GradientMagnitude=0)
    image = fetch(fields)
    felt, value = image.GetPointData().GetArray("Felt strength"), image.GetPointData().GetArray("HU")
    expect(image.GetPointData().GetArray("Gradient magnitude") is None, "magnitude was not asked for")
    for n in (random.randrange(image.GetNumberOfPoints()) for _ in range(100)):
        wanted = 0.2 * min(max((value.GetValue(n) + 500) / 540, 0), 1)
        expect_near(felt.GetValue(n), wanted, 1e-6, f"friction at {value.GetValue(n)} HU")


def fields_of_any_image_are_the_images():
    # Of an image that no Palpate reader made: v = x + 2y - 3z, whose gradient is everywhere (1, 2, -3).
    wavelet = simple.Wavelet(WholeExtent=[-8, 8, -8, 8, -8, 8])
    linear = simple.Calculator(Input=wavelet, Function="coordsX + 2*coordsY - 3*coordsZ", ResultArrayName="v")
    linear.UpdatePipeline()
    fields = simple.PalpateFields(Input=linear, Gradient=1, FeltStrength=0, Scene="ct-bone")
    gradient = fetch(fields).GetPointData().GetArray("Gradient")
    for n in range(0, gradient.GetNumberOfTuples(), 97):
        expect_all_near(gradient.GetTuple(n), (1, 2, -3), 1e-4, "gradient of a linear field")


def a_part_of_a_scan_feels_as_the_whole():
    reader = open_series(phantom("tilted"))
    whole = fetch(simple.PalpateFields(Input=reader, Gradient=1, Scene=SCENE))
    part = simple.ExtractSubset(Input=reader, VOI=[20, 40, 20, 50, 10, 30])
    part.UpdatePipeline()
    inner = fetch(simple.PalpateFields(Input=part, Gradient=1, Scene=SCENE))
    for at in ((28, 35, 20), (30, 30, 18)):
        a = whole.GetPointData().GetArray("Gradient").GetTuple(whole.ComputePointId(at))
        b = inner.GetPointData().GetArray("Gradient").GetTuple(inner.ComputePointId(at))
        expect_all_near(b, a, 1e-3 * (1 + math.dist(a, (0, 0, 0))), f"gradient at voxel {at}")


def a_profile_is_the_command_lines():
    scene = os.path.join(SCRATCH, "scene.json")
    with open(scene, "w") as file:
        file.write(SCENE)
    for name in ("straight", "tilted"):
        ends = [-22, 3, 1], [5, -2, 0]
        core = json.loads(run("palpate", "profile", phantom(name), "--scene", scene, "--json",
                              *(f"--{end}={','.join(map(str, p))}" for end, p in zip(("from", "to"), ends))))
        profile = simple.PalpateForceProfile(Input=open_series(phantom(name)), From=ends[0], To=ends[1], Scene=SCENE)
        table = fetch(profile)
        expect(table.GetNumberOfRows() == len(core["force_n"]), f"{name}: {table.GetNumberOfRows()} rows")
        strongest = 0
        for n, force in enumerate(core["force_n"]):
            # The gradient is a sum in single precision, here of values in HU, there of the stored ones.
            expect_all_near(table.GetColumnByName("Force vector (N)").GetTuple(n), force, 1e-4, f"{name}: force {n}")
            expect_all_near(table.GetColumnByName("Proxy (mm)").GetTuple(n), core["proxy_mm"][n], 1e-4, f"{name}: proxy")
            expect(table.GetColumnByName("Boundary").GetValue(n) == (core["boundary"][n] or ""), f"{name}: boundary {n}")
            strongest = max(strongest, table.GetColumnByName("Force (N)").GetValue(n))
        expect(strongest > 0.5, f"{name}: nothing was felt: {strongest} N")


def a_bad_scene_is_refused():
    for filter_of in (simple.PalpateFields, simple.PalpateForceProfile):
        proxy = filter_of(Input=open_series(phantom("straight")), Scene='{"version": 1, "name": "x", "modes": [{"type": "surfce"}]}')
        proxy.UpdatePipeline()
        information = proxy.GetPointDataInformation() if hasattr(proxy, "GetPointDataInformation") else {}
        expect("Felt strength" not in [a.GetName() for a in information], "a scene with an error was used")


main([surfaces_are_in_the_right_place, surfaces_are_where_the_ball_is, fields_are_the_cores, one_mode_is_felt_alone, fields_of_any_image_are_the_images,
      a_part_of_a_scan_feels_as_the_whole, a_profile_is_the_command_lines, a_bad_scene_is_refused])

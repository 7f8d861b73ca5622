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
BALL, BALL_RADIUS = (2.3, -3.1, 1.4), 12  # outlined
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


def label_ball():
    """A ball of 12 mm as label 3 of an NRRD file, on voxels of a millimeter of its own."""
    size, corner = 36, [c - 17.6 for c in BALL]
    voxels = bytes(3 if math.dist((x + corner[0], y + corner[1], z + corner[2]), BALL) < BALL_RADIUS else 0
                   for z in range(size) for y in range(size) for x in range(size))
    path = os.path.join(SCRATCH, "ball.nrrd")
    with open(path, "wb") as file:
        file.write((f"NRRD0004\ntype: unsigned char\ndimension: 3\nspace: left-posterior-superior\nsizes: {size} {size} {size}\n"
                    "space directions: (1,0,0) (0,1,0) (0,0,1)\nkinds: domain domain domain\nencoding: raw\n"
                    f"space origin: ({','.join(map(str, corner))})\n\n").encode() + voxels)
    return path


def a_structure_is_drawn_where_it_is_felt():
    labels = label_ball()
    for name in ("straight", "oblique", "tilted", "uneven"):
        surface = fetch(simple.PalpateStructureSurface(Input=open_series(phantom(name)), FileName=labels, SegmentNumber=3))
        points = [surface.GetPoint(n) for n in range(surface.GetNumberOfPoints())]
        expect(len(points) > 1000, f"{name}: {len(points)} points")
        worst = max(abs(math.dist(p, BALL) - BALL_RADIUS) for p in points)
        print(f"  {name}: {worst:.3f} mm at most")
        expect(worst < 0.25, f"{name}: a point is {worst:.3f} mm off")
        leaning = max(math.dist([(p[a] - BALL[a]) / BALL_RADIUS for a in range(3)], surface.GetPointData().GetNormals().GetTuple(n))
                      for n, p in enumerate(points))
        expect(leaning < 0.15, f"{name}: a normal leans by {leaning:.2f}")

        scene = os.path.join(SCRATCH, "structure.json")
        with open(scene, "w") as file:
            json.dump({"version": 1, "structures": [{"name": "ball", "file": labels, "segment": 3}],
                       "modes": [{"type": "surface", "structure": "ball", "strength_n": 4}]}, file)
        for axis, side in ((0, 1), (1, -1), (2, 1)):
            ends = [[c + (axis == a) * side * far for a, c in enumerate(BALL)] for far in (BALL_RADIUS + 3, BALL_RADIUS - 3)]
            felt = json.loads(run("palpate", "profile", phantom(name), "--scene", scene, "--json",
                                  *(f"--{end}={','.join(map(str, p))}" for end, p in zip(("from", "to"), ends))))
            proxy = felt["proxy_mm"][-1]
            nearest = min(math.dist(proxy, p) for p in points)
            # The wall's strength rises over 0.1 mm on both sides of the edge; points are 0.5 mm apart.
            outward = (proxy[axis] - BALL[axis]) * side
            drawn = sum(math.dist(p, BALL) for p in sorted(points, key=lambda p: math.dist(p, proxy))[:4]) / 4
            expect(nearest < 0.5, f"{name}: the stylus is held {nearest:.2f} mm from the nearest point")
            expect(abs(outward - drawn) < 0.12, f"{name}: held at {outward:.3f} mm, drawn at {drawn:.3f}")


def a_structure_that_is_not_there_is_refused():
    for wanted in ({"FileName": label_ball(), "SegmentNumber": 4}, {"FileName": "/no/such/file", "Segment": "x"}):
        proxy = simple.PalpateStructureSurface(Input=open_series(phantom("straight")), **wanted)
        proxy.UpdatePipeline()
        expect(proxy.GetDataInformation().GetNumberOfPoints() == 0, f"{wanted}: something was drawn")


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


def a_boundary_of_two_tissues_is_felt_between_these():
    def felt(name, pair):
        scene = json.loads(SCENE)
        scene["tissues"] = [{"name": "air", "high": -600, "softness": 100}, {"name": "bone", "low": 400, "softness": 100},
                            {"name": "soft", "low": -600, "high": 400, "softness": 100}]
        if pair:
            scene["modes"][0].pop("side")
            scene["modes"][0].update(zip(("from", "to"), pair))
        data = fetch(simple.PalpateFields(Input=open_series(phantom(name)), Scene=json.dumps(scene))).GetPointData()
        return [[data.GetArray(a).GetValue(n) for n in range(data.GetNumberOfTuples())] for a in ("Gradient magnitude", "Felt strength")]

    for name in ("straight", "uneven"):
        gradient, anywhere = felt(name, ())
        steep = [n for n, length in enumerate(gradient) if length > 150]
        expect(len(steep) > 1000, f"{name}: {len(steep)} voxels at the ball's edge")
        skin, bone = felt(name, ("air", "soft"))[1], felt(name, ("soft", "bone"))[1]
        expect(all(skin[n] == anywhere[n] > 1 for n in steep), f"{name}: the ball's edge is not felt as air to soft")
        expect(max(bone) == 0, f"{name}: felt up to {max(bone)} N between tissues of which one is not there")


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


main([surfaces_are_in_the_right_place, surfaces_are_where_the_ball_is, a_structure_is_drawn_where_it_is_felt,
      a_structure_that_is_not_there_is_refused, fields_are_the_cores, one_mode_is_felt_alone,
      a_boundary_of_two_tissues_is_felt_between_these, fields_of_any_image_are_the_images,
      a_part_of_a_scan_feels_as_the_whole, a_profile_is_the_command_lines, a_bad_scene_is_refused])

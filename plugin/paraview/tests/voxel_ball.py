"""A ball whose value tells the place, in an oblique left-handed lattice, as NIfTI and NRRD: truth by mathematics alone."""

import functools
import gzip
import math
import struct

SIZE = 76
SPACING = (1.0, 0.9, 1.1)
RADIUS = 25.0
CENTER = (12.0, -7.0, 30.0)  # mm, LPS: left, posterior, head


def value_at(place):
    """Of the scan at a place in LPS, mm."""
    if math.dist(place, CENTER) > RADIUS:
        return 0
    return round(600 + 4 * place[0] + 2 * place[1] + 3 * place[2])


@functools.cache
def axes():
    """mm of LPS from one voxel to the next along the file's three axes: turned about z and x; the first one points right."""
    a, b = math.radians(20), math.radians(10)
    i = (-math.cos(a), -math.sin(a), 0.0)
    j = (-math.sin(a) * math.cos(b), math.cos(a) * math.cos(b), math.sin(b))
    k = (math.sin(a) * math.sin(b), -math.cos(a) * math.sin(b), math.cos(b))
    return [[step * c for c in axis] for axis, step in zip((i, j, k), SPACING)]


@functools.cache
def first_voxel():
    return [CENTER[c] - (SIZE - 1) / 2 * sum(axis[c] for axis in axes()) for c in range(3)]


def place_of(n):
    """Of voxel (i, j, k)."""
    along, first = axes(), first_voxel()
    return [first[c] + sum(n[axis] * along[axis][c] for axis in range(3)) for c in range(3)]


@functools.cache
def voxels():
    values = (value_at(place_of((i, j, k))) for k in range(SIZE) for j in range(SIZE) for i in range(SIZE))
    return struct.pack(f"<{SIZE ** 3}h", *values)


def write_nifti(path):
    """NIfTI-1 (nifti1.h): its sform is RAS, so x and y change their signs."""
    header = bytearray(352)
    struct.pack_into("<i", header, 0, 348)
    struct.pack_into("<8h", header, 40, 3, SIZE, SIZE, SIZE, 1, 1, 1, 1)
    struct.pack_into("<2h", header, 70, 4, 16)
    struct.pack_into("<4f", header, 76, 1, *SPACING)
    struct.pack_into("<f", header, 108, 352)
    struct.pack_into("<B", header, 123, 2)
    struct.pack_into("<2h", header, 252, 0, 1)
    along, first = axes(), first_voxel()
    for c, sign in enumerate((-1, -1, 1)):
        struct.pack_into("<4f", header, 280 + 16 * c, *(sign * axis[c] for axis in along), sign * first[c])
    header[344:348] = b"n+1\0"
    with (gzip.open(path, "wb", compresslevel=1) if path.endswith(".gz") else open(path, "wb")) as file:
        file.write(bytes(header) + voxels())
    return path


def write_nrrd(path):
    vector = lambda v: "({:.17g},{:.17g},{:.17g})".format(*v)
    header = ("NRRD0004\ntype: short\ndimension: 3\nspace: left-posterior-superior\n"
              f"sizes: {SIZE} {SIZE} {SIZE}\nendian: little\nencoding: raw\n"
              f"space directions: {' '.join(vector(axis) for axis in axes())}\nspace origin: {vector(first_voxel())}\n\n")
    with open(path, "wb") as file:
        file.write(header.encode() + voxels())
    return path

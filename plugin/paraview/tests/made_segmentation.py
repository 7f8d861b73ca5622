"""The outline of a ball in a phantom's frame of reference, as a DICOM segmentation written by DCMTK's dump2dcm."""

import math
import os
import subprocess

SIZE = 64  # of a phantom: columns, rows, slices, 1 mm apart, about the origin
RADIUS = 16  # mm


def is_inside(*at):
    return math.dist(at, (0, 0, 0)) < RADIUS


def is_in_cut_ball(x, y, z):
    """The phantom's own ball, 25 mm, whose cap in front is cut off: 4 mm deep."""
    return math.dist((x, y, z), (0, 0, 0)) < 25 and y > -21


def positions():
    return [n - (SIZE - 1) / 2 for n in range(SIZE)]


def voxels(inside=is_inside):
    return sum(inside(x, y, z) for z in positions() for y in positions() for x in positions())


def bits(z, inside=is_inside):
    """A slice, the first pixel in the lowest bit."""
    flags = [inside(x, y, z) for y in positions() for x in positions()]
    return bytes(sum(flag << n for n, flag in enumerate(flags[at:at + 8])) for at in range(0, len(flags), 8))


def items(tag, *contents):
    return [f"({tag}) SQ", *(line for content in contents for line in ["(fffe,e000) -", *content, "(fffe,e00d) -"]),
            "(fffe,e0dd) -"]


def frame(z):
    return [*items("0020,9113", [rf"(0020,0032) DS {positions()[0]}\{positions()[0]}\{z}"]),
            *items("0062,000a", ["(0062,000b) US 1"])]


def write_segmentation(file, scan, number=1, is_in=is_inside, name="Liver"):
    """Of `scan`'s patient, study and frame of reference. Segmentations of another number are others."""
    def header(tag):
        first = os.path.join(scan, sorted(name for name in os.listdir(scan) if name.startswith("slice_"))[0])
        dump = subprocess.run(["dcmdump", "+P", tag, first], check=True, capture_output=True, text=True).stdout
        return dump.split("[")[1].split("]")[0]

    inside = [z for z in positions() if any(is_in(x, y, z) for y in positions() for x in positions())]
    with open(file + ".bits", "wb") as pixels:
        pixels.write(b"".join(bits(z, is_in) for z in inside))
    code = ["(0008,0100) SH T-D0050", "(0008,0102) SH SRT", "(0008,0104) LO Tissue"]
    lines = [
        "(0008,0016) UI 1.2.840.10008.5.1.4.1.1.66.4",
        f"(0008,0018) UI 1.2.826.0.1.3680043.10.8.{number}.1", "(0008,0060) CS SEG",
        f"(0010,0010) PN {header('0010,0010')}", f"(0010,0020) LO {header('0010,0020')}",
        f"(0020,000d) UI {header('0020,000d')}", f"(0020,000e) UI 1.2.826.0.1.3680043.10.8.{number}.2",
        f"(0020,0052) UI {header('0020,0052')}", "(0028,0002) US 1", "(0028,0004) CS MONOCHROME2",
        f"(0028,0008) IS {len(inside)}", f"(0028,0010) US {SIZE}", f"(0028,0011) US {SIZE}", "(0028,0100) US 1",
        "(0028,0101) US 1", "(0028,0102) US 0", "(0028,0103) US 0", "(0062,0001) CS BINARY",
        *items("0062,0002", [*items("0062,0003", code), "(0062,0004) US 1", f"(0062,0005) LO {name}", "(0062,0008) CS MANUAL",
                             r"(0062,000d) US 40000\50000\40000", *items("0062,000f", code)]),
        *items("5200,9229", [*items("0020,9116", [r"(0020,0037) DS 1\0\0\0\1\0"]),
                             *items("0028,9110", ["(0018,0050) DS 1", r"(0028,0030) DS 1\1"])]),
        *items("5200,9230", *(frame(z) for z in inside)),
        f"(7fe0,0010) OB ={file}.bits",
    ]
    with open(file + ".dump", "w") as dump:
        dump.write("\n".join(lines) + "\n")
    subprocess.run(["dump2dcm", "--write-xfer-little", file + ".dump", file], check=True)
    for more in ".dump", ".bits":
        os.remove(file + more)
    return file

"""Packs the module of 3D Slicer: slicer_zip.py FILE. The same sources give the same bytes."""

import pathlib
import sys
import zipfile

folder = pathlib.Path(__file__).resolve().parent.parent / "slicer"
files = [folder / "Palpate.py"] + sorted((folder / "PalpateLib").glob("*.py"))
with zipfile.ZipFile(sys.argv[1], "w", zipfile.ZIP_DEFLATED) as archive:
    for file in files:
        entry = zipfile.ZipInfo("slicer-palpate/" + file.relative_to(folder).as_posix(), (1980, 1, 1, 0, 0, 0))
        entry.external_attr = 0o644 << 16
        entry.compress_type = zipfile.ZIP_DEFLATED
        archive.writestr(entry, file.read_bytes())

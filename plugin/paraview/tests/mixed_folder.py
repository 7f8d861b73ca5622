"""A folder as a CD holds it, generated: series that can be felt, others that cannot, and files that are no scans."""

import glob
import os
import shutil
import subprocess

from panel_program import phantom


def set_headers(folder, **headers):
    files = [os.path.join(at, file) for at, _, names in os.walk(folder) for file in names]
    changes = [argument for key, value in headers.items() for argument in ("-i", f"{key}={value}")]
    subprocess.run(["dcmodify", "-nb", *changes, *files], check=True)
    return folder


def one_slice(name, **headers):
    folder = phantom(name, "slab")
    for file in sorted(glob.glob(os.path.join(folder, "*")))[1:]:
        os.remove(file)
    return set_headers(folder, **headers)


def as_mr(folder, **headers):
    """The values of a CT under the name of an MR."""
    return set_headers(folder, Modality="MR", SOPClassUID="1.2.840.10008.5.1.4.1.1.4", **headers)


def mixed_folder():
    """Three series that can be felt, of which series 201 is the best, and four that cannot."""
    folder = phantom("mixed", "sphere", "--radius", "50", "--size", "128,128,28", "--spacing", "1,1,5")
    set_headers(folder, SeriesDescription="STD BRAIN 5MM", SeriesNumber="201", StudyDate="20150206", SeriesDate="20150206",
                SeriesTime="092935", StudyTime="092800", ConvolutionKernel="UB", SliceThickness="5", BodyPartExamined="BRAIN")
    thick = phantom("mixed-thick", "sphere", "--size", "64,64,8", "--spacing", "1,1,10")
    mr = phantom("mixed-mr", "sphere", "--size", "64,64,10", "--spacing", "1,1,7")
    parts = {
        "thick": set_headers(thick, ConvolutionKernel="B70s", SeriesNumber="202", SliceThickness="10"),
        "mr": as_mr(mr, SeriesDescription="FSE PD", SeriesNumber="2"),
        "scout": one_slice("mixed-scout", ImageType="ORIGINAL\\PRIMARY\\LOCALIZER", SeriesNumber="100"),
        "other-scout": one_slice("mixed-other-scout", ImageType="ORIGINAL\\PRIMARY\\LOCALIZER", SeriesNumber="101"),
        "alone": one_slice("mixed-alone", SeriesNumber="401"),
        "cut": one_slice("mixed-cut", SeriesNumber="9"),
    }
    # Phantoms of a kind have UIDs of a kind.
    for number, (name, part) in enumerate(parts.items(), 1):
        subprocess.run(["dcmodify", "-nb", "-m", f"SeriesInstanceUID=1.2.826.0.1.3680043.10.9.{number}",
                        *glob.glob(os.path.join(part, "*"))], check=True)
        shutil.move(part, os.path.join(folder, name))
    for file in glob.glob(os.path.join(folder, "cut", "*")):
        os.truncate(file, os.path.getsize(file) - 3000)
    shutil.copy(sorted(glob.glob(os.path.join(folder, "mr", "*")))[3], os.path.join(folder, "copy"))
    with open(os.path.join(folder, "letter.txt"), "w") as file:
        file.write("This is no scan.")
    open(os.path.join(folder, "empty.dcm"), "w").close()
    return folder


def two_of_a_patient():
    folder = phantom("erika", "sphere", "--radius", "25")
    shutil.move(phantom("erika-second", "sphere", "--radius", "18"), os.path.join(folder, "second"))
    return set_headers(folder, PatientName="Muster^Erika", PatientID="P1", StudyDate="20260101",
                       StudyInstanceUID="1.2.826.0.1.3680043.10.1.1")

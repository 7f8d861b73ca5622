"""From an empty ParaView to a scan, and to a force: the start page in the center.

Arguments as in panel_program.py.
"""

import os
import shutil

from mixed_folder import as_mr, mixed_folder, set_headers, two_of_a_patient
from panel_program import HEAD, main, phantom, real_head, run


def chosen():
    return run("a_scan_is_chosen_in_the_center", PALPATE_DROP=mixed_folder(), PALPATE_OTHER=two_of_a_patient())


def first_start():
    """In a home of its own, in which ParaView has never run: its welcome would come."""
    def new(home):
        shutil.rmtree(os.path.join(home, ".config", "ParaView"))

    return run("the_start_page_is_the_welcome", prepare=new, longest_s=90)  # behind its welcome ParaView would wait for ever


def again():
    folder = phantom("ball", "sphere", "--radius", "25")
    return (run("folders_are_opened_again", PALPATE_DROP=folder) and
            run("a_recent_folder_is_pressed", first=False, PALPATE_DROP=folder))


def sampled():
    more = {"PALPATE_HEAD": "1"} if os.path.exists(HEAD) else {}
    if not run("a_sample_is_tried", **more):
        return False
    if not run("a_sample_comes_too_late", PALPATE_DROP=phantom("ball", "sphere", "--radius", "25"), **more):
        return False
    # Where the cache cannot be written, it is said.
    return run("a_sample_cannot_be_written", XDG_CACHE_HOME="/proc/nowhere")


def felt(what, folder):
    return run("felt_in_six_presses", PALPATE_CHOOSE=folder, PALPATE_WHAT=what)


def chest():
    """A wall of soft tissue around air."""
    folder = phantom("chest", "shell", "--radius", "28", "--wall", "10", "--size", "96,96,96")
    return set_headers(folder, BodyPartExamined="CHEST", SeriesDescription="THORAX 1.0", ConvolutionKernel="B30f")


def head():
    """A real one where it is installed, else bone around soft tissue."""
    return real_head() if os.path.exists(HEAD) else set_headers(phantom("head", "shell", "--radius", "28"), BodyPartExamined="HEAD")


def brain():
    return as_mr(phantom("brain", "shell", "--radius", "28", "--noise", "5"), BodyPartExamined="BRAIN")


main({
    "chosen": chosen,
    "first_start": first_start,
    "again": again,
    "sampled": sampled,
    "ct_chest": lambda: felt("ct-chest", chest()),
    "ct_head": lambda: felt("ct-head", head()),
    "mr_brain": lambda: felt("mr-brain", brain()),
})

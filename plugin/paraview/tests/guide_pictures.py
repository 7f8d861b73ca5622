"""The guide's pictures anew, from the program itself: `plugin/run pictures FOLDER` with a CT of a head.

Arguments as in panel_program.py, then the folder. PALPATE_PICTURES_ALONE names those scenarios that are run alone.
"""

import math
import os
import shutil
import subprocess
import sys
import tempfile

from archive_test import enter, in_an_archive
from made_segmentation import is_in_cut_ball, write_segmentation
from mixed_folder import mixed_folder, two_of_a_patient
from panel_program import ASKED, ball, run, scratch

PICTURES = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", "..", "docs", "pictures"))


def spoilt():
    """A ball whose outline lacks a cap."""
    folder = ball()
    write_segmentation(os.path.join(folder, "liver.dcm"), folder, is_in=is_in_cut_ball)
    os.environ["PALPATE_CORRECTED"] = scratch("corrected.dcm")
    return folder


def outlined_head():
    """The head with a lesion that was made."""
    folder = scratch("outlined-head")
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(head, folder)
    write_segmentation(os.path.join(folder, "lesion.dcm"), folder, name="Lesion",
                       is_in=lambda *at: math.dist(at, (18, 4, 12)) < 11 + 2 * math.sin(at[0] / 3) * math.cos(at[1] / 4))
    return folder


def as_screen(scenario, screens, *arguments, **more):
    """Screens that a scenario leaves, as pictures of the guide: name there -> (name here, what is cut out of it)."""
    if not run(scenario, *arguments, **more):
        return False
    for screen, (name, cut) in screens.items():
        subprocess.run(["convert", scratch(f"panel-{screen}.png"), *(["-crop", cut, "+repage"] if cut else []),
                        os.path.join(PICTURES, name + ".png")], check=True)
    return True


def chosen():
    return as_screen("a_scan_is_chosen_in_the_center", {"start-cards": ("cards", None)}, screen="1366x768",
                     PALPATE_DROP=mixed_folder(), PALPATE_OTHER=two_of_a_patient())


def opened_before():
    """The start page with a folder of no user's name."""
    with tempfile.TemporaryDirectory() as parent:
        folder = os.path.join(parent, "ct-ball")
        shutil.copytree(ball(), folder)
        return (run("folders_are_opened_again", screen="1366x768", PALPATE_DROP=folder) and
                as_screen("a_recent_folder_is_pressed", {"start-recent": ("start", "785x190+0+62")}, screen="1366x768", first=False,
                          PALPATE_DROP=folder))


def archived():
    def act(archive):
        return as_screen("felt_from_the_archive", {"archive-chosen": ("archive", "360x450+790+62")}, screen="1366x768",
                         prepare=lambda _: enter("clinic", archive.options("--get")))

    return in_an_archive("felt_from_the_archive", act)


def marked():
    return as_screen("marks_are_where_the_stylus_was", {"marks": ("marks", "1152x762+0+0")}, ball(), screen="1366x768")


head = os.path.abspath(ASKED[0])
scenarios = {
    "guide_pictures": lambda: run("guide_pictures", head, PALPATE_GUIDE=PICTURES),
    "guide_structures": lambda: run("guide_structures", outlined_head(), screen="1366x768", PALPATE_GUIDE=PICTURES),
    "guide_fault": lambda: run("guide_fault", head, PALPATE_GUIDE=PICTURES),
    "an_outline_is_corrected": lambda: run("an_outline_is_corrected", spoilt(), screen="1280x860", PALPATE_GUIDE=PICTURES),
    "cards": chosen,
    "start": opened_before,
    "archive": archived,
    "marks": marked,
}
for scenario in os.environ.get("PALPATE_PICTURES_ALONE", " ".join(scenarios)).split():
    if not scenarios[scenario]():
        sys.exit("the pictures could not be made: see above")

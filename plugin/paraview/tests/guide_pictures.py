"""The guide's pictures anew, from the program itself: `plugin/run pictures FOLDER` with a CT of a head.

Arguments as in panel_program.py, then the folder. PALPATE_PICTURES_ALONE names those scenarios that are run alone.
"""

import os
import sys

from made_segmentation import is_in_cut_ball, write_segmentation
from panel_program import ASKED, ball, run, scratch

PICTURES = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", "..", "docs", "pictures"))


def spoilt():
    """A ball whose outline lacks a cap."""
    folder = ball()
    write_segmentation(os.path.join(folder, "liver.dcm"), folder, is_in=is_in_cut_ball)
    os.environ["PALPATE_CORRECTED"] = scratch("corrected.dcm")
    return folder


head = os.path.abspath(ASKED[0])
folders = {"guide_pictures": lambda: head, "guide_fault": lambda: head, "an_outline_is_corrected": spoilt}
for scenario in os.environ.get("PALPATE_PICTURES_ALONE", " ".join(folders)).split():
    more = {"screen": "1280x860"} if scenario == "an_outline_is_corrected" else {}
    if not run(scenario, folders[scenario](), PALPATE_GUIDE=PICTURES, **more):
        sys.exit("the pictures could not be made: see above")

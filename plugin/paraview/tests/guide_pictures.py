"""The guide's pictures anew, from the program itself: `plugin/run pictures FOLDER` with a CT of a head.

Arguments as in panel_program.py, then the folder.
"""

import os
import sys

from panel_program import ASKED, run

PICTURES = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", "..", "docs", "pictures"))
for scenario in ("guide_pictures", "guide_fault"):
    if not run(scenario, os.path.abspath(ASKED[0]), PALPATE_GUIDE=PICTURES):
        sys.exit("the pictures could not be made: see above")

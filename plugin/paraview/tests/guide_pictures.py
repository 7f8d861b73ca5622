"""The guide's pictures anew, from the program itself: `plugin/run pictures FOLDER [CT LABELS:SEGMENT]`.

Arguments as in panel_program.py, then the folder of a head CT; and a CT with an outlined organ, of which a part is cut off here.
"""

import json
import math
import os
import shutil
import subprocess
import sys

from panel_program import ASKED, PROGRAMS, run, scratch

PICTURES = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", "..", "docs", "pictures"))


def spoilt(ct, structure):
    """The CT, and beside it the outline without a groove along the patient's right side."""
    folder = scratch("spoilt-outline")
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(ct, folder)
    x, y, z = (float(number) for number in os.environ.get("PALPATE_GROOVE", "-146,-138,-785").split(","))
    edits = {"version": 1, "edits": [{"type": "remove", "path_mm": [[x, y, z - 15], [x, y, z + 15]], "radius_mm": 4.5}]}
    with open(scratch("groove.json"), "w") as file:
        json.dump(edits, file)
    palpate = os.path.join(PROGRAMS, "palpate")
    outline = os.path.join(folder, structure.rsplit(":", 1)[1] + ".seg.nrrd")
    subprocess.run([palpate, "correct", ct, "--structure", structure, "--edits", scratch("groove.json"), "-o", outline], check=True)
    listed = subprocess.run([palpate, "suspects", ct, "--structure", outline, "--json"], check=True, capture_output=True, text=True)
    places = json.loads(listed.stdout)["places"]
    at = min(range(len(places)), key=lambda n: math.dist(places[n]["position_mm"], (x, y, z)))
    os.environ["PALPATE_PLACE"] = str(at)
    print(f"doubtful place {at + 1} of {len(places)}:", places[at])
    return folder


scenarios = {"guide_pictures": os.path.abspath(ASKED[0]), "guide_fault": os.path.abspath(ASKED[0])}
if len(ASKED) > 1:
    scenarios["guide_correct"] = spoilt(os.path.abspath(ASKED[1]), ASKED[2])
for scenario in os.environ.get("PALPATE_PICTURES_ALONE", " ".join(scenarios)).split():
    if not run(scenario, scenarios[scenario], PALPATE_GUIDE=PICTURES):
        sys.exit("the pictures could not be made: see above")

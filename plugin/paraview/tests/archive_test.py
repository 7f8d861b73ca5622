"""The panel's Archive tab in the real ParaView, against a real archive.

Arguments as in panel_program.py.
"""

import json
import os
import re
import shutil
import stat
import subprocess

from archive_program import PROGRAM, Orthanc
from made_segmentation import is_in_cut_ball, write_segmentation
from panel_program import PROGRAMS, main, phantom, run, scratch

HOME = scratch("panel-home")
FETCHED = os.path.join(HOME, ".cache", "palpate", "fetched")


def patient(name, who, number, *arguments):
    """A phantom that is a patient's."""
    folder = phantom(name, *arguments)
    files = [os.path.join(folder, file) for file in os.listdir(folder)]
    uids = {"0020,000d": f"1.2.826.0.1.3680043.10.1.{number}", "0020,000e": f"1.2.826.0.1.3680043.10.1.{number}.1"}
    changes = {"PatientName": who, "PatientID": f"P{number}", "StudyDate": f"2026010{number}", "StudyDescription": name, **uids}
    for key, value in changes.items():
        subprocess.run(["dcmodify", "-nb", "-i", f"{key}={value}", *files], check=True)
    subprocess.run(["dcmodify", "-nb", "-gin", *files], check=True)  # images of its own
    return folder


def enter(name, options):
    """As a user does on the command line."""
    subprocess.run([os.path.join(PROGRAMS, "palpate"), "archive", "add", name, *options], check=True,
                   env=dict(os.environ, HOME=HOME), stdout=subprocess.DEVNULL)


def nothing_is_left(scenario):
    left = [os.path.join(folder, file) for folder, _, files in os.walk(FETCHED) for file in files]
    if left:
        print(f"{scenario}: FAILED: the program has ended, and these are still there: {left[:3]}")
    return not left


def in_an_archive(scenario, act, **how):
    if not PROGRAM:
        print(f"{scenario}: skipped: Orthanc is not installed: apt-get install orthanc")
        return True
    with Orthanc(scratch("orthanc"), **how) as archive:
        archive.fill(patient("ball", "Muster^Erika", 1, "sphere", "--radius", "25"))
        archive.fill(patient("tube", "Mustermann^Max", 2, "tube"))
        return act(archive)


def felt_from_the_archive(*way):
    name = "felt_from_the_archive"

    def act(archive):
        return run(name, prepare=lambda _: enter("clinic", archive.options(*way))) and nothing_is_left(name)

    return in_an_archive(name, act)


def kept_and_emptied():
    def act(archive):
        if not run("what_is_fetched_is_kept", prepare=lambda _: enter("clinic", archive.options("--get"))):
            return False
        series = os.path.join(FETCHED, "series-001")
        private = os.path.isdir(series) and stat.S_IMODE(os.stat(FETCHED).st_mode) == 0o700
        if not private or len(os.listdir(series)) != 64:
            print("what_is_fetched_is_kept: FAILED: it is not there, or not whole, or others can read it")
            return False
        return run("what_was_kept_is_emptied", first=False) and nothing_is_left("what_was_kept_is_emptied")

    return in_an_archive("what_is_fetched_is_kept", act)


def fetched_late():
    name = "what_is_fetched_late_is_offered"

    def act(archive):
        return run(name, prepare=lambda _: enter("clinic", archive.options("--get")), PALPATE_DROP=phantom("sphere", "sphere"))

    return in_an_archive(name, act)


def entered():
    def act(archive):
        return run("an_archive_is_entered", PALPATE_ARCHIVE_PORT=str(archive.port), PALPATE_LISTEN_PORT=str(archive.ours))

    return in_an_archive("an_archive_is_entered", act)


def entered_with_tls():
    name = "an_archive_is_entered_with_tls"

    def act(archive):
        if not run(name, PALPATE_ARCHIVE_PORT=str(archive.port), PALPATE_CERTIFICATES=archive.folder):
            return False
        listed = subprocess.run([os.path.join(PROGRAMS, "palpate"), "archive", "echo", "clinic"], capture_output=True, text=True,
                                env=dict(os.environ, HOME=HOME))
        if listed.returncode != 0:  # what the dialog wrote is what the command line reads
            print(f"{name}: FAILED: {listed.stdout}{listed.stderr}")
        return listed.returncode == 0 and nothing_is_left(name)

    return in_an_archive(name, act, tls=True)


def odd(behavior, name):
    """An archive that misbehaves."""
    process = subprocess.Popen([os.path.join(PROGRAMS, "odd_archive"), behavior], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                               text=True)
    try:
        options = ["--host", "127.0.0.1", "--port", process.stdout.readline().strip(), "--called", "ODD", "--calling", "PALPATE",
                   "--get"]
        return run(name, prepare=lambda _: enter("endless", options)) and nothing_is_left(name)
    finally:
        process.stdin.close()
        process.terminate()
        process.wait()


def in_the_archive(archive, folder):
    """What a study there holds beside its scan, fetched by another program: the files."""
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    subprocess.run(["getscu", "-S", "-aet", "PALPATE", "-aec", "ORTHANC", "-k", "QueryRetrieveLevel=STUDY", "-k",
                    "StudyInstanceUID=1.2.826.0.1.3680043.10.1.1", "-od", folder, "+B", "127.0.0.1", str(archive.port)],
                   check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return [os.path.join(folder, file) for file in os.listdir(folder)]


def values(file, *tags):
    dump = subprocess.run(["dcmdump", "-Un", *(word for tag in tags for word in ("+P", tag)), file], check=True,
                          capture_output=True, text=True).stdout
    return re.findall(r"^\s*\([0-9a-f,]+\) \w\w (?:\[(.*?)\]|([-+.0-9e\\]+) )", dump, re.M)


def marks_sent():
    """From the panel into the archive, and there the same places, to a thousandth of a millimeter."""
    name = "marks_are_sent"

    def act(archive):
        if not run(name, scratch("panel-ball"), prepare=lambda _: enter("clinic", archive.options("--get"))):
            return False
        with open(scratch("sent-marks.json")) as file:
            sent = json.load(file)
        kinds = {"1.2.840.10008.5.1.4.1.1.88.34": [], "1.2.840.10008.5.1.4.1.1.7": []}  # Comprehensive 3D SR, picture
        for file in in_the_archive(archive, scratch("from-the-archive")):
            kinds.get(values(file, "0008,0016")[0][0], []).append(file)
        reports, pictures = kinds.values()
        if len(reports) != 1 or len(pictures) != 3:
            print(f"{name}: FAILED: {len(reports)} reports and {len(pictures)} pictures are in the study")
            return False
        dump = subprocess.run(["dcmdump", "+P", "0070,0022", reports[0]], check=True, capture_output=True, text=True).stdout
        places = [[float(x) for x in line.split(" FL ")[1].split()[0].split("\\")] for line in dump.splitlines() if " FL " in line]
        points = [place for place in places if len(place) == 3]
        wanted = [mark["position_mm"] for mark in sent["marks"]]
        for place in wanted:
            if min((max(abs(a - b) for a, b in zip(place, point)) for point in points), default=1e9) > 1e-3:
                print(f"{name}: FAILED: no point of the report is at {place}: {points}")
                return False
        lengths = [float(value) for value, _ in values(reports[0], "0040,a30a") if value]
        length = sent["distances"][0]["length_mm"]
        if min((abs(length - one) for one in lengths), default=1e9) > 1e-3:
            print(f"{name}: FAILED: no length of the report is {length}: {lengths}")
            return False
        print(f"{name}: the archive has the report with {len(points)} points and {len(pictures)} pictures")
        return True

    return in_an_archive(name, act)


def marks_not_sent():
    nowhere = ["--host", "127.0.0.1", "--port", "1", "--called", "NOBODY", "--calling", "PALPATE", "--get"]
    return run("marks_are_not_sent", patient("ball", "Muster^Erika", 1, "sphere", "--radius", "25"),
               prepare=lambda _: enter("clinic", nowhere), PALPATE_OTHER=patient("tube", "Mustermann^Max", 2, "tube"))


def marks_without_contact():
    """What would be sent of them is looked at, and not sent."""
    nowhere = ["--host", "127.0.0.1", "--port", "1", "--called", "NOBODY", "--calling", "PALPATE", "--get"]
    return run("marks_without_contact_are_called_that", patient("ball", "Muster^Erika", 1, "sphere", "--radius", "25"),
               prepare=lambda _: enter("clinic", nowhere))


def outline_sent():
    """An outline is mended in the panel and sent; in the archive it has the mended edge, and the scan's study."""
    name = "an_outline_is_sent"

    def act(archive):
        folder = scratch("panel-ball")
        cut = write_segmentation(os.path.join(folder, "liver.dcm"), folder, is_in=is_in_cut_ball)
        if not run(name, folder, prepare=lambda _: enter("clinic", archive.options("--get"))):
            return False
        sent = [file for file in in_the_archive(archive, scratch("from-the-archive"))
                if values(file, "0008,0016")[0][0] == "1.2.840.10008.5.1.4.1.1.66.4"]
        if len(sent) != 1 or values(sent[0], "0010,0020")[0][0] != "P1":
            print(f"{name}: FAILED: {len(sent)} outlines of the patient are in the study")
            return False
        compared = subprocess.run([os.path.join(PROGRAMS, "palpate"), "structures", "compare", cut, sent[0], "--json"],
                                  check=True, capture_output=True, text=True)
        found = json.loads(compared.stdout)
        before, after = found["volume_mm3"]
        if not (after > before + 100 and 3 < found["largest_mm"] < 5 and abs(found["largest_at_mm"][0]) < 12):
            print(f"{name}: FAILED: the edge is not where it was drawn: {found}")
            return False
        return True

    return in_an_archive(name, act)


if __name__ == "__main__":
    main({
        "felt_by_move": felt_from_the_archive,
        "felt_by_get": lambda: felt_from_the_archive("--get"),
        "kept_and_emptied": kept_and_emptied,
        "fetched_late": fetched_late,
        "entered": entered,
        "entered_with_tls": entered_with_tls,
        "marks_sent": marks_sent,
        "marks_not_sent": marks_not_sent,
        "marks_without_contact": marks_without_contact,
        "outline_sent": outline_sent,
        "cancelled": lambda: odd("without-end", "a_fetch_is_cancelled"),
    })

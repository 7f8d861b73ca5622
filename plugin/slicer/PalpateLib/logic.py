"""What is said and sent, as plain values: no Slicer, no VTK."""

import json
import math
import os

DEVICE_NAME_BYTES = 20  # OpenIGTLink's
STRING_BYTES = 65535
MM_PER_N = 10.0  # of the arrow


class NotSent(Exception):
    """Why something was not sent, in words for the user."""


def device_name(name, taken=()):
    """A name of at most 20 bytes in UTF-8 that is not taken yet: longer ones are cut, and numbered if that makes two alike."""
    name = name.strip() or "structure"
    for number in range(1, 1000):
        ending = "" if number == 1 else " %d" % number
        room = DEVICE_NAME_BYTES - len(ending)
        cut = name.encode("utf-8")[:room].decode("utf-8", "ignore").rstrip() + ending
        if cut not in taken:
            return cut
    raise NotSent("There are too many structures called %s." % name)


def scene_to_send(text):
    """The text of a scene, if it can be one. Palpate itself says what else is wrong with it."""
    try:
        scene = json.loads(text)
    except ValueError as error:
        raise NotSent("The scene is not JSON: %s." % error)
    if not isinstance(scene, dict) or "modes" not in scene:
        raise NotSent("This JSON is not a scene: it has no list of modes.")
    compact = json.dumps(scene, ensure_ascii=False, separators=(",", ":"))
    if len(compact.encode("utf-8")) > STRING_BYTES:
        raise NotSent("The scene has more than %d bytes, the most that a message carries." % STRING_BYTES)
    return compact


def folder_of(files):
    """The folder that holds all files of a series."""
    files = [os.path.abspath(file) for file in files if file]
    if not files:
        raise NotSent("This volume was not loaded from the DICOM database: Palpate cannot find its files.")
    folder = os.path.commonpath([os.path.dirname(file) for file in files])
    if any(os.path.dirname(file) != folder for file in files):
        raise NotSent("The files of this series lie in several folders. Copy them into one, and start Palpate with it.")
    return folder


def contact_line(text):
    """A line for what is touched: "skin, known to 0.2 mm, 0.83 N, 45 HU; liver 2.1 mm away". Empty if nothing is known."""
    try:
        contact = json.loads(text)
    except ValueError:
        return ""
    if not isinstance(contact, dict):
        return ""
    parts = [contact.get("in_words") or contact.get("boundary") or "no contact"]
    if isinstance(contact.get("force_n"), (int, float)):
        parts.append("%.2f N" % contact["force_n"])
    if isinstance(contact.get("value"), (int, float)):
        parts.append(("%.0f %s" % (contact["value"], contact.get("unit") or "")).strip())
    line = ", ".join(parts)
    for name, mm in (contact.get("distances_mm") or {}).items():
        if isinstance(mm, (int, float)):
            line += "; %s %.1f mm %s" % (name, abs(mm), "inside" if mm > 0 else "away")
    return line


def status_line(name, text):
    """What the state line shows of a STATUS."""
    return text or {"feeling": "Feeling", "ready": "Ready", "stopped": "Stopped"}.get(name, "Not connected")


def arrow_rows(position, force):
    """Rows of the matrix that takes an arrow of length 1 along x to the force at that place. Without a force it vanishes."""
    newtons = math.sqrt(sum(f * f for f in force))
    if not 1e-3 < newtons < 1e3:
        return [[1e-6 if row == column else 0.0 for column in range(3)] + [position[row]] for row in range(3)] + [[0.0, 0.0, 0.0, 1.0]]
    along = [f / newtons for f in force]
    # Any direction across it: the axis that it has least of, made perpendicular.
    least = min(range(3), key=lambda axis: abs(along[axis]))
    across = [(1.0 if axis == least else 0.0) - along[least] * along[axis] for axis in range(3)]
    size = math.sqrt(sum(a * a for a in across))
    across = [a / size for a in across]
    third = [along[1] * across[2] - along[2] * across[1], along[2] * across[0] - along[0] * across[2],
             along[0] * across[1] - along[1] * across[0]]
    length = MM_PER_N * newtons
    rows = [[length * along[row], length * across[row], length * third[row], position[row]] for row in range(3)]
    return rows + [[0.0, 0.0, 0.0, 1.0]]

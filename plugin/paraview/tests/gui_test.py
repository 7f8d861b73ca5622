"""ParaView with the panel, on a virtual display: what stands on the screen, pixel by pixel.

Runs in plain Python 3 under xvfb-run with the folder of the built programs, the plug-ins' list and a scratch folder as
arguments. Pictures are left in the scratch folder for a person to look at.
"""

import os
import shutil
import subprocess
import sys
import time

import patience

PROGRAMS, PLUGINS, SCRATCH = sys.argv[1:4]


class Picture:
    """The screen as it is, also saved under a name."""

    def __init__(self, name):
        file = os.path.join(SCRATCH, name + ".png")
        subprocess.run(["import", "-window", "root", file], check=True)
        ppm = subprocess.run(["convert", file, "-depth", "8", "ppm:-"], check=True, capture_output=True).stdout
        head, size, depth, self.pixels = ppm.split(b"\n", 3)
        self.width, self.height = map(int, size.split())

    def at(self, x, y):
        n = 3 * (y * self.width + x)
        return tuple(self.pixels[n:n + 3])

    def black_runs(self, count, black, least):
        """Intervals of lines (columns or rows) in which at least `least` pixels are black."""
        runs, begin = [], None
        for line in range(count + 1):
            inside = line < count and black(line) >= least
            if inside and begin is None:
                begin = line
            elif not inside and begin is not None:
                if line - begin > 150:
                    runs.append((begin, line))
                begin = None
        return runs

    def views(self, right_edge):
        """The four views as boxes, row by row: with a small ball in them, the only large black areas of the window."""
        columns = self.black_runs(right_edge, lambda x: sum(self.at(x, y) == (0, 0, 0) for y in range(150, self.height, 4)), 25)
        if not columns:
            return []
        left, right = columns[0][0], columns[-1][1]
        rows = self.black_runs(self.height, lambda y: sum(self.at(x, y) == (0, 0, 0) for x in range(left, right, 4)), 25)
        return [(x0, y0, x1, y1) for y0, y1 in rows for x0, x1 in columns]

    def mean(self, box, x, y):
        """Mean gray of a patch about a place in a box, in parts of its size."""
        cx, cy = int(box[0] + x * (box[2] - box[0])), int(box[1] + y * (box[3] - box[1]))
        patch = [sum(self.at(cx + i, cy + j)) / 3 for i in range(-4, 5) for j in range(-4, 5)]
        return sum(patch) / len(patch)


class ParaView:
    """The program with a folder opened in it, as `plugin/run view` opens it."""

    def __init__(self, folder):
        home = os.path.join(SCRATCH, "home")
        shutil.rmtree(home, ignore_errors=True)
        os.makedirs(home)
        environment = dict(os.environ, PALPATE_OPEN=folder, PV_PLUGIN_CONFIG_FILE=PLUGINS, HOME=home,
                           LIBGL_ALWAYS_SOFTWARE="1")
        self.log = open(os.path.join(SCRATCH, "gui.log"), "w+")
        self.program = subprocess.Popen(["paraview"], env=environment, stdout=self.log, stderr=self.log)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.program.kill()
        self.program.wait()

    def window(self):
        found = subprocess.run(["xdotool", "search", "--onlyvisible", "--name", "^ParaView"], capture_output=True, text=True)
        return found.stdout.split()[-1] if found.stdout else None

    def right_edge(self):
        """0 while no window is shown, as between the first and the one that stays."""
        window = self.window()
        if not window:
            return 0
        shell = subprocess.run(["xdotool", "getwindowgeometry", "--shell", window], capture_output=True, text=True)
        words = dict(line.split("=") for line in shell.stdout.split())
        return int(words["X"]) + int(words["WIDTH"]) if words else 0

    def settled(self, name, shown, seconds=120):
        """The screen once it no longer changes and `shown` holds of it."""
        waited, last = patience.Patience(seconds), None
        while not waited.is_over():
            if self.program.poll() is not None:
                self.log.seek(0)
                raise AssertionError("ParaView ended by itself:\n" + self.log.read()[-3000:])
            time.sleep(3)
            if not self.window():
                continue
            picture = Picture(name)
            # Below the views ParaView tells how much memory is used, never twice the same.
            middle = picture.pixels[3 * 150 * picture.width:3 * 720 * picture.width]
            if middle == last and shown(picture):
                return picture
            last = middle
        raise AssertionError(f"{name}: the scan is not shown after {seconds} s; see {SCRATCH}/{name}.png")


def phantom(name, *arguments):
    folder = os.path.join(SCRATCH, "gui-" + name)
    shutil.rmtree(folder, ignore_errors=True)
    subprocess.run([os.path.join(PROGRAMS, "palpate-testdata"), "phantom", *arguments, "-o", folder], check=True)
    return folder


def expect_brighter(picture, box, bright, dark, what):
    a, b = picture.mean(box, *bright), picture.mean(box, *dark)
    if not a > b + 60:
        raise AssertionError(f"{what}: gray {a:.0f} at {bright}, {b:.0f} at {dark}")


def where_the_views_are():
    with ParaView(phantom("sphere", "sphere", "--radius", "14")) as program:
        picture = program.settled("gui-sphere", lambda shown: len(shown.views(program.right_edge())) == 4)
        return picture.views(program.right_edge())


def has_corners_of(boxes):
    """Whether the views stand where they did with another scan, black at their margins, and the last has a volume."""
    def holds(picture):
        x0, y0, x1, y1 = boxes[-1]
        colored = sum(max(picture.at(x, y)) > 30 for x in range(x0 + 20, x1 - 20, 4) for y in range(y0 + 20, y1 - 100, 4))
        return colored > 200 and all(picture.at(x0 + 8, y1 - 8) == picture.at(x1 - 8, y1 - 8) == (0, 0, 0)
                                     for x0, _, x1, y1 in boxes)
    return holds


def the_back_is_where_its_letter_is(boxes):
    # Bone fills the back of this cube, soft tissue its front.
    with ParaView(phantom("slab", "slab", "--wall", "40")) as program:
        picture = program.settled("gui-slab", has_corners_of(boxes))
        expect_brighter(picture, boxes[0], (0.5, 0.7), (0.5, 0.2), "axial: the back is below")
        expect_brighter(picture, boxes[1], (0.7, 0.5), (0.3, 0.5), "sagittal: the back is on the right")


def left_and_head_are_where_their_letters_are(boxes):
    # Air above the middle of this cube; below it bone on the patient's right, soft tissue on the left.
    with ParaView(phantom("wedge", "wedge")) as program:
        picture = program.settled("gui-wedge", has_corners_of(boxes))
        expect_brighter(picture, boxes[2], (0.2, 0.8), (0.8, 0.8), "coronal: the patient's right is on the left")
        expect_brighter(picture, boxes[2], (0.8, 0.8), (0.8, 0.25), "coronal: the head is above")
        expect_brighter(picture, boxes[1], (0.5, 0.8), (0.5, 0.25), "sagittal: the head is above")


views = where_the_views_are()
the_back_is_where_its_letter_is(views)
left_and_head_are_where_their_letters_are(views)
print("all passed")

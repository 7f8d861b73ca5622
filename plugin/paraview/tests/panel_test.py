"""ParaView with the panel, on a virtual display, driven by the test plug-in: each scenario in a program of its own.

Runs in plain Python 3 under xvfb-run with the folder of the built programs, the plug-ins' list, the test plug-in's
list and a scratch folder as arguments, then scenarios (default: all
that are tests; main_thread is a measurement). Pictures are left in the scratch folder for a
person to look at.
"""

import os
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ET

PROGRAMS, PLUGINS, TEST_PLUGIN, SCRATCH = sys.argv[1:5]
ASKED = sys.argv[5:]


def phantom(name, *arguments):
    folder = os.path.join(SCRATCH, "panel-" + name)
    shutil.rmtree(folder, ignore_errors=True)
    subprocess.run([os.path.join(PROGRAMS, "palpate-testdata"), "phantom", *arguments, "-o", folder], check=True)
    return folder


def both():
    """Two series in a folder."""
    folder = phantom("two", "sphere", "--radius", "25")
    shutil.move(phantom("second", "sphere", "--radius", "18"), os.path.join(folder, "second"))
    return folder


def bad():
    folder = os.path.join(SCRATCH, "panel-bad")
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(folder, "letter.txt"), "w") as file:
        file.write("This is no scan.")
    return folder


def mixed():
    shared = os.environ.get("PALPATE_SHARED_DATA", "")
    folder = os.path.join(shared, "mixed_folder_junk")
    return folder if os.path.isdir(folder) else None


def ball():
    return phantom("ball", "sphere", "--radius", "25")


FOLDERS = {
    "the_scan_changes_in_mid_contact": both,
    "a_series_is_picked": mixed,
    "a_bad_folder": bad,
}
SCENARIOS = [
    "four_clicks",
    "letting_go",
    "escape_releases",
    "escape_releases_under_a_dialog",
    "a_tissue_is_switched",
    "a_curve_is_edited_and_undone",
    "a_fault_is_cleared",
    "the_view_is_clutched",
    "the_scan_changes_in_mid_contact",
    "a_series_is_picked",
    "a_bad_folder",
    "a_state_is_restored",
    "profile_follows_an_edit",
    "recordings_are_replayed_and_compared",
    "closed_in_mid_contact",
]


def plugin_list():
    """One list of all plug-ins: ParaView reads one."""
    plugins = ET.Element("Plugins")
    for file in PLUGINS, TEST_PLUGIN:
        for plugin in ET.parse(file).getroot():
            name = plugin.get("name")
            plugin.set("filename", os.path.join(os.path.dirname(file), name, name + ".so"))
            plugins.append(plugin)
    merged = os.path.join(SCRATCH, "panel-plugins.xml")
    ET.ElementTree(plugins).write(merged)
    return merged


def run(scenario):
    folder = os.environ.get("PALPATE_FOLDER") or FOLDERS.get(scenario, ball)()
    if folder is None:
        print(f"{scenario}: skipped: needs the shared folder of mixed series, which is not beside this checkout")
        return True
    home = os.path.join(SCRATCH, "panel-home")
    shutil.rmtree(home, ignore_errors=True)
    os.makedirs(home)
    environment = dict(os.environ, PALPATE_OPEN=folder, PV_PLUGIN_CONFIG_FILE=plugin_list(), HOME=home,
                       PALPATE_PANEL_TEST=scenario, PALPATE_PICTURES=SCRATCH, LIBGL_ALWAYS_SOFTWARE="1")
    try:
        result = subprocess.run(["paraview"], env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                text=True, timeout=150)
    except subprocess.TimeoutExpired as late:
        print(f"{scenario}: FAILED: the program did not end:\n{(late.stdout or b'').decode()[-2000:]}", flush=True)
        return False
    said = [line for line in result.stdout.splitlines() if line.startswith(scenario)]
    print("\n".join(said) or result.stdout[-3000:], flush=True)
    if result.returncode != 0 and said and "passed" in said[-1]:
        print(f"{scenario}: FAILED: the program then ended with {result.returncode}:\n{result.stdout[-2000:]}")
    return result.returncode == 0


failed = [scenario for scenario in (ASKED or SCENARIOS) if not run(scenario)]
if failed:
    sys.exit("failed: " + ", ".join(failed))
print("all passed")

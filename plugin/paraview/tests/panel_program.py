"""ParaView with the panel and the test plug-in that drives it: what the tests that click share.

Those run in plain Python 3 under xvfb-run with the folder of the built programs, the plug-ins' list, the test plug-in's
list and a scratch folder as arguments, then the scenarios that are asked for (default: all that are tests; --list: print
their names). Pictures are left in the scratch folder for a person to look at.
"""

import os
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ET

import patience

PROGRAMS, PLUGINS, TEST_PLUGIN, SCRATCH = (os.path.abspath(name) for name in sys.argv[1:5])
ASKED = sys.argv[5:]
LONGEST_S = 560  # a busy machine; on a quiet one a quarter of a minute


os.makedirs(SCRATCH, exist_ok=True)


def scratch(name):
    return os.path.join(SCRATCH, name)


def phantom(name, *arguments):
    folder = scratch("panel-" + name)
    shutil.rmtree(folder, ignore_errors=True)
    subprocess.run([os.path.join(PROGRAMS, "palpate-testdata"), "phantom", *arguments, "-o", folder], check=True)
    return folder


HEAD = "/usr/share/doc/invesalius-examples/examples/Cranium.inv3"  # a real CT, where it is installed


def real_head():
    folder = scratch("panel-head")
    shutil.rmtree(folder, ignore_errors=True)
    subprocess.run([os.path.join(PROGRAMS, "palpate-testdata"), "invesalius", "-o", folder], check=True)
    return folder


def ball():
    return phantom("ball", "sphere", "--radius", "25")


def plugin_list(*files):
    """One list of all plug-ins: ParaView reads one."""
    plugins = ET.Element("Plugins")
    for file in files:
        for plugin in ET.parse(file).getroot():
            name = plugin.get("name")
            plugin.set("filename", os.path.join(os.path.dirname(file), name, name + ".so"))
            plugins.append(plugin)
    merged = scratch("panel-plugins.xml")
    ET.ElementTree(plugins).write(merged)
    return merged


def run(scenario, folder=None, arguments=(), plugins=(PLUGINS, TEST_PLUGIN), longest_s=LONGEST_S, said=None, first=True,
        prepare=None, screen=None, **more):
    """The program once, with a folder opened; whether the scenario passed. Its own lines are added to `said`. Where it is
    not its `first` start it has the settings of the one before. `prepare` is given its home. `screen`:
    the size of one of its own, in pixels.
    """
    home = scratch("panel-home")
    if first:
        shutil.rmtree(home, ignore_errors=True)
        os.makedirs(os.path.join(home, ".config", "ParaView"))
    for version in ("5.11.0", "5.13.2") if first else ():  # Debian 12's and 13's
        with open(os.path.join(home, ".config", "ParaView", f"ParaView{version}.ini"), "w") as settings:
            settings.write("[General]\nGeneralSettings.ShowWelcomeDialog=false\n")
    if prepare:
        prepare(home)
    environment = dict(os.environ, PV_PLUGIN_CONFIG_FILE=plugin_list(*plugins), HOME=home,
                       PALPATE_PANEL_TEST=scenario, PALPATE_PICTURES=SCRATCH, LIBGL_ALWAYS_SOFTWARE="1", **more)
    if folder:
        environment["PALPATE_OPEN"] = folder
    try:
        display = ["xvfb-run", "-a", "-s", f"-screen 0 {screen}x24 -noreset"] if screen else []
        result = patience.run([*display, "paraview", *arguments], longest_s, env=environment)
    except subprocess.TimeoutExpired as late:
        print(f"{scenario}: FAILED: the program did not end:\n{late.output[-2000:]}", flush=True)
        return False
    lines = [line for line in result.stdout.splitlines() if line.startswith(scenario)]
    if said is not None:
        said += lines
    print("\n".join(lines) or result.stdout[-3000:], flush=True)
    if result.returncode != 0 and lines and "passed" in lines[-1]:
        print(f"{scenario}: FAILED: the program then ended with {result.returncode}:\n{result.stdout[-2000:]}")
    return result.returncode == 0


def main(tests, measurements=None):
    """Those that are asked for, each a function that says whether it passed; fails where one failed. --list: their names."""
    if ASKED == ["--list"]:
        return print(";".join(tests), end="")
    known = {**tests, **(measurements or {})}
    failed = [name for name in (ASKED or tests) if not known[name]()]
    if failed:
        sys.exit("failed: " + ", ".join(failed))
    print("all passed")

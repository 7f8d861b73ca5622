"""ParaView with the panel and a server of its own on loopback, serial and on two ranks.

Arguments as of panel_program.py, then scenarios (default: all). What the server's folder is called, it is called for this
program, too, unless its name goes through /proc/self/cwd: that is another folder for each.
"""

import os
import shutil
import signal
import socket
import subprocess
import sys
import time

import panel_program
import patience
from made_segmentation import write_segmentation
from mixed_folder import set_headers
from panel_program import ASKED, PLUGINS, PROGRAMS, SCRATCH

# Scenario, ranks, and what is on this machine by the name of the server's folder.
RUNS = [("remote_probe", 1, "same"), ("remote_probe", 2, "same"), ("remote_fetched", 2, "none"),
        ("remote_different", 1, "other"), ("remote_killed", 1, "same"), ("remote_killed", 2, "same"),
        ("remote_noted", 1, "none"), ("remote_frames", 1, "none"), ("remote_structures", 1, "none"),
        ("remote_without_series", 1, "same"), ("remote_without_plugin", 1, "same")]
ENDED_BY_PARAVIEW = 255  # its _exit(-1) where the server is lost


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def serve(ranks, folder, plugins):
    """A server with these plug-ins that runs in `folder`; its port and the process of its last rank."""
    listed = os.path.join(SCRATCH, "remote-plugins.xml")
    with open(listed, "w") as file:
        file.write(f"<Plugins>{plugins}</Plugins>")
    port = free_port()
    command = ["pvserver", f"--server-port={port}", "--force-offscreen-rendering"]
    if ranks > 1:
        command = ["mpiexec", "--allow-run-as-root", "--oversubscribe", "-n", str(ranks), *command]
    log = os.path.join(SCRATCH, "remote-server.log")
    with open(log, "w") as out:
        server = subprocess.Popen(command, cwd=folder, env=dict(os.environ, PV_PLUGIN_CONFIG_FILE=listed),
                                  stdout=out, stderr=subprocess.STDOUT)
    while "Accepting connection" not in open(log).read():
        if server.poll() is not None:
            raise RuntimeError(f"{' '.join(command)} ended with {server.wait()}: {open(log).read()[-1000:]}")
        time.sleep(0.2)
    children = subprocess.run(["pgrep", "-P", str(server.pid), "pvserver"], capture_output=True, text=True).stdout.split()
    return server, port, int(children[-1]) if children else server.pid


def other_voxels(folder, copy):
    """The same series, with one voxel of one slice changed."""
    shutil.copytree(folder, copy)
    name = os.path.join(copy, sorted(os.listdir(copy))[3])
    with open(name, "r+b") as file:
        file.seek(-2000, os.SEEK_END)  # pixels are at a file's end
        byte = file.read(1)
        file.seek(-1, os.SEEK_CUR)
        file.write(bytes([byte[0] ^ 1]))


def beating():
    """Three phases of a ball that shrinks: a series of three frames."""
    folder = os.path.join(SCRATCH, "remote-beating")
    shutil.rmtree(folder, ignore_errors=True)
    for phase in range(3):
        subprocess.run([os.path.join(PROGRAMS, "palpate-testdata"), "phantom", "sphere", "--radius", str(25 - phase),
                        "-o", os.path.join(folder, str(phase))], check=True, stdout=subprocess.DEVNULL)
        for file in sorted(os.listdir(os.path.join(folder, str(phase)))):
            subprocess.run(["dcmodify", "-nb", "-i", f"(0018,1060)={300 * phase}", "-m", "(0020,000e)=1.2.3.4", "-m",
                            "(0020,000d)=1.2.3", "-m", "(0020,0052)=1.2.3.5", os.path.join(folder, str(phase), file)], check=True)
    return folder


def outlined():
    """A scan, and in its folder a segmentation and a label map."""
    folder = panel_program.ball()
    write_segmentation(os.path.join(folder, "liver.dcm"), folder)
    with open(os.path.join(folder, "box.mhd"), "w") as file:  # its voxels lie beside it
        file.write("NDims = 3\nDimSize = 20 20 3\nElementType = MET_UCHAR\nOffset = -10 -10 -5\n"
                   "ElementSpacing = 1 1 5\nElementDataFile = box.raw\n")
    with open(os.path.join(folder, "box.raw"), "wb") as file:
        file.write(b"\1" * (20 * 20 * 3))
    other = set_headers(panel_program.phantom("foreign", "slab"), PatientName="OTHER", PatientID="OTHER",
                        FrameOfReferenceUID="1.2.826.0.1.3680043.10.8.3")
    os.environ["PALPATE_FOREIGN"] = write_segmentation(panel_program.scratch("foreign.dcm"), other, 2)
    return folder


def run(scenario, ranks, here):
    scans = {"remote_frames": beating, "remote_structures": outlined}
    scan = scans.get(scenario, panel_program.ball)()
    there = os.path.join(SCRATCH, "remote-there")
    local = os.path.join(SCRATCH, "remote-here")
    for folder in there, local:
        shutil.rmtree(folder, ignore_errors=True)
        os.makedirs(folder)
    shutil.copytree(scan, os.path.join(there, "scan"))
    if here == "other":
        other_voxels(scan, os.path.join(local, "scan"))
    if scenario == "remote_noted":  # a slice is missing
        os.remove(os.path.join(there, "scan", sorted(os.listdir(os.path.join(there, "scan")))[20]))
    remote = os.path.join(there, "scan") if here == "same" else "/proc/self/cwd/scan"
    plugin = os.path.join(os.path.dirname(PLUGINS), "Palpate", "Palpate.so")
    plugins = f'<Plugin name="Palpate" filename="{plugin}" auto_load="1"/>'
    if scenario == "remote_without_plugin":
        plugins = ""
    if scenario == "remote_without_series":
        remote = local
    recording = os.path.join(SCRATCH, f"{scenario}-{ranks}.h5")
    if os.path.exists(recording):
        os.remove(recording)
    home = os.path.join(SCRATCH, "remote-home")
    shutil.rmtree(home, ignore_errors=True)
    os.makedirs(home)
    server, port, process = serve(ranks, there, plugins)
    listed = panel_program.plugin_list(PLUGINS, panel_program.TEST_PLUGIN)
    environment = dict(os.environ, PV_PLUGIN_CONFIG_FILE=listed, HOME=home, LIBGL_ALWAYS_SOFTWARE="1",
                       PALPATE_PANEL_TEST=scenario, PALPATE_PICTURES=SCRATCH, PALPATE_SERVER=str(port),
                       PALPATE_SERVER_PID=str(process), PALPATE_REMOTE=remote, PALPATE_RECORDING=recording)
    environment.pop("PALPATE_OPEN", None)
    try:
        result = patience.run(["paraview"], int(os.environ.get("PALPATE_PATIENCE", "560")), cwd=local, env=environment)
    except subprocess.TimeoutExpired as late:
        print(f"{scenario}, {ranks} ranks: FAILED: the program did not end:\n{late.output[-2000:]}")
        return False
    finally:
        server.send_signal(signal.SIGTERM)
        try:
            server.wait(20)
        except subprocess.TimeoutExpired:
            server.kill()
    said = [line for line in result.stdout.splitlines() if line.startswith(scenario)]
    print("\n".join(f"{ranks} ranks: {line}" for line in said) or result.stdout[-3000:], flush=True)
    expected = ENDED_BY_PARAVIEW if scenario == "remote_killed" else 0
    if not any("passed" in line for line in said) or result.returncode != expected:
        print(f"{scenario}, {ranks} ranks: FAILED: the program ended with {result.returncode}:\n{result.stdout[-2000:]}")
        return False
    if "without" in scenario or scenario == "remote_noted":
        return True
    return repeats(recording, os.path.join(there, "scan"), "felt: frame 0, 2 of 0 to 2" if "frames" in scenario else "")


def repeats(recording, scan, felt):
    """Whether the recording was closed in good order, and is the same again of the server's own files."""
    done = subprocess.run([os.path.join(PROGRAMS, "palpate"), "replay", recording, scan], capture_output=True, text=True)
    good = done.returncode == 0 and "to the last bit" in done.stdout and felt in done.stdout and "good order" not in done.stderr
    print(f"  {done.stdout.strip() if good else 'FAILED: ' + done.stdout + done.stderr}", flush=True)
    return good


if __name__ == "__main__":
    began = time.monotonic()
    failed = [f"{name}, {ranks} ranks" for name, ranks, here in RUNS
              if (not ASKED or name in ASKED or f"{name}:{ranks}" in ASKED) and not run(name, ranks, here)]
    if failed:
        sys.exit("failed: " + "; ".join(failed))
    print(f"all passed in {time.monotonic() - began:.0f} s")

#!/usr/bin/env bash
# Runs inside a bare root, as root: the packages in /root/packages alone are installed and tried, then removed.
set -euo pipefail
cd /root
install() { apt-get -q install -y --no-install-recommends "$@" >>apt.log 2>&1 || { tail -n 20 apt.log; exit 1; }; }
say() { printf -- '-- %s\n' "$*"; }
apt-get -q update >apt.log

say "palpate alone: a phantom is made, felt and replayed"
install ./packages/palpate_*.deb
palpate --version
palpate-testdata phantom slab --size 32,32,32 -o phantom >/dev/null
palpate probe phantom --scene ct-skin-and-bone -o session >probe.txt
for file in summary.txt slice.png force-depth.png recording.h5; do [ -s "session/$file" ]; done
palpate replay session/recording.h5 phantom
palpate devices >devices.txt || true
[ -x /usr/libexec/palpate/palpate-guardian ] && [ -s /usr/lib/udev/rules.d/60-palpate.rules ]
for page in palpate palpate-probe palpate-testdata; do [ -s "/usr/share/man/man1/$page.1.gz" ]; done
# bash completes a command and an option.
bash -c 'set -e; . /usr/share/bash-completion/completions/palpate
  COMP_WORDS=(palpate pro) COMP_CWORD=1; _palpate; [ "${COMPREPLY[*]}" = "profile probe" ]
  COMP_WORDS=(palpate probe --sce) COMP_CWORD=2; _palpate; [ "${COMPREPLY[*]}" = --scene ]'

say "palpate-paraview: ParaView loads it without any set-up"
install ./packages/palpate-paraview_*.deb xvfb xauth libgl1-mesa-dri
rm -f loaded.txt
# The script writes loaded.txt and ends ParaView.
xvfb-run -a -s "-screen 0 1366x768x24 -noreset" timeout 300 env LIBGL_ALWAYS_SOFTWARE=1 paraview --script=/root/plugin_loads.py >paraview.log 2>&1 || true
cat loaded.txt 2>/dev/null || { tail -n 40 paraview.log; exit 1; }
grep -qx passed loaded.txt

say "libpalpate-dev: a program outside builds and runs"
install ./packages/libpalpate-dev_*.deb g++ cmake make
cmake -S outside -B outside/build >cmake.log 2>&1 || { cat cmake.log; exit 1; }
cmake --build outside/build >cmake.log 2>&1 || { cat cmake.log; exit 1; }
outside/build/outside

say "installed again and removed: nothing is left"
apt-get -q install -y --reinstall ./packages/*.deb >>apt.log 2>&1
apt-get -q purge -y palpate palpate-paraview libpalpate-dev >>apt.log 2>&1
left=$(find /etc /usr /var/lib -xdev -iname '*palpate*' -not -path '/var/lib/apt/*' -not -path '*/__pycache__/*')
[ -z "$left" ] && [ ! -e /usr/bin/paraview.conf ] || { echo "left behind: $left" >&2; exit 1; }

#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
#
# Checks the FPGA part and ends in `N passed, N failed`. Installs what is missing: GHDL with apt (only then root is
# needed), the Python tools into build/fpga-venv, or FPGA_VENV. Arguments go to run.py.
set -euo pipefail

here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
venv=${FPGA_VENV:-$root/build/fpga-venv}

fail() {
    echo "fpga: $1" >&2
    echo "0 passed, 1 failed"
    exit 1
}

install_debian() {
    local run=()
    [ "$(id -u)" = 0 ] || run=(sudo)
    echo "fpga: installing $*"
    { "${run[@]}" apt-get update && "${run[@]}" apt-get install -y "$@"; } || fail "install $* with apt-get, then run this again"
}

# cocotb needs a Python that comes as a shared library
usable_python() {
    "$1" - <<'EOF' 2>/dev/null
import ctypes.util, sys, sysconfig, os, ensurepip, venv
name = sysconfig.get_config_var("INSTSONAME") or ""
folder = sysconfig.get_config_var("LIBDIR") or ""
shared = ".so" in name and (os.path.exists(os.path.join(folder, name)) or ctypes.util.find_library(f"python3.{sys.version_info[1]}"))
sys.exit(0 if sys.version_info >= (3, 11) and shared else 1)
EOF
}

command -v ghdl >/dev/null || install_debian ghdl

if ! cmp -s "$here/requirements.txt" "$venv/requirements.txt"; then
    python=
    for candidate in python3 /usr/bin/python3; do
        if usable_python "$candidate"; then python=$candidate; break; fi
    done
    if [ -z "$python" ]; then
        install_debian python3 python3-venv
        install_debian "libpython$(/usr/bin/python3 -c 'import sys; print("%d.%d" % sys.version_info[:2])')"
        python=/usr/bin/python3
    fi
    echo "fpga: installing cocotb and the register and style tools into $venv"
    rm -rf "$venv"
    mkdir -p "$(dirname "$venv")"
    "$python" -m venv "$venv" || fail "cannot make a virtual environment with $python"
    "$venv/bin/pip" install --quiet --disable-pip-version-check -r "$here/requirements.txt" ||
        fail "cannot install the Python packages of fpga/test/requirements.txt"
    cp "$here/requirements.txt" "$venv/requirements.txt"
fi

PATH=$venv/bin:$PATH exec "$venv/bin/python" "$here/run.py" "$@"

#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
#
# tests/eval/run.sh [DATA_DIR] [OPTION...]   scores the built elements on scenes whose depth is known; --help lists the options
# tests/eval/run.sh --self-check             tests the scoring itself
#
# A scene is a folder of DATA_DIR with view.png and disp.png. Without DATA_DIR the public motorcycle scene (Middlebury 2014)
# is fetched from a package of scikit-image. Everything fetched is kept in build/eval. BUILD names another build folder.
set -euo pipefail
cd "$(dirname "$0")/../.."
. pipelines/setup.sh

folder=$PWD/build/eval
python=$folder/venv/bin/python

make_python() {
    [ ! -e "$folder/venv/ready" ] || return 0
    say "Making a Python environment in $folder/venv"
    python3 -m venv "$folder/venv"
    "$python" -m pip install --quiet --disable-pip-version-check numpy opencv-python-headless scikit-image scipy
    touch "$folder/venv/ready"
}

# fetch_motorcycle: view.png and disp.png of the scene that scikit-image 0.17 carried.
fetch_motorcycle() {
    [ ! -s "$folder/scenes/motorcycle/disp.png" ] || return 0
    say "Fetching the motorcycle scene"
    mkdir -p "$folder/scenes/motorcycle"
    "$python" -m pip download --quiet --disable-pip-version-check scikit-image==0.17.2 --no-deps --only-binary=:all: \
        --python-version 3.7 --implementation cp --platform manylinux1_x86_64 --dest "$folder"
    "$python" tests/eval/unpack_motorcycle.py "$folder"/scikit_image-0.17.2-*.whl "$folder/scenes/motorcycle"
}

data=()
if [ $# -gt 0 ] && [[ $1 != -* ]]; then
    data=("$(realpath -- "$1")")
    shift
fi

make_python
if [ -z "${BUILD:-}" ]; then
    say "Building in build/"
    build build --buildtype=release -Dtests=disabled
fi
enter "${BUILD:-build}"
if [ "${1:-}" = --self-check ]; then
    exec "$python" tests/eval/test_eval.py
fi
if [ ${#data[@]} -eq 0 ]; then
    fetch_motorcycle
    data=("$folder/scenes")
fi
exec "$python" tests/eval/evaluate.py "${data[@]}" "$@"

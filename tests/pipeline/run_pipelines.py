#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""Runs the pipelines printed in the given files and folders, as printed, and speaks TAP; why one fails is on stderr.

    *.gst           one pipeline a file, below its comments
    *.md            every gst-launch-1.0 command of the code blocks; not of docs/elements, which are made of doc comments
    *.c, *.cpp      every |[ gst-launch-1.0 ... ]| of the doc comments

Each must end by itself with status 0, and neither warn nor complain. They run one after the other, in the order of the files,
in one temporary folder, so that a pipeline can read what an earlier one wrote. One that names a device which is not here is
skipped, and so is one with libcamerasrc where there is no camera for it.
"""
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile

STRINGS = pathlib.Path(__file__).parents[2] / 'pipelines/strings'
SECONDS_EACH = 60
OUR_CATEGORIES = ('lenssweep*', 'focalstack*', 'dff*', 'aif*', 'depth*', 'lightfield*')
COMPLAINT = re.compile(r'^WARNING:|^ERROR:| (WARN|ERROR) |-(CRITICAL|WARNING) \*\*|runtime error:|ERROR: AddressSanitizer',
                       re.MULTILINE)


def commands_of_text(text):
    """The gst-launch-1.0 commands of shell lines, continuation lines joined to theirs."""
    lines = text.replace('\\\n', ' ').splitlines()
    return [' '.join(line.split()) for line in lines if line.strip().startswith('gst-launch-1.0')]


def commands_of(path):
    text = path.read_text()
    if path.suffix == '.gst':
        pipeline = ' '.join(line for line in text.splitlines() if not line.startswith('#'))
        return ['gst-launch-1.0 ' + ' '.join(pipeline.split())]
    if path.suffix == '.md':
        blocks = re.findall(r'^```\w*\n(.*?)^```', text, re.MULTILINE | re.DOTALL)
        return [command for block in blocks for command in commands_of_text(block)]
    blocks = re.findall(r'\|\[(.*?)\]\|', text, re.DOTALL)
    return [command for block in blocks for command in commands_of_text(re.sub(r'^ \*', '', block, flags=re.MULTILINE))]


def files_of(path):
    if path.is_file():
        return [path]
    return sorted(file for file in path.rglob('*') if file.suffix in ('.gst', '.md', '.c', '.cpp') and file.parent.name != 'elements')


def has_element(name):
    return subprocess.run(['gst-inspect-1.0', '--exists', name], stdout=subprocess.DEVNULL, check=False).returncode == 0


def missing_device(command):
    """The first device file that the command names and this machine does not have, or None."""
    if 'libcamerasrc' in command and not (os.path.exists('/dev/media0') and has_element('libcamerasrc')):
        return 'camera of libcamera'
    return next((path for path in re.findall(r'/dev/[\w/-]+', command) if not os.path.exists(path)), None)


def run(command, folder):
    """None if all went well, else what to tell the developer."""
    environment = dict(os.environ, GST_DEBUG=','.join(['1'] + [name + ':2' for name in OUR_CATEGORIES]),
                       GST_DEBUG_NO_COLOR='1', GST_PLUGIN_FEATURE_RANK='fakevideosink:MAX')  # no windows
    if 'DFF_PRELOAD' in environment:  # gst-launch-1.0 is not built with the sanitizers that our plug-ins want
        environment['LD_PRELOAD'] = environment['DFF_PRELOAD']
    process = subprocess.Popen(['bash', '-c', 'exec ' + command], cwd=folder, env=environment, text=True,
                               stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                               start_new_session=True)
    try:
        output, _ = process.communicate(timeout=SECONDS_EACH)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        output, _ = process.communicate()
        return f'did not end within {SECONDS_EACH} s\n{output}'
    if process.returncode != 0:
        return f'ended with status {process.returncode}\n{output}'
    return f'complained\n{output}' if COMPLAINT.search(output) else None


def main(paths):
    files = [file for path in map(pathlib.Path, paths) for file in files_of(path)]
    found = [(file.name, command) for file in files for command in commands_of(file)]
    print(f'1..{len(found)}', flush=True)
    failures = 0
    with tempfile.TemporaryDirectory() as folder:
        for file in STRINGS.glob('*.yml'):  # which some pipelines read
            shutil.copy(file, folder)
        for number, (name, command) in enumerate(found, 1):
            device = missing_device(command)
            if device:
                print(f'ok {number} - {name} # SKIP no {device}', flush=True)
                continue
            problem = run(command, folder)
            failures += problem is not None
            print(f'{"ok" if problem is None else "not ok"} {number} - {name}: {command.replace("#", "")}', flush=True)
            if problem:  # on stderr: Meson prints nothing else of a TAP test that failed
                lines = [command, *problem.splitlines()[:200]]
                print('\n'.join('# ' + line for line in lines), file=sys.stderr, flush=True)
    return failures > 0


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))

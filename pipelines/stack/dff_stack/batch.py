# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""Many stacks: each a run of dff-stack in a process of its own, one after the other or on a Dask cluster.

A task is subprocess.run and a command, so that workers need dff-stack but none of its Python. What is done is told by the files
that are there, which appear when they are whole.
"""
import contextlib
import dataclasses
import pathlib
import subprocess
import sys

from dff_stack import Unusable, memory, pictures, printable
from dff_stack.progress import spoken

RETRIES = 3  # of a stack whose worker died


@dataclasses.dataclass
class Stack:
    name: str
    folder: pathlib.Path
    picture: pathlib.Path
    depth: pathlib.Path

    @property
    def is_done(self):
        return self.picture.exists() and self.depth.exists()


def stacks_in(folder, results):
    """A stack for each folder in `folder`, as people count."""
    folder, results = pathlib.Path(folder), pathlib.Path(results)
    if not folder.is_dir():
        raise Unusable(f'{folder} is not a folder')
    found = sorted((path for path in folder.iterdir() if path.is_dir() and not path.name.startswith('.')
                    and path.resolve() != results.resolve()), key=pictures.counting_order)
    if not found:
        raise Unusable(f'{folder} holds no folders; --batch takes a folder of folders, each with the pictures of a sweep')
    return [Stack(path.name, path, results / f'{path.name}.tif', results / f'{path.name}-depth.tif') for path in found]


def command(stack, passed_on):
    """It ends when the worker that started it ends."""
    return ['setpriv', '--pdeathsig', 'TERM', sys.executable, str(pathlib.Path(sys.argv[0]).resolve()), str(stack.folder.resolve()),
            '--output', str(stack.picture.resolve()), '--depth', str(stack.depth.resolve()), '--quiet', *passed_on]


HOW = {'stdin': subprocess.DEVNULL, 'stdout': subprocess.DEVNULL, 'stderr': subprocess.PIPE, 'text': True, 'errors': 'replace'}


def verdict(stack, finished):
    """Nothing, or why there is no result."""
    if finished.returncode == 0 and stack.is_done:
        return None
    lines = [line for line in finished.stderr.splitlines() if line.strip()]
    if finished.returncode < 0:
        return f'ended by signal {-finished.returncode}'
    return lines[-1].removeprefix('dff-stack: ') if lines else f'ended with status {finished.returncode}'


def one_after_the_other(stacks, passed_on):
    for stack in stacks:
        yield stack, verdict(stack, subprocess.run(command(stack, passed_on), **HOW, check=False))


@contextlib.contextmanager
def cluster(scheduler, workers):
    """A client of a cluster that is there, or of one that is started here."""
    try:
        import distributed
    except ImportError as error:
        raise Unusable('--workers and --scheduler need dask.distributed: install python3-distributed') from error
    if scheduler:
        try:
            with distributed.Client(scheduler, timeout='10s') as client:
                yield client
        except (OSError, ValueError) as error:
            raise Unusable(f'there is no Dask scheduler at {scheduler}: {error}') from error
        return
    with distributed.LocalCluster(n_workers=workers, threads_per_worker=1, memory_limit=0, dashboard_address=None,
                                  silence_logs='CRITICAL') as local:
        with distributed.Client(local) as client:
            yield client


def on_cluster(stacks, passed_on, scheduler, workers):
    with cluster(scheduler, workers) as client:
        from distributed import as_completed
        tasks = {client.submit(subprocess.run, command(stack, passed_on), **HOW, pure=False, retries=RETRIES, key=f'dff-{number}-{id(stack)}'):
                 stack for number, stack in enumerate(stacks)}
        for task in as_completed(tasks):
            stack = tasks[task]
            if task.status == 'finished':
                yield stack, verdict(stack, task.result())
            else:
                yield stack, f'its workers died: {task.exception()}'


def passed_on(options, shares):
    """What of the options each stack gets."""
    words = [f'--order={options.order}', f'--align={options.align}', f'--even={options.even}', f'--bad-pixels={options.bad_pixels}',
             f'--prefer={options.prefer}']
    words += ['--far-first'] * options.far_first + ['--preview'] * options.preview
    words += [f'--step={options.step!r}'] if options.step else []
    words += ['--use-alignment', str(pathlib.Path(options.use_alignment).resolve())] if options.use_alignment else []
    if options.memory or not options.scheduler:
        words.append(f'--memory={int(memory.to_use(options.memory) / shares / 2**20)}M')
    return words


def run(options, progress, say):
    """Works through the stacks. Returns the names of those that failed, with the reasons."""
    results = pathlib.Path(options.output)
    results.mkdir(parents=True, exist_ok=True)
    stacks = stacks_in(options.batch, results)
    waiting = [stack for stack in stacks if not stack.is_done]
    if len(waiting) < len(stacks):
        say(f'   {len(stacks) - len(waiting)} of {len(stacks)} stacks are there already')
    progress.begin(f'{len(waiting)} stacks', len(waiting))
    options_of_each = passed_on(options, options.workers or 1)
    on_dask = options.scheduler or options.workers
    work = on_cluster(waiting, options_of_each, options.scheduler, options.workers) if on_dask else \
        one_after_the_other(waiting, options_of_each)
    failed = {}
    for stack, reason in work:
        if reason:
            failed[stack.name] = reason
        say(f'   {stack.name}: {reason or "done"}')
        progress.step()
    progress.end()
    print_table(stacks, failed, progress.seconds())
    return failed


def print_table(stacks, failed, seconds):
    width = max(len(printable(stack.name)) for stack in stacks)
    for stack in stacks:
        print(f'{printable(stack.name):{width}}  {"FAILED: " + failed[stack.name] if stack.name in failed else printable(stack.picture)}')
    print(f'{len(stacks) - len(failed)} stacks done, {len(failed)} failed, {spoken(seconds)}')

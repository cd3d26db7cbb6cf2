# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""The tools of tools.txt, unpacked from Debian's packages into private roots; nothing of the machine is changed.

A root is a folder with the packages of one suite and what they need. Tools run in it by chroot, for another user than
root in a user namespace. FPGA_TOOLS is the folder of the roots instead of one in the user's cache, FPGA_MIRROR an
archive of Debian instead of the machine's own.
"""

import fcntl
import hashlib
import os
import re
import shutil
import subprocess
from functools import cache
from pathlib import Path

FPGA = Path(__file__).resolve().parent.parent
CACHE = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
ROOTS = Path(os.environ.get("FPGA_TOOLS", CACHE / "gst-plugins-dff" / "fpga-tools"))
# Where the tools see their files; each checkout has a folder of its own
WORK = "/work-" + hashlib.sha256(str(FPGA).encode()).hexdigest()[:8]
# Large files of other parts
UNUSED = ("usr/share/nextpnr/himbaechel/xilinx/chipdb-xc7[as]*", "usr/share/prjxray/database/[aks]*", "usr/share/doc",
          "usr/share/man", "usr/share/trellis/database/Mach*", "usr/share/nextpnr/ice40/chipdb-[138u]*",
          "usr/share/nextpnr/ecp5/chipdb-45k.bin")
KEYS = "/usr/share/keyrings/debian-archive-keyring.gpg"
DOWNLOAD_LIMIT_S = 900
# ldconfig has not run in a root, and libtrellis lies in a folder of its own
ENVIRONMENT = {"PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "LC_ALL": "C",
               "LD_LIBRARY_PATH": "/usr/lib/x86_64-linux-gnu/trellis:/usr/lib/aarch64-linux-gnu/trellis"}


class Unavailable(Exception):
    """The packages cannot be had here; says why."""


class Failed(Exception):
    """A tool ended with an error; says which, and what it wrote."""


class Root:
    """The private root of one suite. Files for its tools lie in `work`, which they see as WORK."""

    def __init__(self, suite):
        self.folder = ROOTS / suite
        self.work = self.folder / WORK.lstrip("/")

    def run(self, *command, output=None):
        """Runs a tool. What it writes to stdout goes into the file `output` of `work`, the rest is given back."""
        with open(self.work / output if output else os.devnull, "wb") as file:
            result = subprocess.run([*self.enter(), *command], check=False, text=True,
                                    env=ENVIRONMENT, stdin=subprocess.DEVNULL,
                                    stdout=file if output else subprocess.PIPE, stderr=subprocess.STDOUT
                                    if not output else subprocess.PIPE)
        text = (result.stderr if output else result.stdout) or ""
        if result.returncode:
            raise Failed(f"{command[0]} ended with {result.returncode}:\n{text[-6000:]}")
        return text

    def enter(self):
        """What a command begins with that runs in the root."""
        return [*([] if os.geteuid() == 0 else ["unshare", "-r"]), "chroot", str(self.folder)]

    def can_be_entered(self):
        """Containers may forbid it. chroot ends with 127 where it has come in and there is no such program."""
        return subprocess.run([*self.enter(), "/nonexistent"], capture_output=True, check=False).returncode == 127

    def fresh(self, name):
        """An empty folder of this name in `work`: (as the machine sees it, as the tools see it)."""
        shutil.rmtree(self.work / name, ignore_errors=True)
        (self.work / name).mkdir(parents=True)
        return self.work / name, f"{WORK}/{name}"


def pins(suite):
    """[(package, version)] of tools.txt."""
    lines = (FPGA / "tools.txt").read_text(encoding="utf-8").splitlines()
    return [tuple(line.split()[1:]) for line in lines if line.split()[:1] == [suite]]


@cache
def reason_against(suite):
    """Why the packages of a suite cannot be had here; empty if its root is ready."""
    try:
        prepare(Root(suite), suite)
    except Unavailable as reason:
        return str(reason)
    return ""


def root_of(suite):
    """The root of a suite, ready for its tools."""
    if reason_against(suite):
        raise Unavailable(reason_against(suite))
    return Root(suite)


def prepare(root, suite):
    """Unpacks the root if it is not there yet, or not of the versions wanted."""
    stamp = root.folder / "unpacked"
    wanted = "\n".join(f"{package} {version}" for package, version in pins(suite))
    ROOTS.mkdir(parents=True, exist_ok=True)
    with open(ROOTS / "lock", "w", encoding="utf-8") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not stamp.exists() or stamp.read_text(encoding="utf-8") != wanted:
            unpack(suite, root)
            stamp.write_text(wanted, encoding="utf-8")
    root.work.mkdir(exist_ok=True)
    if not root.can_be_entered():
        raise Unavailable("this machine lets nobody run programs in a root of their own (chroot)")


def unpack(suite, root):
    """Downloads and unpacks; raises Unavailable with the reason."""
    for program, package in (("apt-get", "apt"), ("dpkg-deb", "dpkg"), ("unshare", "util-linux")):
        if not shutil.which(program):
            raise Unavailable(f"the packages of the tools need {package}")
    print(f"fpga: unpacking tools of Debian {suite} into {root.folder}", flush=True)
    shutil.rmtree(root.folder, ignore_errors=True)
    apt = Apt(suite, root.folder / "apt")
    apt.update()
    packages = apt.download()
    # What a merged /usr looks like before its package's scripts have run
    for name in ("bin", "sbin", "lib", "lib64"):
        (root.folder / "usr" / name).mkdir(parents=True, exist_ok=True)
        (root.folder / name).symlink_to(f"usr/{name}")
    (root.folder / "dev").mkdir()
    (root.folder / "dev" / "null").touch()
    (root.folder / "tmp").mkdir()
    # There is no /proc; what the tools ask it is in which folder they lie
    (root.folder / "proc" / "self").mkdir(parents=True)
    (root.folder / "proc" / "self" / "exe").symlink_to("/usr/bin/yosys")
    for package in packages:
        subprocess.run(["dpkg-deb", "-x", package, root.folder], check=True)
    for pattern in ("apt", *UNUSED):
        for path in root.folder.glob(pattern):
            shutil.rmtree(path) if path.is_dir() else path.unlink()


class Apt:
    """apt with a configuration, lists and a cache of its own."""

    def __init__(self, suite, folder):
        self.suite, self.folder = suite, folder
        for name in ("lists/partial", "cache/archives/partial", "state"):
            (folder / name).mkdir(parents=True)
        (folder / "state" / "status").touch()
        (folder / "sources.list").write_text(f"deb [signed-by={KEYS}] {mirror()} {suite} main\n", encoding="utf-8")
        settings = {"Dir::Etc::sourcelist": folder / "sources.list", "Dir::Etc::sourceparts": "/nonexistent",
                    "Dir::Etc::preferencesparts": "/nonexistent", "Dir::State::lists": folder / "lists",
                    "Dir::State::status": folder / "state" / "status", "Dir::Cache": folder / "cache",
                    "APT::Sandbox::User": "", "APT::Install-Recommends": "false", "Acquire::Languages": "none",
                    "Acquire::Retries": "2", "Debug::NoLocking": "true"}
        (folder / "apt.conf").write_text("".join(f'{name} "{value}";\n' for name, value in settings.items()),
                                         encoding="utf-8")

    def get(self, *arguments):
        try:
            result = subprocess.run(["apt-get", *arguments], env=os.environ | {"APT_CONFIG": self.folder / "apt.conf"},
                                    capture_output=True, text=True, timeout=DOWNLOAD_LIMIT_S, check=False,
                                    stdin=subprocess.DEVNULL)
        except subprocess.TimeoutExpired:
            raise Unavailable(f"the packages of {self.suite} did not come in {DOWNLOAD_LIMIT_S} s") from None
        complaints = [line for line in result.stderr.splitlines() if line.startswith("E: ")]
        if result.returncode or complaints:
            raise Unavailable(f"{self.suite}: " + (complaints or ["apt-get failed"])[0].removeprefix("E: "))

    def update(self):
        self.get("update", "--error-on=any")

    def download(self):
        """The files of the packages and of what they need."""
        self.get("install", "-y", "--download-only", *(f"{package}={version}" for package, version in pins(self.suite)))
        return sorted((self.folder / "cache" / "archives").glob("*.deb"))


def mirror():
    """Where this machine has its own Debian packages from."""
    if "FPGA_MIRROR" in os.environ:
        return os.environ["FPGA_MIRROR"]
    if not Path(KEYS).exists():
        raise Unavailable("this machine does not know Debian's keys (package debian-archive-keyring)")
    listed = subprocess.run(["apt-get", "update", "--print-uris"], capture_output=True, text=True, check=False).stdout
    found = re.search(r"^'(\S+/debian)/dists/", listed, re.MULTILINE)
    if found:
        return found.group(1)
    raise Unavailable("this machine has no mirror of Debian; FPGA_MIRROR can name one")

"""A copy of the tree in which one fault after the other is planted, built and tested."""

import hashlib
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import time

from rooms import touches

PYTHON = "/usr/bin/python3"
TOO_LONG = "too long"  # what tells of a test that ran out of time, and of one with a run of the program that did
ENVIRONMENT = {
    **os.environ,
    "PATH": "/usr/bin:" + os.environ["PATH"],
    "OMPI_ALLOW_RUN_AS_ROOT": "1",
    "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    "OMPI_MCA_rmaps_base_oversubscribe": "1",
    "OMPI_MCA_mpi_yield_when_idle": "1",
    "OMPI_MCA_pml": "ob1",  # as in tests/run
    "OMP_WAIT_POLICY": "passive",
    "PYTHONDONTWRITEBYTECODE": "1",
    "RHEGMA_TIMEOUT": "200",
}


def command(words, cwd, limit, **environment):
    """Status and output of a command; None for the status where it took longer than `limit` seconds. It and what it
    started are ended then."""
    process = subprocess.Popen(words, cwd=cwd, env={**ENVIRONMENT, **environment}, stdin=subprocess.DEVNULL,
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT, start_new_session=True, text=True,
                               errors="replace")
    try:
        output, _ = process.communicate(timeout=limit)
        return process.returncode, output
    except subprocess.TimeoutExpired:
        return None, ""
    finally:
        try:
            os.killpg(process.pid, signal.SIGKILL)
        except ProcessLookupError:
            pass
        process.wait()


class Bench:
    def __init__(self, root, place):
        """place: a directory, made or brought up to date with the files of the tree at `root` that Git knows."""
        self.tree, self.build = place / "tree", place / "tree" / "build"
        self.scratch = place / "scratch"
        names = subprocess.run(["git", "ls-files"], cwd=root, capture_output=True, text=True, check=True).stdout.split("\n")
        known = {name for name in names if name and (root / name).is_file()}
        for old in [p for p in self.tree.rglob("*") if p.is_file() and self.build not in p.parents]:
            if str(old.relative_to(self.tree)) not in known:
                old.unlink()
        for name in known:
            source, target = root / name, self.tree / name
            if not target.exists() or target.read_bytes() != source.read_bytes():
                target.parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(source, target)
        (self.tree / ".git").mkdir(exist_ok=True)  # so that nobody takes the tree around for this one

    def make(self):
        """Sets the build up and builds the tree as it is; raises where that fails."""
        if not (self.build / "build.ninja").exists():
            status, output = command(["meson", "setup", "build", "-Dwerror=true", "-Dtests=true", "-Dbench=true"], self.tree, 600)
            if status != 0:
                raise RuntimeError(output)
        status, output = self.ninja()
        if status != 0:
            raise RuntimeError(output)
        self.objects = self.codes()
        listed = command(["meson", "introspect", "--tests", "build"], self.tree, 60)[1]
        self.programs = {t["name"]: t for t in json.loads(listed)}
        self.files = {p.name: p for p in sorted((self.tree / "tests").rglob("test_*.py"))}

    def ninja(self, *targets):
        return command(["ninja", "-C", "build", "-j", "1", *targets], self.tree, 1200)

    def compiles(self):
        """Compiles the tree as it is, without linking the programs: None where that fails, else whether it holds other
        machine code than that of the tree without a fault."""
        for targets in (["rhegma", "kernels/libkernels-reference.a"], []):
            if self.ninja(*targets)[0] != 0:
                return None
            if self.changed():
                return True
        return False

    def link(self, name):
        """The programs that a test runs."""
        if name in self.files:
            return self.ninja(*[t for t in ("rhegma", "rhegma-mesh", "rhegma-bench", "rhegma-pattern") if (self.build / t).exists()])
        words = [self.build / word for word in self.programs[name]["cmd"]]
        return self.ninja(*[str(path.relative_to(self.build)) for path in words if self.build in path.parents and path.is_file()])

    def codes(self):
        """Hash and time of every object file: what a fault that changes no machine code leaves alone."""
        return {p: (p.stat().st_mtime_ns, hashlib.sha256(p.read_bytes()).digest()) for p in self.build.rglob("*.o")}

    def changed(self):
        """Whether the build holds other machine code than that of the tree as it is."""
        for path, (time_of, digest) in self.objects.items():
            if path.stat().st_mtime_ns != time_of and hashlib.sha256(path.read_bytes()).digest() != digest:
                return True
        return False

    def tests_of(self, path):
        """Names of the tests that touch a file."""
        names = []
        for name in self.programs:
            if touches(re.sub(r"-[123]$", "", name), path):
                names.append(name)
        return names + [name for name in self.files if touches(name, path)]

    def run(self, name, limit):
        """Runs one test: whether it passed, seconds, and what told that it did not."""
        shutil.rmtree(self.scratch, ignore_errors=True)
        self.scratch.mkdir(parents=True)
        self.link(name)
        begin = time.monotonic()
        if name in self.programs:
            test = self.programs[name]
            status, output = command(test["cmd"], test["workdir"] or self.build, limit, **test["env"], TMPDIR=str(self.scratch))
            tap = test["protocol"] == "tap"
            passed = status == 0 and not (tap and (re.search(r"^not ok", output, re.M) or not re.search(r"^ok", output, re.M)))
            words = re.search(r"^not ok.*", output, re.M)
        else:
            status, output = command([PYTHON, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", "--no-header", str(self.files[name])],
                                     self.tree, limit, TMPDIR=str(self.scratch))
            passed = status == 0
            words = re.search(r"^(?:FAILED|ERROR) .*", output, re.M)
        seconds = time.monotonic() - begin
        shutil.rmtree(self.scratch, ignore_errors=True)
        if passed:
            return True, seconds, ""
        late = status is None or name in self.files and "TimeoutExpired" in output
        return False, seconds, TOO_LONG if late else words[0][:200] if words else f"status {status}"

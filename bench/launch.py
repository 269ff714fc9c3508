"""Starts Rhegma from Python. What all studies have in common, with the standard library alone: clusters have often no more.

    launch.run("bench/examples/spall/spall.yaml", out, {"time.end": 1e-7})
"""

import json
import os
import pathlib
import shlex
import subprocess
import sys
import time

NAME = pathlib.Path(sys.argv[0]).name
ROOT = pathlib.Path(__file__).resolve().parent.parent


class BadInput(Exception):
    """Something the user can put right; its text says what and where."""

    status = 2


class Failed(BadInput):
    """A program that ended with an exit status that was not expected."""

    def __init__(self, command, process):
        status = process.returncode
        super().__init__(f"{shlex.join(command)} failed with status {status}\n{process.stderr or ''}".rstrip())
        self.status = status if status > 0 else 1  # below 0: the signal that killed it


def exit_with(main):
    """Ends a script with the status that its main function returns (none: 0); where input is at fault, with a message
    and 2, where a program failed, with its status."""
    try:
        status = main()
    except BadInput as error:
        print(f"{NAME}: {error}", file=sys.stderr)
        status = error.status
    sys.exit(status)


def program():
    """The program that environment variable RHEGMA names, else the one of this tree."""
    return pathlib.Path(os.environ.get("RHEGMA", ROOT / "build/rhegma"))


def example(name):
    """A file of the examples: bench/examples/*/NAME."""
    found = list((ROOT / "bench/examples").glob(f"*/{name}"))
    if len(found) != 1:
        raise BadInput(f"bench/examples: {len(found) or 'no'} files are called {name}")
    return found[0]


def options(sets):
    """{"a.b": value} as options of the program; JSON is YAML."""
    return [word for key, value in (sets or {}).items() for word in ("--set", f"{key}={json.dumps(value)}")]


def call(command, *, accept=(0,), show=False, **environment):
    """A command to its end: subprocess.CompletedProcess, with its output unless that is shown."""
    command = [str(word) for word in command]
    streams = {} if show else {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    try:
        process = subprocess.run(command, env={**os.environ, **environment}, text=True, **streams)
    except OSError as error:
        raise BadInput(f"{command[0]}: {error.strerror} (is it built? RHEGMA names another program)") from error
    if process.returncode not in accept:
        raise Failed(command, process)
    return process


def run(case, out, sets=None, overrides=(), *, launcher=(), build=None, quiet=True, begin=(), **keywords):
    """Runs a case to its end, with `sets` as {"a.b": value} and the user's own "a.b=value" after them; `build`: directory of
    another program, `launcher`: words in front of it, `begin`: options that say how it begins and where, else as `call`."""
    binary = program() if build is None else pathlib.Path(build) / "rhegma"
    words = [word for text in overrides for word in ("--set", text)]
    return call([*launcher, binary, "run", case, *(begin or ("-o", out)), *(["-q"] if quiet else []), *options(sets), *words], **keywords)


def run_once(case, out, sets=None, overrides=(), *, resume=False, also=(), **keywords):
    """The same, unless a run of these values is there already. Returns the seconds that it took, also of an earlier time.
    `resume`: goes on from the checkpoint of one that was interrupted; `also`: what must be the same besides, as text."""
    record, asked = out.parent / f"{out.name}.run", [str(case), *options(sets), *overrides, *also]
    try:
        before = read_mapping(record, json.loads)
    except BadInput:
        before = {}
    same = before.get("asked") == asked
    if same and "seconds" in before and (out / "summary.json").exists():
        return before["seconds"]
    if resume:
        left = any((out / "checkpoints").glob("*"))
        keywords["begin"] = ("--restart", out) if same and left else ("-o", out, "--overwrite")
        out.parent.mkdir(parents=True, exist_ok=True)
        record.write_text(json.dumps({"asked": asked}) + "\n")
    else:
        record.unlink(missing_ok=True)
    begin = time.monotonic()
    run(case, out, sets, overrides, **keywords)
    seconds = time.monotonic() - begin
    record.write_text(json.dumps({"asked": asked, "seconds": seconds}) + "\n")
    return seconds


def ranks_launcher(ranks):
    """What starts so many ranks on this machine, and leaves it to the system where they run."""
    return ["mpirun", "--bind-to", "none", "-n", ranks] if ranks > 1 else []


def read_text(path):
    try:
        return path.read_text()
    except (OSError, UnicodeDecodeError) as error:
        raise BadInput(f"{path}: cannot be read: {getattr(error, 'strerror', None) or error}") from error


def read_mapping(path, parse):
    try:
        data = parse(read_text(path))
    except ValueError as error:
        raise BadInput(f"{path}: {error}") from error
    if not isinstance(data, dict):
        raise BadInput(f"{path}: not a table of keys and values")
    return data


def summary(directory):
    return read_mapping(directory / "summary.json", json.loads)

"""Runs a command in a folder of its own, with limits, and notes what it did."""

import os
import resource
import signal
import subprocess
import time
from pathlib import Path
from typing import NamedTuple

SINGLETON = {"OMPI_MCA_pml": "ob1",
             "OMPI_MCA_btl": "self,vader",
             "OMPI_ALLOW_RUN_AS_ROOT": "1",
             "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}


class Limits(NamedTuple):
    asked_to_stop: float = 15  # s, then SIGTERM
    stopped: float = 20  # s after that, then SIGKILL
    processor: int = 30  # s
    address_space: int = 6 << 30  # bytes
    memory: int = 1536 << 20  # bytes, seen afterwards
    file_size: int = 200 << 20  # bytes


# Addresses are what the shadow memory is made of.
SANITIZED = Limits(asked_to_stop=60, stopped=60, processor=120,
                   address_space=resource.RLIM_INFINITY, memory=6 << 30)


class Outcome(NamedTuple):
    code: int  # negative: minus the signal that ended it
    stdout: str
    stderr: str
    seconds: float
    memory: int  # bytes, largest of the process and those it waited for
    asked_to_stop: bool
    killed: bool
    strangers: list  # what is new or changed outside the run folder


def environment(temporary=None):
    """One process without mpirun, with its temporary files where we look."""
    result = {**os.environ, **SINGLETON}
    if temporary:
        result.update(TMPDIR=str(temporary), HOME=str(temporary),
                      MPLCONFIGDIR=str(temporary))
    return result


def apply(limits):
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    for what, bound in ((resource.RLIMIT_AS, limits.address_space),
                        (resource.RLIMIT_FSIZE, limits.file_size),
                        (resource.RLIMIT_CPU, limits.processor)):
        resource.setrlimit(what, (bound, bound))


def snapshot(box):
    """What must stay as it is: all but the run and temporary files."""
    free = (box / "here/run", box / "here/tmp")
    return {str(path.relative_to(box)):
            path.read_bytes() if path.is_file() and not path.is_symlink()
            else None
            for path in sorted(box.glob("**/*"))
            if not any(path == one or one in path.parents for one in free)}


def send(process, number):
    try:
        os.killpg(process.pid, number)
    except ProcessLookupError:
        pass


def wait(process, limits):
    """Until it ends or has to be ended: status, resources, what was sent."""
    start = time.monotonic()
    asked = killed = False
    while True:
        pid, status, usage = os.wait4(process.pid, os.WNOHANG)
        if pid:
            return os.waitstatus_to_exitcode(status), usage, asked, killed
        seconds = time.monotonic() - start
        if not asked and seconds > limits.asked_to_stop:
            asked = True
            os.kill(process.pid, signal.SIGTERM)
        if not killed and seconds > limits.asked_to_stop + limits.stopped:
            killed = True
            send(process, signal.SIGKILL)
        time.sleep(0.01)


def run(command, box, limits=Limits()):
    """Runs in box/here; box/here/run and box/here/tmp are for the program."""
    here = box / "here"
    (here / "tmp").mkdir(exist_ok=True)
    streams = [box / "stdout", box / "stderr"]
    for stream in streams:
        stream.touch()
    before = snapshot(here.parent)
    start = time.monotonic()
    with open(streams[0], "wb") as out, open(streams[1], "wb") as err:
        process = subprocess.Popen(
            command, cwd=here, env=environment(here / "tmp"), stdout=out,
            stderr=err, stdin=subprocess.DEVNULL, start_new_session=True,
            preexec_fn=lambda: apply(limits))
        code, usage, asked, killed = wait(process, limits)
    process.returncode = code
    send(process, signal.SIGKILL)  # what it may have left behind
    seconds = time.monotonic() - start
    after = snapshot(here.parent)
    strangers = sorted(name for name in before.keys() | after.keys()
                       if Path(name).name not in ("stdout", "stderr")
                       and (name not in before or name not in after
                            or before[name] != after[name]))
    said = [stream.read_bytes().decode("utf-8", "replace")
            for stream in streams]
    return Outcome(code, *said, seconds, usage.ru_maxrss * 1024, asked,
                   killed, strangers)

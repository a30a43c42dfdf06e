"""A process that sees only what it is given, and takes only what it may; on Linux.

Its root is a list: /usr, Python's folders, and those that are named, for bubblewrap mounts nothing
else (Debian: `apt install bubblewrap`). So there is no home in it, no socket that has a path and no
device but null, zero and random. A filter refuses the system calls that lead out of it, or to
memory that no limit counts. Where root starts it, it becomes a user whom nobody else is.
"""

from __future__ import annotations

import errno
import functools
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from itertools import count
from pathlib import Path
from typing import BinaryIO

SCRATCH = 200_000_000  # bytes of the files in /tmp, which count as memory
_ROOT = "bin", "sbin", "lib", "lib32", "lib64", "libx32"  # links into /usr, or folders
_NEW = "--unshare-pid --unshare-ipc --unshare-uts --unshare-cgroup-try"
_FIRST_USER = 2_000_000_000  # beyond all that a system gives away
_users = count(os.getpid() % 100_000 * 1000)
# What leads out of a namespace, into another process or the system's own affairs, and what holds
# memory or files that are nobody's.
_REFUSED = """
add_key keyctl request_key ptrace process_vm_readv process_vm_writev kcmp pidfd_getfd userfaultfd
bpf perf_event_open fanotify_init open_by_handle_at name_to_handle_at lookup_dcookie syslog acct
mount umount2 pivot_root chroot move_mount open_tree fsopen fsconfig fsmount fspick mount_setattr
unshare setns swapon swapoff reboot kexec_load kexec_file_load init_module finit_module
delete_module quotactl modify_ldt vhangup io_uring_setup io_uring_enter io_uring_register
shmget shmat shmctl msgget semget mq_open memfd_create memfd_secret
"""
_NEW_USER, _INPUT = 0x1000_0000, 0x5412  # CLONE_NEWUSER, TIOCSTI
_FAMILIES = {1, 2, 10, 16}  # Unix, IPv4 and 6, netlink: a network of its own has them
_SHARED = 0x21  # MAP_SHARED and MAP_ANONYMOUS: memory that stays when who filled it has ended


def write_filter(file: BinaryIO) -> None:
    """Write the filter of system calls, as the kernel reads it, and go back to its beginning."""
    import pyseccomp as seccomp

    no = seccomp.ERRNO(errno.EPERM)
    rules = seccomp.SyscallFilter(seccomp.ALLOW)
    for name in _REFUSED.split():
        with suppress(RuntimeError):  # not on every machine
            rules.add_rule(no, name)
    rules.add_rule(seccomp.ERRNO(errno.ENOSYS), "clone3")  # its flags are out of a filter's reach
    rules.add_rule(no, "clone", seccomp.Arg(0, seccomp.MASKED_EQ, _NEW_USER, _NEW_USER))
    rules.add_rule(no, "mmap", seccomp.Arg(3, seccomp.MASKED_EQ, _SHARED, _SHARED))
    rules.add_rule(no, "ioctl", seccomp.Arg(1, seccomp.MASKED_EQ, 0xFFFF_FFFF, _INPUT))
    other = seccomp.ERRNO(errno.EAFNOSUPPORT)
    rules.add_rule(other, "socket", seccomp.Arg(0, seccomp.GT, max(_FAMILIES)))  # vsock, say
    for family in {*range(max(_FAMILIES))} - _FAMILIES:
        rules.add_rule(other, "socket", seccomp.Arg(0, seccomp.EQ, family))
    rules.export_bpf(file)
    file.seek(0)


def caged(
    command: list[str],
    *,
    reads: Iterable[Path] = (),
    writes: Iterable[Path] = (),
    hidden: Iterable[Path] = (),
    rules: int | None = None,
    user: int | None = None,
    network: bool = False,
) -> list[str]:
    """Return the command that runs `command` in /tmp, in a root of its own.

    reads, writes: the folders that it sees, and may write to; hidden: what it does not see of them.
    rules: the filter's file, open. user: whom root becomes.
    """
    words = ["--die-with-parent", "--new-session", *_NEW.split()]
    words += [] if network else ["--unshare-net"]
    words += [] if user is not None else ["--unshare-user"]
    for path in map(Path("/").joinpath, _ROOT):
        if path.is_symlink():
            words += ["--symlink", os.readlink(path), str(path)]
        elif path.is_dir():
            words += ["--ro-bind", str(path), str(path)]
    words += ["--proc", "/proc", "--ro-bind", "/proc/sys", "/proc/sys", "--dev", "/dev"]
    for place, size in ("/dev/shm", SCRATCH // 4), ("/tmp", SCRATCH):
        words += ["--perms", "1777", "--size", str(size), "--tmpfs", place]
    python = {Path(each) for each in (sys.base_prefix, sys.prefix)}
    for path in sorted({Path("/usr"), Path("/etc/ld.so.cache"), *python, *reads}):
        words += [*_reachable(path), "--ro-bind-try", str(path), str(path)]
    for path in writes:
        words += [*_reachable(path), "--bind", str(path), str(path)]
    for path in hidden:
        if path.is_dir() and any(path.is_relative_to(each) for each in (*python, *reads)):
            words += ["--size", "4096", "--tmpfs", str(path)]
    words += ["--remount-ro", "/dev", "--remount-ro", "/", "--chdir", "/tmp"]
    if user is not None:
        to = f"setpriv --reuid {user} --regid {user} --clear-groups --inh-caps=-all"
        command = [*to.split(), "--bounding-set=-all", *command]
    words += [] if rules is None else ["--seccomp", str(rules)]
    return ["bwrap", *words, "--", *command]


def _reachable(path: Path) -> list[str]:
    """The folders above it, which bubblewrap would close to all but who starts it."""
    above = [str(each) for each in path.parents if each != Path("/")]
    return [word for each in reversed(above) for word in ("--perms", "0755", "--dir", each)]


def next_user() -> int | None:
    """Whom the next process becomes; None unless root starts it."""
    root = os.name == "posix" and os.geteuid() == 0
    return _FIRST_USER + next(_users) if root else None


@functools.cache
def holds() -> bool:
    """Whether this system can cage a process."""
    command = [sys.executable, "-c", ""]
    with suppress(OSError, RuntimeError, ImportError), tempfile.TemporaryFile() as rules:
        write_filter(rules)
        command = caged(command, rules=rules.fileno(), user=next_user())
        return not subprocess.run(
            command, capture_output=True, pass_fds=[rules.fileno()]
        ).returncode
    return False


def _groups() -> Iterator[Path]:
    """The control groups in which a process of ours may be grouped, if the system lets us."""
    with suppress(OSError):
        for line in Path("/proc/self/cgroup").read_text().splitlines():
            _, kinds, path = line.split(":", 2)
            own = Path("/sys/fs/cgroup", kinds, path.lstrip("/"))
            if not kinds:  # of the second version, which has processes in its leaves only
                yield own.parent if path != "/" else own
            elif kinds in ("memory", "pids"):
                yield own


@contextmanager
def grouped(command: list[str], memory: int, processes: int) -> Iterator[list[str]]:
    """Give the command that runs `command` with what all its processes may take together.

    Where no control groups can be made, that is `command`.
    """
    limits = {"memory.max": memory, "memory.limit_in_bytes": memory, "pids.max": processes}
    made = []
    for above in _groups():
        with suppress(OSError):
            (above / "cgroup.procs").stat()  # else it is a folder like others
            own = Path(tempfile.mkdtemp(prefix="wmr-", dir=above))
            made.append(own)
            for name, most in limits.items():
                if (own / name).exists():
                    (own / name).write_text(str(most))
    joins = 'for each in $0; do echo 0 2>/dev/null >"$each/cgroup.procs"; done; exec "$@"'
    try:
        yield ["sh", "-c", joins, " ".join(map(str, made)), *command] if made else command
    finally:
        for own in made:
            for _ in range(100):  # until the last process has gone
                with suppress(OSError):
                    own.rmdir()
                if not own.exists():
                    break
                time.sleep(0.02)

"""The system calls of a command, each of which is then attacked."""

import re

SYNCS = ["fsync", "fdatasync"]
RENAMES = ["rename", "renameat", "renameat2"]
CHANGES = ["openat", "write", *SYNCS, *RENAMES, "mkdir", "ftruncate"]
FAILED = ["read", *CHANGES]
KILLED = [*CHANGES, "flock", "close", "unlink", "unlinkat", "rmdir"]

LINE = re.compile(r"^(\d+) +(\w+)\((.*)$")
RELATIVE = re.compile(r'^(AT_FDCWD, )?"[^/]')


def calls(program, here, arguments, wanted, **options):
    """The calls that a command makes in a folder, as pairs of a name and a number from 1.

    strace counts the calls of each thread by itself. What a process does before it comes to the
    folder, such as loading libraries, is left out.
    """
    trace = here.parent / f"{here.name}.trace"
    result = program.run(here, arguments, trace=(",".join(wanted), trace), **options)
    counts, found, come = {}, {}, False
    for line in trace.read_text(errors="replace").splitlines():
        match = LINE.match(line)
        if not match:
            continue
        thread, name, rest = match.groups()
        number = counts[thread, name] = counts.get((thread, name), 0) + 1
        come = come or str(here) in rest or RELATIVE.match(rest)
        if come:
            found.setdefault((name, number))
    trace.unlink()
    return list(found), result

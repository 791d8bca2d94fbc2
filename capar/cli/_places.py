"""What is said of a file or folder that the system does not give."""

import errno
import os

REMEDIES = {
    errno.EACCES: "Take the rights to it, or name another place.",
    errno.EPERM: "Take the rights to it, or name another place.",
    errno.EROFS: "Name a place that can be written to.",
    errno.ENOENT: "Name one that exists; a new file needs a folder that is there.",
    errno.ENOTDIR: "What stands before the last / has to be a folder.",
    errno.EISDIR: "Name a file; this is a folder.",
    errno.EEXIST: "Name another place.",
    errno.ENOSPC: "Make room, or name a place on another disk.",
    errno.EDQUOT: "Make room, or name a place on another disk.",
    errno.ENAMETOOLONG: "Choose a shorter name.",
    errno.ELOOP: "Links there lead in a circle; name what they should lead to.",
}
"""What would have been right, by what went wrong."""


def told(error: OSError) -> str:
    """What went wrong, where, and what would have been right."""
    names = [os.fsdecode(each) for each in (error.filename, error.filename2) if _named(each)]
    where = f"{' -> '.join(names)}: " if names else ""
    what = error.strerror or str(error) or type(error).__name__
    remedy = REMEDIES.get(error.errno or 0, "Name another file or folder.")
    return f"{where}cannot be used: {what}. {remedy}"


def _named(name: object) -> bool:
    return isinstance(name, str | bytes | os.PathLike)

"""Memory that was freed, given back to the operating system."""

import ctypes
from functools import cache


def return_freed_memory() -> None:
    """Give back what the allocator keeps of freed arrays; without effect where it is not glibc's.

    Arrays of a long capture lie among smaller things that live on, so that glibc keeps their pages
    when they are freed. What is allocated next, by the solver for instance, then adds to them.
    """
    trim = _malloc_trim()
    if trim is not None:
        trim(0)


@cache
def _malloc_trim() -> "ctypes._NamedFuncPointer | None":
    try:
        return ctypes.CDLL(None).malloc_trim
    except (AttributeError, OSError, TypeError):  # musl, macOS; Windows has no such handle
        return None

"""Errors by cause: what is wrong, where, and what to do next."""

from __future__ import annotations

from typing import Sequence


class Error(Exception):
    """Every failure of the library. str() is "<sentence>: <next step>".

    indices: offending vertices, faces, lines …, counted from 0; may be empty.
    where: what they count: "vertices", "edges" (as pairs of vertices), "faces", "loops", "points", …
    """

    def __init__(self, sentence: str, indices: Sequence[int] = (), where: str = "none") -> None:
        super().__init__(sentence)
        self.indices = list(indices)
        self.where = where

    def __reduce__(self) -> tuple[type[Error], tuple[str, list[int], str]]:
        return type(self), (str(self), self.indices, self.where)

    def __str__(self) -> str:
        return str(self.args[0])


class BadOption(Error, ValueError):
    """An option or argument has an impossible value."""


class Unreadable(Error, OSError):
    """A file is missing, truncated, malformed or too large to be true."""


class BadMesh(Error, ValueError):
    """The mesh cannot carry the computation (see diagnose)."""


class BadBoundary(Error, ValueError):
    """Boundary data is missing, contradictory or impossible."""


class NotSolved(Error, ArithmeticError):
    """A factorisation or an iteration failed."""


class Unwritable(Error, OSError):
    """An output could not be written."""


class Cancelled(Error):
    """A progress callback asked to stop."""

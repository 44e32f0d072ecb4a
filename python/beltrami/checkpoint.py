"""What a cohort keeps in a folder, so that nothing that is finished is done again: outcomes of jobs, distances of pairs."""

from __future__ import annotations

import hashlib
import json
import os
import pickle
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Dict, List, Optional, Tuple

from .errors import Unreadable


@dataclass
class Outcome:
    """What became of one job: its value, or why there is none."""

    id: str
    value: Any = None
    cause: Optional[str] = None
    message: Optional[str] = None
    seconds: float = 0.0

    @property
    def done(self) -> bool:
        return self.cause is None


class PairFile:
    """Distances by the contents of two files and the options: a line of JSON each, of which a last one that is cut
    short is passed over."""

    def __init__(self, folder: Optional[Path], options: str) -> None:
        self.options = hashlib.sha256(options.encode()).hexdigest()[:16]
        self.rows: Dict[Tuple[str, str], List[Any]] = {}
        self.path = None if folder is None else folder / "pairs.jsonl"
        if self.path is None or not self.path.exists():
            return
        for line in self.path.read_text(encoding="utf-8").splitlines():
            try:
                row = json.loads(line)
                if row["options"] == self.options:
                    self.rows[row["a"], row["b"]] = [*map(float, row["distance"]), bool(row["settled"])]
            except (ValueError, KeyError, TypeError):
                continue

    def get(self, a: str, b: str) -> Optional[List[Any]]:
        return self.rows.get((a, b))

    def add(self, a: str, b: str, row: List[Any]) -> None:
        self.rows[a, b] = row
        if self.path is None:
            return
        line = json.dumps({"a": a, "b": b, "options": self.options, "distance": row[:3], "settled": row[3]})
        with self.path.open("ab") as file:
            file.write(b"\n" + line.encode())  # before it: what was cut short stays a line of its own


def kept(path: Path, argument: Any, retry: bool) -> Optional[Outcome]:
    """The outcome of a job with this very argument, if there is one that counts."""
    try:
        digest, outcome = pickle.loads(path.read_bytes())
    except Exception:  # not there, cut short, or of classes that are gone
        return None
    if digest != digest_of(argument) or not isinstance(outcome, Outcome) or (retry and not outcome.done):
        return None
    return outcome


def digest_of(argument: Any) -> str:
    return hashlib.sha256(pickle.dumps(argument, protocol=4)).hexdigest()


def digest_of_file(path: str) -> str:
    try:
        return hashlib.sha256(Path(path).read_bytes()).hexdigest()[:24]
    except OSError as error:
        raise Unreadable(f"{path} cannot be read: {error.strerror}") from None


def write(path: Path, data: bytes) -> None:
    """A whole file, or none."""
    temporary = path.with_name(f".{path.name}.{os.getpid()}.{time.monotonic_ns()}.tmp")
    try:
        temporary.write_bytes(data)
        os.replace(temporary, path)
    finally:
        temporary.unlink(missing_ok=True)

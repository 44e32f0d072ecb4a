"""Writes beltrami/_core.pyi from the signatures in the docstrings that pybind11 makes: /usr/bin/python3 python/tools/stubs.py

With --check it only says whether the file is up to date.
"""

import inspect
import re
import sys
from pathlib import Path
from typing import Any

import beltrami
from beltrami import _core

HEADER = '''"""Types of the library in C++; written by python/tools/stubs.py."""

import os
from typing import Any, Callable, Dict, Iterator, List, Optional, Sequence, Tuple, Union

from numpy.typing import NDArray

'''


def types(text: str) -> str:
    """A signature of pybind11 as one of Python."""
    text = text.replace("beltrami._core.", "")
    text = re.sub(r"beltrami::(?:python::)?(?:\(anonymous namespace\)::)?(\w+?)(?:Object)?\b", r"\1", text)  # bound later
    text = re.sub(r"numpy\.ndarray\[[^\[\]]*(\[[^\]]*\])?[^\[\]]*\]", "numpy.ndarray", text)
    text = text.replace("numpy.ndarray", "NDArray[Any]")
    text = re.sub(r"scipy\.sparse\.\w+\[[^\]]*\]", "Any", text)
    text = text.replace("os.PathLike", "Union[str, os.PathLike[str]]")
    for generic in ("List", "Tuple", "Dict", "Optional"):
        text = re.sub(rf"(?<![\w.]){generic}\[", f"{generic}[", text)
    text = re.sub(r"Annotated\[(.*?), FixedSize\(\d+\)\]", r"\1", text)
    text = re.sub(r"(?<![\w.])tuple(?![\w(])", "Tuple[Any, ...]", text)
    text = re.sub(r"(?<![\w.])list(?![\w(])", "List[Any]", text)
    text = re.sub(r"(?<![\w.])dict(?![\w(])", "Dict[Any, Any]", text)
    text = re.sub(r"\b(int|float)\[\d+\]", r"\1", text)  # of std::array
    text = re.sub(r"(?<![\w.])(function|Callable)(?![\w\[(:])", "Callable[..., Any]", text)
    taken, arrow, given = text.rpartition("->")
    taken = re.sub(r"\b(?!self\b|arg0\b)(\w+): Mesh\b", r"\1: Union[Mesh, Surface]", taken.replace("List[", "Sequence["))  # surfaces become meshes
    text = taken + arrow + given
    text = re.sub(r"\bIterator(?!\[)", "Iterator[Any]", text)
    text = text.replace("iterator", "Iterator[Any]")
    text = text.replace("**kwargs)", "**kwargs: Any)")
    return re.sub(r"(: [\w\[\], .]+) = (?:\[[^\]]*\]|<[^>]*>|'[^']*'|\([^)]*\)|[^,)]+)", r"\1 = ...", text)


def signature(function: Any, name: str) -> str:
    """The first line of a docstring, as a definition."""
    line = (function.__doc__ or "").split("\n", 1)[0]
    match = re.match(rf"{re.escape(name)}(\(.*\) -> .*)$", line)
    if not match:
        raise ValueError(f"{name} has no signature: {line!r}")
    return types(match[1])


def method(name: str, function: Any) -> str:
    if inspect.isfunction(function):  # written in Python, in beltrami/show.py
        text = str(inspect.signature(function)).replace("'", "").replace("_core.", "")
        text = re.sub(r"^\(\w+: (PlanarMap|Any)", "(self", text).replace("PathLike", "Union[str, os.PathLike[str]]")
        return f"    def {name}{text}: ..."
    text = re.sub(r"^\(self: [\w.]+", "(self", signature(function, name))
    text = re.sub(r"^\(arg0: [\w.]+", "(self", text)
    text = text.replace("(self, arg0: ", "(self, other: ").replace("arg1: ", "other: ")
    if name == "__init__":
        text = text.replace("-> object", "-> None")
    return f"    def {name}{text}: ..."


def class_stub(cls: type) -> str:
    bases = [base.__name__ for base in cls.__bases__ if base.__module__ == cls.__module__]
    lines = [f"class {cls.__name__}" + (f"({', '.join(bases)})" if bases else "") + ":"]
    for name, member in sorted(vars(cls).items()):
        if isinstance(member, property):
            result = re.search(r"-> (.*)$", (member.fget.__doc__ or "").split("\n", 1)[0])
            kind = types(result[1]) if result else "Any"
            lines += ["    @property", f"    def {name}(self) -> {kind}: ..."]
        elif isinstance(member, staticmethod):
            lines += ["    @staticmethod", f"    def {name}{signature(member.__func__, name)}: ..."]
        elif callable(member) and (not name.startswith("_") or name in SPECIAL):
            if (member.__doc__ or "").startswith("Initialize self"):
                continue
            lines.append(method(name, member))
    return "\n".join(lines if len(lines) > 1 else [lines[0] + " ..."])


SPECIAL = {"__init__", "__call__", "__len__", "__float__", "__add__", "__iter__", "__str__", "__repr__", "_repr_html_", "_page"}


def stubs() -> str:
    parts = ["__version__: str"]
    for name, member in sorted(vars(_core).items()):
        if isinstance(member, type):
            parts.append(class_stub(member))
        elif callable(member):
            parts.append(f"def {name}{signature(member, name)}: ...")
    return HEADER + "\n".join(parts) + "\n"


def main() -> int:
    path = Path(__file__).resolve().parent.parent / "beltrami" / "_core.pyi"
    if "--check" in sys.argv[1:]:
        return 0 if path.read_text(encoding="utf-8") == stubs() else 1
    path.write_text(stubs(), encoding="utf-8")
    return 0


if __name__ == "__main__":
    assert beltrami
    sys.exit(main())

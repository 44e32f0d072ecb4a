"""Cohorts: one function of many scans, and all distances of them, on this machine or a Dask cluster; what is finished
is kept in a folder, and nothing of it is done again.

    python3 -m beltrami.cohort --scheduler tcp://node1:8786 -o out scans/*.obj

docs/cohorts.md is the guide.
"""

from __future__ import annotations

import argparse
import importlib
import json
import os
import pickle
import re
import sys
import time
from pathlib import Path
from typing import Any, Callable, Dict, Iterator, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np

from . import _core
from .checkpoint import Outcome, PairFile, digest_of, digest_of_file, kept, write
from .distances import Distances
from .errors import BadBoundary, BadOption, Error, NotSolved

PathLike = Union[str, "os.PathLike[str]"]
Progress = Callable[[int, int], object]


def run(
    function: Callable[[Any], Any],
    jobs: Mapping[str, Any],
    folder: PathLike,
    client: Any = None,
    progress: Optional[Progress] = None,
    retry: bool = False,
) -> Dict[str, Outcome]:
    """Calls function(argument) for every id: argument of jobs, and keeps each value in the folder, as a pickle.

    client: a dask.distributed.Client, on whose workers the function is called (None: here). What is in the folder from
    an earlier call of the same jobs is not computed again, jobs that failed only with retry=True; an error of a job is
    its outcome, with cause and message. progress(done, all) is called after each.

    Raises BadOption for ids that name no file.
    """
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    for name in jobs:
        if not re.fullmatch(r"\w[\w.-]{0,199}", name):
            raise BadOption(f"the id {name!r} is no name of a file: use letters, digits, '.', '_' and '-'")
    outcomes = {name: outcome for name in jobs if (outcome := kept(folder / f"{name}.pickle", jobs[name], retry))}
    waiting = {name: argument for name, argument in jobs.items() if name not in outcomes}
    for name, outcome in _results(function, waiting, client):
        write(folder / f"{name}.pickle", pickle.dumps((digest_of(jobs[name]), outcome)))
        outcomes[name] = outcome
        if progress is not None:
            progress(len(outcomes), len(jobs))
    return {name: outcomes[name] for name in jobs}


def distance_matrix(
    paths: Sequence[PathLike],
    client: Any = None,
    checkpoint: Optional[PathLike] = None,
    outer: int = 0,
    names: Optional[Sequence[str]] = None,
    progress: Optional[Progress] = None,
    **options: Any,
) -> Distances:
    """All distances of the meshes of some files, of genus 0 with equally many boundary loops.

    Charts are made once for each file, on one of the workers, and sent to where they are needed. Every distance is that
    of teichmueller_distance(surface i, surface j, outer, **options) for i < j, to the last bit.

    client: a dask.distributed.Client (None: all is computed here, one pair after another, on the library's threads).
    checkpoint: a folder that keeps charts and distances, by the contents of the files and the options; with a cluster its
    workers must see it. A worker that dies costs the pair it was at. names: of the scans (None: of their files).

    Raises Unreadable, BadMesh, BadBoundary naming two files, BadOption, NotSolved, each naming its files.
    """
    files = [os.path.abspath(os.fspath(path)) for path in paths]
    if len(files) < 2:
        raise BadOption("a distance needs two shapes")
    labels = list(names) if names is not None else _labels(files)
    if len(labels) != len(files):
        raise BadOption(f"there are {len(labels)} names for {len(files)} shapes")
    folder = None if checkpoint is None else Path(checkpoint).resolve()
    if folder is not None:
        (folder / "charts").mkdir(parents=True, exist_ok=True)
    digests = [digest_of_file(file) for file in files]
    text = json.dumps([outer, options], sort_keys=True, default=repr)
    found = PairFile(folder, text)
    n = len(files)
    pairs = [(i, j) for i in range(n) for j in range(i + 1, n)]
    done = len([1 for i, j in pairs if found.get(digests[i], digests[j])])
    waiting = [(i, j) for i, j in pairs if not found.get(digests[i], digests[j])]
    if waiting:
        charts = [None if folder is None else os.fspath(folder / "charts" / f"{digest}-{outer}.pickle") for digest in digests]
        for (i, j), row in _pairs(files, charts, labels, waiting, client, outer, options):
            found.add(digests[i], digests[j], row)
            done += 1
            if progress is not None:
                progress(done, len(pairs))
    result = Distances(labels, np.zeros((n, n)), np.zeros((n, n)), np.zeros((n, n)))
    for i, j in pairs:
        known = found.get(digests[i], digests[j])
        assert known is not None
        for matrix, value in zip((result.distance, result.lower, result.upper), known):
            matrix[i, j] = matrix[j, i] = value
        if not known[3]:
            result.unsettled.append((i, j))
    return result


# How a pair is found. These are called on workers, by their names.


def _on_worker(function: Callable[..., Any], *arguments: Any) -> Any:
    """The workers share the processors, so that each call has one thread: results do not depend on it."""
    before = _core.thread_count()
    _core.set_thread_count(1)
    try:
        return function(*arguments)
    finally:
        _core.set_thread_count(before)


def _prepared(path: str, chart: Optional[str], outer: int) -> _core.Surface:
    """The surface of a file with its charts, from the checkpoint where it is there."""
    if chart is not None:
        try:
            found: object = pickle.loads(Path(chart).read_bytes())
            if isinstance(found, _core.Surface):
                return found
        except Exception:  # not there, or of another version of the library
            pass
    try:
        surface = _core.Surface(_core.read_mesh(path))
        if len(surface.boundary_loops) > 2:  # of others moduli decide, without a chart
            surface.prepare(outer)
    except Error as error:
        raise _named(error, path) from None
    if chart is not None:
        write(Path(chart), pickle.dumps(surface))
    return surface


def _distance(a: _core.Surface, b: _core.Surface, names: Tuple[str, str], outer: int, options: Dict[str, Any]) -> List[Any]:
    if len(a.boundary_loops) != len(b.boundary_loops):
        raise BadBoundary(
            f"{names[0]} has {len(a.boundary_loops)} boundary loops, {names[1]} has {len(b.boundary_loops)}: "
            "compare shapes with the same number of holes"
        )
    try:
        found = _core.teichmueller_distance(a, b, outer, **options)
    except Error as error:
        raise _named(error, " and ".join(names)) from None
    return [found.distance, found.lower, found.upper, found.settled]


def _named(error: Error, name: str) -> Error:
    return type(error)(f"{name}: {error}", error.indices, error.where)


def _pairs(
    files: List[str],
    charts: List[Optional[str]],
    names: List[str],
    waiting: List[Tuple[int, int]],
    client: Any,
    outer: int,
    options: Dict[str, Any],
) -> Iterator[Tuple[Tuple[int, int], List[Any]]]:
    """The pairs with their distances, as they are found."""
    if client is None:
        surfaces: Dict[int, _core.Surface] = {}
        for i, j in waiting:
            for scan in (i, j):
                if scan not in surfaces:
                    surfaces[scan] = _prepared(files[scan], charts[scan], outer)
            yield (i, j), _distance(surfaces[i], surfaces[j], (names[i], names[j]), outer, options)
        return
    distributed = _distributed()
    needed = sorted({scan for pair in waiting for scan in pair})
    prepared = {scan: client.submit(_on_worker, _prepared, files[scan], charts[scan], outer, pure=False) for scan in needed}
    futures = {
        client.submit(_on_worker, _distance, prepared[i], prepared[j], (names[i], names[j]), outer, options, pure=False): (i, j)
        for i, j in waiting
    }
    try:
        for future in distributed.as_completed(futures):
            i, j = futures[future]
            if future.status == "error" and not isinstance(future.exception(), Error):  # the workers died of it
                raise NotSolved(f"{names[i]} and {names[j]}: {future.exception()}")
            yield (i, j), future.result()
            future.release()
    finally:  # of an error: what is left is not computed
        client.cancel(list(futures))


def _outcome(function: Callable[[Any], Any], name: str, argument: Any) -> Outcome:
    start = time.perf_counter()
    outcome = Outcome(name)
    try:
        outcome.value = function(argument)
    except Exception as error:  # is the job's, whatever it is; the others go on
        outcome.cause, outcome.message = type(error).__name__, str(error)
    outcome.seconds = time.perf_counter() - start
    return outcome


def _results(function: Callable[[Any], Any], jobs: Mapping[str, Any], client: Any) -> Iterator[Tuple[str, Outcome]]:
    if client is None:
        for name, argument in jobs.items():
            yield name, _outcome(function, name, argument)
        return
    distributed = _distributed()
    futures = {client.submit(_on_worker, _outcome, function, name, argument, pure=False): name for name, argument in jobs.items()}
    for future in distributed.as_completed(futures):
        name = futures[future]
        if future.status == "error":  # the workers died of it, time and again
            error = future.exception()
            yield name, Outcome(name, None, type(error).__name__, str(error))
        else:
            yield name, future.result()
        future.release()


def _distributed() -> Any:
    """Dask's package, which is asked for where there is a cluster."""
    return importlib.import_module("distributed")


def _labels(files: List[str]) -> List[str]:
    """The names of files without folders and extensions, or, where two are alike, the files."""
    stems = [Path(file).stem for file in files]
    return stems if len(set(stems)) == len(stems) else files


class _Bar:
    """[####    ] 12 of 30, about 90 s left, on a terminal; else nothing."""

    def __init__(self) -> None:
        self.start: Optional[float] = None
        self.first = 0

    def __call__(self, done: int, count: int) -> None:
        if not sys.stderr.isatty():
            return
        if self.start is None:
            self.start, self.first = time.monotonic(), done - 1
        left = (time.monotonic() - self.start) / max(1, done - self.first) * (count - done)
        filled = 30 * done // count
        print(f"\r[{'#' * filled}{' ' * (30 - filled)}] {done} of {count}, about {left:.0f} s left\x1b[K", end="", file=sys.stderr)
        if done == count:
            print(file=sys.stderr)


def main(arguments: Optional[Sequence[str]] = None) -> int:
    """The command line: distances of some files, their clusters and a picture."""
    parser = argparse.ArgumentParser("python3 -m beltrami.cohort", description="Teichmüller distances of a cohort of scans.")
    parser.add_argument("meshes", nargs="+", metavar="MESH", help="OBJ, PLY, OFF or STL, of genus 0, equally many boundary loops")
    parser.add_argument("-o", "--output", required=True, metavar="DIR", help="where results and the checkpoint go")
    parser.add_argument("--scheduler", metavar="ADDRESS", help="of a Dask cluster, tcp://host:8786")
    parser.add_argument("--scheduler-file", metavar="FILE", help="the file that the scheduler wrote")
    parser.add_argument("--workers", type=int, metavar="N", help="so many processes on this machine, without a cluster")
    parser.add_argument("--outer", type=int, default=0, metavar="LOOP", help="the boundary loop that goes to the outer ones")
    parser.add_argument("--clusters", type=int, default=3, metavar="N", help="how many the picture shows")
    given = parser.parse_args(arguments)
    client = None
    if given.scheduler or given.scheduler_file or given.workers:
        distributed = _distributed()
        if given.scheduler_file:
            client = distributed.Client(scheduler_file=given.scheduler_file)
        else:
            local = {"n_workers": given.workers, "threads_per_worker": 1, "dashboard_address": None}
            client = distributed.Client(given.scheduler or distributed.LocalCluster(**local))
    try:
        found = distance_matrix(given.meshes, client, given.output, given.outer, progress=_Bar())
    except Error as error:
        print(f"beltrami.cohort: {error}", file=sys.stderr)
        return 1
    finally:
        if client is not None:
            client.close()
    found.save(given.output)
    try:
        found.plot(Path(given.output) / "clusters.png", given.clusters)
    except ImportError:
        print("beltrami.cohort: there is no matplotlib, and so no picture", file=sys.stderr)
    print(f"{len(found.names)} scans, {len(found.unsettled)} pairs not settled; wrote {given.output}/distances.csv, .json, clusters.png")
    return 0


if __name__ == "__main__":
    # Of the module by its name, not of __main__: that is where workers look for its functions.
    from beltrami import cohort

    sys.exit(cohort.main())

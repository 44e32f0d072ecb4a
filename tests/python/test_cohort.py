"""Cohorts: checkpoints, a cluster of processes, one of which is killed."""

import json
import os
import pickle
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any, Iterator, List

import numpy as np
import pytest

import beltrami as bt
from beltrami import cohort


def scans(folder: Path, count: int) -> List[str]:
    paths = []
    for i in range(count):
        mesh = bt.circle_domain(1, [(0.4 + 0.02 * i, 0.15 + 0.04 * (i % 3)), (-0.45, 0.2)], edge_length=0.2, seed=i + 1, jitter=0.2)
        x, y = mesh.positions.T
        path = folder / f"scan-{i}.obj"
        bt.write_mesh(path, bt.Mesh(np.column_stack([x, y, 0.4 * x * x - 0.3 * y * y]), mesh.faces))
        paths.append(os.fspath(path))
    return paths


@pytest.fixture(scope="module")
def client() -> Iterator[Any]:
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        with distributed.Client(cluster) as made:
            yield made


def kill_one(client: Any) -> None:
    """One of the cluster's processes; another takes its place."""
    os.kill(next(iter(client.run(os.getpid).values())), signal.SIGKILL)


def test_pickled_surfaces_keep_their_charts(tmp_path: Path) -> None:
    paths = scans(tmp_path, 2)
    a, b = (bt.Surface(bt.read_mesh(path)) for path in paths)
    fresh = bt.teichmueller_distance(a, b)
    a.prepare()
    a2, b2 = pickle.loads(pickle.dumps(a)), pickle.loads(pickle.dumps(b))
    again = bt.teichmueller_distance(a2, b2)
    assert (again.distance, again.lower, again.upper) == (fresh.distance, fresh.lower, fresh.upper)
    assert np.array_equal(a2.positions, a.positions) and np.array_equal(a2.faces, a.faces)
    assert np.array_equal(bt.circle_domain_chart(a2).map, bt.circle_domain_chart(a).map)


def test_distances_are_those_of_single_runs(tmp_path: Path) -> None:
    paths = scans(tmp_path, 4)
    calls: list = []
    found = cohort.distance_matrix(paths, checkpoint=tmp_path / "kept", progress=lambda *c: calls.append(c))
    assert calls == [(i, 6) for i in range(1, 7)]
    surfaces = [bt.Surface(bt.read_mesh(path)) for path in paths]
    assert np.array_equal(found.distance, found.distance.T)
    for i in range(4):
        for j in range(i + 1, 4):
            one = bt.teichmueller_distance(surfaces[i], surfaces[j])
            assert (found.distance[i, j], found.lower[i, j], found.upper[i, j]) == (one.distance, one.lower, one.upper)
    assert np.array_equal(bt.distance_matrix(surfaces)[0], found.distance)

    calls.clear()
    with (tmp_path / "kept" / "pairs.jsonl").open("ab") as file:
        file.write(b'\n{"a": "cut sh')  # as a kill may leave it
    again = cohort.distance_matrix(paths, checkpoint=tmp_path / "kept", progress=lambda *c: calls.append(c))
    assert calls == [] and np.array_equal(again.distance, found.distance)
    V, F = bt.read_mesh(paths[0])
    bt.write_mesh(paths[0], bt.Mesh(V + 1, F))  # other contents: its three distances are new
    cohort.distance_matrix(paths, checkpoint=tmp_path / "kept", progress=lambda *c: calls.append(c))
    assert [done for done, _ in calls] == [4, 5, 6]


def test_a_cluster_loses_a_worker(tmp_path: Path, client: Any) -> None:
    paths = scans(tmp_path, 5)
    wanted = cohort.distance_matrix(paths)
    times: dict = {}

    def progress(done: int, count: int) -> None:
        if done == 3:
            times.update({chart: chart.stat().st_mtime_ns for chart in (tmp_path / "kept" / "charts").iterdir()})
            kill_one(client)

    found = cohort.distance_matrix(paths, client, tmp_path / "kept", progress=progress)
    assert np.array_equal(found.distance, wanted.distance) and np.array_equal(found.lower, wanted.lower)
    lines = [json.loads(line) for line in (tmp_path / "kept" / "pairs.jsonl").read_text().split("\n") if line]
    assert len(lines) == 10 == len({(line["a"], line["b"]) for line in lines})
    assert len(times) >= 2 and all(chart.stat().st_mtime_ns == time_made for chart, time_made in times.items())


def slow_map(argument: Any) -> float:
    path, log, index = argument
    with open(log, "a") as file:
        file.write(f"{index}\n")
    time.sleep(0.05)
    surface = bt.Surface(bt.read_mesh(path))
    if index == 7:
        return bt.extremal_map(surface, bt.boundary_to_disk(surface), max_iterations=-1).K
    return bt.extremal_map(surface, bt.TargetDomain(bt.TargetCurve.circle(0, 1))).K


def test_many_jobs_on_a_cluster_that_loses_a_worker(tmp_path: Path, client: Any) -> None:
    path, log = os.fspath(tmp_path / "disk.obj"), os.fspath(tmp_path / "log")
    bt.write_mesh(path, bt.disk(6))
    jobs = {f"job-{i}": (path, log, i) for i in range(20)}

    def progress(done: int, count: int) -> None:
        if done == 8:
            kill_one(client)

    outcomes = cohort.run(slow_map, jobs, tmp_path / "kept", client, progress=progress)
    assert list(outcomes) == list(jobs)
    assert [o.id for o in outcomes.values() if not o.done] == ["job-7"]
    assert outcomes["job-7"].cause == "BadOption" and "max" in str(outcomes["job-7"].message).lower() or "iteration" in str(outcomes["job-7"].message)
    begun = Path(log).read_text().split()
    # Two processes with a job each, and one more sent ahead: what was in flight is done again, nothing else.
    assert len(set(begun)) == 20 and 20 <= len(begun) <= 22
    again = cohort.run(slow_map, jobs, tmp_path / "kept")
    assert len(Path(log).read_text().split()) == len(begun)
    assert {name: o.value for name, o in again.items()} == {name: o.value for name, o in outcomes.items()}


def fork_job(seed: int) -> float:
    surface = bt.Surface(bt.disk(12, jitter=0.2, seed=seed))
    return bt.extremal_map(surface, bt.boundary_to_disk(surface, 0.5)).K


def test_forked_processes() -> None:
    """multiprocessing's pools, which fork, work also where the library has started threads before."""
    import multiprocessing

    bt.set_thread_count(3)
    wanted = [fork_job(seed) for seed in range(1, 5)]
    with multiprocessing.get_context("fork").Pool(2) as pool:
        assert pool.map_async(fork_job, range(1, 5)).get(timeout=60) == wanted


def test_errors_name_files(tmp_path: Path) -> None:
    paths = scans(tmp_path, 2)
    bt.write_mesh(tmp_path / "disk.obj", bt.disk(5))
    with pytest.raises(bt.BadBoundary, match="scan-0 has 3 boundary loops, disk has 1"):
        cohort.distance_matrix([paths[0], tmp_path / "disk.obj"])
    with pytest.raises(bt.Unreadable):
        cohort.distance_matrix([paths[0], tmp_path / "none.obj"])
    with pytest.raises(bt.BadOption):
        cohort.distance_matrix(paths[:1])
    with pytest.raises(bt.BadOption):
        cohort.run(len, {"../a": []}, tmp_path)


def test_scaling_and_clusters_of_points_in_the_plane() -> None:
    random = np.random.default_rng(1)
    points = np.concatenate([random.normal(size=(5, 2)) * 0.1 + centre for centre in ((0, 0), (5, 0), (0, 3))])
    matrix = np.linalg.norm(points[:, None] - points[None], axis=-1)
    found = cohort.Distances([str(i) for i in range(15)], matrix, matrix, matrix)
    places, values = found.mds()
    assert np.allclose(np.linalg.norm(places[:, None] - places[None], axis=-1), matrix)
    assert np.allclose(values[2:], 0, atol=1e-9)
    assert [len(set(found.clusters(3)[i : i + 5])) for i in (0, 5, 10)] == [1, 1, 1] and len(set(found.clusters(3))) == 3


def test_the_command_line(tmp_path: Path) -> None:
    paths = scans(tmp_path, 3)
    command = [sys.executable, "-m", "beltrami.cohort", *paths, "-o", os.fspath(tmp_path / "out"), "--workers", "2"]
    done = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    record = json.loads((tmp_path / "out" / "distances.json").read_text())
    assert np.array_equal(record["distance"], cohort.distance_matrix(paths).distance)
    assert (tmp_path / "out" / "clusters.png").stat().st_size > 5000
    assert (tmp_path / "out" / "distances.csv").read_text().startswith(",scan-0,scan-1,scan-2\n")

"""A cohort of synthetic scans: 300 maps to the disk as a batch one of whose jobs is killed, and which is itself killed
in the middle; the distances of 40 on a cluster that loses a worker, against single runs; the picture of their clusters.

    PYTHONPATH=build/python /usr/bin/python3 bench/python/cohort.py build/beltrami FOLDER [MAPS] [DISTANCES]
"""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
from distributed import Client, LocalCluster

import beltrami as bt
import scans
from beltrami import cohort


def children(process: int) -> list:
    return list(map(int, Path(f"/proc/{process}/task/{process}/children").read_text().split()))


def finished(out: Path) -> int:
    return len(list(out.glob("scan-*/job.json")))


def maps(command: str, folder: Path, count: int) -> None:
    paths = scans.write(folder / "disks", count, holes=False, edge_length=0.06)
    jobs = folder / "jobs.jsonl"
    lines = [{"id": Path(p).stem, "args": ["map", p, "-o", "map.obj", "--boundary", "disk:0.5"]} for p in paths]
    jobs.write_text("\n".join(map(json.dumps, lines)))
    out = folder / "maps"
    start = time.perf_counter()
    batch = subprocess.Popen([command, "batch", str(jobs), "-o", str(out), "--jobs", "2", "--quiet"])
    while finished(out) < count // 3:
        time.sleep(0.1)
    for job in children(batch.pid)[:1]:
        os.kill(job, signal.SIGKILL)
    while finished(out) < count // 2:
        time.sleep(0.1)
    batch.send_signal(signal.SIGKILL)
    batch.wait()
    before = {path: path.stat().st_mtime_ns for path in out.glob("scan-*/job.json")}
    subprocess.run([command, "batch", str(jobs), "-o", str(out), "--jobs", "2", "--quiet"], check=True)
    outcomes = [json.loads(line) for line in (out / "results.jsonl").read_text().splitlines()]
    untouched = all(path.stat().st_mtime_ns == made for path, made in before.items())
    K = [outcome["numbers"]["K"] for outcome in outcomes]
    print(
        f"{len(outcomes)} maps, {sum(o['status'] == 'done' for o in outcomes)} done, in {time.perf_counter() - start:.0f} s; a job and the "
        f"batch were killed, {len(before)} were finished by then and untouched: {untouched}; K from {min(K):.3f} to {max(K):.3f}, "
        f"{sum(o['numbers']['flipped'] for o in outcomes):.0f} flipped faces"
    )


def distances(folder: Path, count: int) -> None:
    paths = scans.write(folder / "masks", count, edge_length=0.16)
    killed: list = []
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:

        def progress(done: int, pairs: int) -> None:
            if done >= pairs // 2 and not killed:
                killed.append(next(iter(client.run(os.getpid).values())))
                os.kill(killed[0], signal.SIGKILL)

        start = time.perf_counter()
        found = cohort.distance_matrix(paths, client, folder / "distances", progress=progress)
        elapsed = time.perf_counter() - start
    rows = [line for line in (folder / "distances" / "pairs.jsonl").read_text().split("\n") if line]
    start = time.perf_counter()
    surfaces = [bt.Surface(bt.read_mesh(path)) for path in paths]
    single, lower, upper, _ = bt.distance_matrix(surfaces)
    alone = time.perf_counter() - start
    same = all(np.array_equal(a, b) for a, b in ((single, found.distance), (lower, found.lower), (upper, found.upper)))
    families = np.array([seed % len(scans.FAMILIES) for seed in range(count)])
    clusters = found.clusters(len(scans.FAMILIES))
    agree = sum(np.bincount(families[clusters == c]).max() for c in set(clusters))
    print(
        f"{count} scans, {len(rows)} pairs in {elapsed:.0f} s on two processes, one of which was killed; without a cluster {alone:.0f} s; "
        f"symmetric: {np.array_equal(found.distance, found.distance.T)}, the same bytes as single runs: {same}; "
        f"{len(found.unsettled)} not settled; {agree} of {count} in the cluster of their family"
    )
    found.save(folder / "distances")
    found.plot(folder / "distances" / "clusters.png")


if __name__ == "__main__":
    numbers = list(map(int, sys.argv[3:])) + [300, 40][len(sys.argv[3:]) :]
    maps(sys.argv[1], Path(sys.argv[2]), numbers[0])
    distances(Path(sys.argv[2]), numbers[1])

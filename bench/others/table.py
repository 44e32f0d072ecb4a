"""The table of docs/other-programs.md: table.py BELTRAMI BENCH_CGAL MESH ….

Maps of beltrami and of CGAL, all judged by `beltrami measure`. Seconds are those of the parameterization, without files.
"""

import json
import pathlib
import subprocess
import sys
import tempfile

BELTRAMI, CGAL, *MESHES = sys.argv[1:]
PRESCRIBED = ("harmonic", "mean-value", "tutte", "arap")
OF_CGAL = ("harmonic", "mean-value", "tutte", "lscm", "arap")


def run(*words):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, words))}: {done.stderr.strip()}")
    return done.stdout


def row(mesh, method, program, file, seconds):
    record = json.loads(run(BELTRAMI, "measure", file, "--quiet", "--json", "-"))["map"]
    worst = "flipped" if record["flipped"] else f"{record['K_max']:.4g}"
    mu = record["mu"]
    print(f"| {mesh} | {method} | {program} | {worst} | {mu['mean']:.4f} | {mu['std']:.4f} | {record['flipped']} | {seconds:.2f} |", flush=True)


def of_beltrami(mesh, out, method, *options, name=None, command="map"):
    record = json.loads(run(BELTRAMI, command, mesh, "-o", out, "--quiet", "--json", "-", *options))
    row(mesh.stem, name or method, "beltrami", out, record["solve"]["seconds"]["total"])
    return record


print("| scan | method | | K of worst face | mean abs(μ) | std | flips | seconds |\n| --- | --- | --- | --- | --- | --- | --- | --- |")
with tempfile.TemporaryDirectory() as folder:
    out = pathlib.Path(folder, "out.obj")
    for mesh in map(pathlib.Path, MESHES):
        extremal = of_beltrami(mesh, out, "extremal", "--boundary", "disk")["map"]
        for method in PRESCRIBED:
            of_beltrami(mesh, out, method, "--method", method, "--boundary", "disk")
        of_beltrami(mesh, out, "lscm", "--method", "lscm", name="lscm, free")
        of_beltrami(mesh, out, "conformal equivalence, free", command="flatten")
        for method in OF_CGAL:
            row(mesh.stem, method + (", free" if method in ("lscm", "arap") else ""), "CGAL", out, float(run(CGAL, mesh, method, out).split()[-2]))
        print(f"<!-- {mesh.stem}: K* of the disk between {extremal['K_lower']:.4f} and {extremal['K']:.4f}, estimates -->")

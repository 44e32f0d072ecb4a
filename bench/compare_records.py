#!/usr/bin/env python3
"""Whether two builds of the command give the same records, seconds apart.

    bench/compare_records.py OLD NEW [TEST ...]         # tests of tests/cli, by default all
    bench/compare_records.py OLD NEW --sweep [FIRST COUNT]   # two builds of bench_sweep instead: what they print

Runs the tests of the command with both binaries in place of BELTRAMI and compares, call by call, the exit code, what is
printed and every JSON file written, to the last digit. Prints the differences; the exit code is 1 if there is one.
"""

import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
TIMES = re.compile(r"\d+(\.\d+)?(e-?\d+)? ?(s|ms)\b|\d+(\.\d+)? harmonic maps|\d+(\.\d+)? times|\d+\.\d{3}(?=\n)")


def stand_in():
    """Called in place of the command: runs it and keeps what it says."""
    folder = pathlib.Path(os.environ["BELTRAMI_RECORDS"])
    arguments = sys.argv[1:]
    done = subprocess.run([os.environ["BELTRAMI_RECORDED"], *arguments], capture_output=True)
    written = [arguments[i + 1] for i, word in enumerate(arguments[:-1]) if word == "--json" and arguments[i + 1] != "-"]
    kept = {
        "arguments": [re.sub(r"(^|:)/tmp/[^/]*", r"\1/tmp", word) for word in arguments],
        "code": done.returncode,
        "out": done.stdout.decode("utf8", "replace"),
        "err": done.stderr.decode("utf8", "replace"),
        "files": [pathlib.Path(name).read_text() for name in written if os.path.exists(name)],
    }
    (folder / f"{len(list(folder.iterdir())):04}.json").write_text(json.dumps(kept))
    sys.stdout.buffer.write(done.stdout)
    sys.stderr.buffer.write(done.stderr)
    sys.exit(done.returncode)


def without_seconds(value):
    if isinstance(value, dict):
        return {key: without_seconds(item) for key, item in value.items() if key not in ("seconds", "memory")}
    return [without_seconds(item) for item in value] if isinstance(value, list) else value


def comparable(text):
    """A record without its seconds, other text without times; both without the names of temporary folders."""
    try:
        text = json.dumps(without_seconds(json.loads(text)), sort_keys=True)
    except ValueError:
        text = TIMES.sub("…", text)
    return re.sub(r"/tmp/tmp[^/\s]*", "/tmp", text)


def calls(binary, test):
    with tempfile.TemporaryDirectory() as folder:
        environment = os.environ | {
            "BELTRAMI": str(pathlib.Path(__file__).resolve()), "BELTRAMI_RECORDED": str(pathlib.Path(binary).resolve()),
            "BELTRAMI_RECORDS": folder, "PYTHONDONTWRITEBYTECODE": "1",
            "BELTRAMI_TEST_MESHES": os.environ.get("BELTRAMI_TEST_MESHES", str(ROOT.parent / "shared" / "meshes"))}
        subprocess.run([sys.executable, "-m", "unittest", test], cwd=ROOT / "tests" / "cli", env=environment,
                       capture_output=True)
        return [json.loads(path.read_text()) for path in sorted(pathlib.Path(folder).iterdir())]


def differences(old, new):
    """Of two calls, in words."""
    if old["arguments"] != new["arguments"]:
        return ["another call"]
    found = [] if old["code"] == new["code"] else [f"exit code {old['code']} and {new['code']}"]
    pairs = [(key, old[key], new[key]) for key in ("out", "err")]
    pairs += [("record", a, b) for a, b in zip(old["files"], new["files"])]
    for name, a, b in pairs:
        a, b = comparable(a), comparable(b)
        if a != b:
            at = next((i for i, (x, y) in enumerate(zip(a, b)) if x != y), min(len(a), len(b)))
            found.append(f"{name}: …{a[max(0, at - 60):at + 60]!r}… and …{b[max(0, at - 60):at + 60]!r}…")
    return found


def compare_tests(old, new, tests):
    total = different = 0
    for test in tests:
        before, after = calls(old, test), calls(new, test)
        if len(before) != len(after):
            print(f"{test}: {len(before)} calls and {len(after)}")
            different += 1
        for a, b in zip(before, after):
            total += 1
            found = differences(a, b)
            different += bool(found)
            for line in found:
                print(f"{test}: {' '.join(a['arguments'])}\n    {line}")
    print(f"{total} calls, {different} different")
    return different


def compare_sweeps(old, new, seeds):
    said = [comparable(subprocess.run([binary, *seeds], capture_output=True, text=True).stdout) for binary in (old, new)]
    print("the same" if said[0] == said[1] else f"before:\n{said[0]}\nafter:\n{said[1]}")
    return said[0] != said[1]


if __name__ == "__main__":
    if "BELTRAMI_RECORDED" in os.environ:
        stand_in()
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    old, new, *rest = sys.argv[1:]
    if rest[:1] == ["--sweep"]:
        sys.exit(compare_sweeps(old, new, rest[1:]) > 0)
    names = sorted(path.stem for path in (ROOT / "tests" / "cli").glob("test_*.py"))
    sys.exit(compare_tests(old, new, rest or names) > 0)

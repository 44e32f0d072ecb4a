"""beltrami batch: many commands, resumable."""

import json
import os
import signal
import subprocess
import time
import unittest

from support import BELTRAMI, Command, disk, write_obj


class Batch(Command):
    def jobs(self, lines, name="jobs.jsonl"):
        with open(self.path(name), "w") as file:
            file.write("\n".join(json.dumps(line) for line in lines) + "\n")
        return self.path(name)

    def lines(self, folder="out"):
        with open(self.path(f"{folder}/results.jsonl")) as file:
            return {line["id"]: line for line in map(json.loads, file)}

    def map_job(self, name, rings=8, *more):
        write_obj(self.path(f"{name}.obj"), *disk(rings))
        return {"id": name, "args": ["map", self.path(f"{name}.obj"), "-o", "map.obj", "--boundary", "disk:0.5", *more]}

    def test_finished_jobs_stay_and_errors_have_their_cause(self):
        bad = {"id": "none", "args": ["map", self.path("none.obj"), "-o", "map.obj", "--boundary", "disk"]}
        wrong = {"id": "wrong", "args": ["map", "--bondary", "disk"]}
        jobs = self.jobs([self.map_job("a"), bad, wrong, self.map_job("b", 8, "--report=page.html")])
        out = self.path("out")
        self.run_command("batch", jobs, "-o", out, "--jobs", "2", code=8)
        lines = self.lines()
        self.assertEqual(list(lines), ["a", "none", "wrong", "b"])
        self.assertEqual([lines[name]["status"] for name in lines], ["done", "failed", "failed", "done"])
        self.assertEqual(lines["none"]["cause"], "unreadable")
        self.assertIn("none.obj", lines["none"]["message"])
        self.assertEqual(lines["wrong"]["cause"], "bad option")
        self.assertIn("did you mean --boundary", lines["wrong"]["message"])
        self.assertGreater(lines["a"]["numbers"]["K"], 1)
        self.assertEqual(lines["b"]["files"], ["log.txt", "map.obj", "page.html", "record.json", "thumbnail.bmp"])
        self.assertEqual(sorted(os.listdir(f"{out}/none")), ["job.json", "log.txt"])
        with open(f"{out}/a/thumbnail.bmp", "rb") as file:
            self.assertEqual(file.read(2), b"BM")
        with open(f"{out}/index.html") as file:
            page = file.read()
        self.assertIn("4 of 4 jobs finished, 2 failed", page)
        self.assertIn('src="a/thumbnail.bmp"', page)

        before = os.stat(f"{out}/a/map.obj").st_mtime_ns, os.stat(f"{out}/none/job.json").st_mtime_ns
        write_obj(self.path("none.obj"), *disk(6))
        self.run_command("batch", jobs, "-o", out, code=8)  # nothing is done again
        self.assertEqual((os.stat(f"{out}/a/map.obj").st_mtime_ns, os.stat(f"{out}/none/job.json").st_mtime_ns), before)
        self.run_command("batch", jobs, "-o", out, "--retry", code=8)
        self.assertEqual(self.lines()["none"]["status"], "done")
        self.assertEqual(os.stat(f"{out}/a/map.obj").st_mtime_ns, before[0])

        self.jobs([self.map_job("a", 9)])  # the same command, and the same name of a file: it stays
        self.run_command("batch", jobs, "-o", out)
        self.jobs([self.map_job("a", 8, "--max-iterations", "3")])  # another command
        self.run_command("batch", jobs, "-o", out)
        self.assertNotEqual(os.stat(f"{out}/a/map.obj").st_mtime_ns, before[0])

    def test_outputs_are_those_of_the_command_by_itself(self):
        job = self.map_job("a")
        self.run_command("batch", self.jobs([job]), "-o", self.path("out"))
        self.run_command(*job["args"][:3], self.path("own.obj"), *job["args"][4:])
        with open(self.path("own.obj"), "rb") as own, open(self.path("out/a/map.obj"), "rb") as other:
            self.assertEqual(own.read(), other.read())

    def test_a_kill_in_the_middle_leaves_nothing_half_done(self):
        jobs = self.jobs([self.map_job(f"job-{i}", 14) for i in range(6)])
        out = self.path("out")
        batch = subprocess.Popen([BELTRAMI, "batch", jobs, "-o", out, "--jobs", "1", "--quiet"])
        while len(self.lines() if os.path.exists(f"{out}/results.jsonl") else {}) < 2:
            self.assertIsNone(batch.poll())
            time.sleep(0.005)
        batch.send_signal(signal.SIGKILL)
        batch.wait()
        finished = {name: os.stat(f"{out}/{name}/map.obj").st_mtime_ns for name in os.listdir(out) if name.startswith("job-")}
        self.assertGreaterEqual(len(finished), 2)
        self.assertLess(len(finished), 6)
        self.run_command("batch", jobs, "-o", out)
        self.assertEqual(sorted(os.listdir(out)), [".lock", "index.html", *[f"job-{i}" for i in range(6)], "results.jsonl"])
        self.assertTrue(all(line["status"] == "done" for line in self.lines().values()))
        for name, time_written in finished.items():
            self.assertEqual(os.stat(f"{out}/{name}/map.obj").st_mtime_ns, time_written)

    def test_a_job_that_is_killed_is_tried_once_more(self):
        out, pipe = self.path("out"), self.path("pipe.obj")
        os.mkfifo(pipe)  # a job that waits for its source
        jobs = self.jobs([{"id": "a", "args": ["map", pipe, "-o", "map.obj", "--boundary", "disk"]}])
        batch = subprocess.Popen([BELTRAMI, "batch", jobs, "-o", out, "--quiet"])

        def child():
            while True:
                with open(f"/proc/{batch.pid}/task/{batch.pid}/children") as file:
                    children = file.read().split()
                if children:
                    return int(children[0])
                time.sleep(0.01)

        first = child()
        os.kill(first, signal.SIGKILL)
        while child() == first:
            time.sleep(0.01)
        write_obj(self.path("source.obj"), *disk(5))
        with open(pipe, "wb") as file, open(self.path("source.obj"), "rb") as source:
            file.write(source.read())
        self.assertEqual(batch.wait(60), 0)
        self.assertEqual(self.lines()["a"]["status"], "done")

    def test_bad_files_of_jobs_are_refused(self):
        good = self.map_job("a")
        for text, words in (
            ('{"id": "a", "args": ["map"]}\n{"id": "a", "args": ["info"]}\n', "line 2: the id a has been used"),
            ('{"id": "../a", "args": ["map"]}', "no name of a folder"),
            ('{"id": "a", "args": []}', "do not begin with a subcommand"),
            ('{"id": "a", "args": ["batch"]}', "do not begin with a subcommand"),
            ('{"id": "a"}', "lacks an id or args"),
            ("nonsense", "line 1 is no JSON object"),
            ("", "has no jobs"),
        ):
            with open(self.path("jobs.jsonl"), "w") as file:
                file.write(text)
            code = 2 if "folder" in words or "begin" in words or "used" in words else 3
            self.assertIn(words, self.run_command("batch", self.path("jobs.jsonl"), "-o", self.path("out"), code=code).stderr)
        self.assertFalse(os.path.exists(self.path("out")))
        self.assertTrue(good)

    def test_one_batch_at_a_time(self):
        os.mkfifo(self.path("pipe.obj"))
        jobs = self.jobs([{"id": "a", "args": ["info", self.path("pipe.obj")]}])
        first = subprocess.Popen([BELTRAMI, "batch", jobs, "-o", self.path("out"), "--quiet"])
        while not os.path.exists(self.path("out/.a.tmp")):
            time.sleep(0.01)
        self.assertIn("another batch is at work", self.run_command("batch", jobs, "-o", self.path("out"), code=7).stderr)
        first.kill()
        first.wait()


if __name__ == "__main__":
    unittest.main()

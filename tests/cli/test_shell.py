"""The manual page and the completions that the command writes of itself."""

import os
import pty
import re
import select
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

from support import BELTRAMI


def written(what):
    return subprocess.run([BELTRAMI, "--write", what], capture_output=True, text=True, check=True).stdout


def commands():
    text = subprocess.run([BELTRAMI, "--help"], capture_output=True, text=True, check=True).stdout
    return re.findall(r"^  ([a-z]+) {2,}", text[text.index("Subcommands:"):], flags=re.M)


def completed(*words):
    """What bash offers for the last word."""
    script = written("bash") + '\nCOMP_WORDS=("$@")\nCOMP_CWORD=$(($# - 1))\n_beltrami 2>/dev/null\nprintf "%s\\n" "${COMPREPLY[@]}"\n'
    done = subprocess.run(["bash", "-c", script, "bash", *words], capture_output=True, text=True, check=True)
    return done.stdout.split()


class Terminal:
    """A shell at a terminal, with the completion that the command writes for it."""

    SETUP = {"bash": "bind 'set bell-style none'; source {file}", "zsh": "fpath=({folder} $fpath); autoload -U compinit; compinit -u -D"}
    CALL = {"bash": ["bash", "--norc", "--noprofile", "-i"], "zsh": ["zsh", "-f", "-i"]}

    def __init__(self, shell):
        self.folder = tempfile.TemporaryDirectory()
        file = os.path.join(self.folder.name, "_beltrami")
        with open(file, "w") as stream:
            stream.write(written(shell))
        self.pid, self.fd = pty.fork()
        if self.pid == 0:
            os.chdir(self.folder.name)
            os.environ.update(TERM="dumb", PS1="> ", COLUMNS="200", LINES="60", INPUTRC="/dev/null")
            os.execvp(self.CALL[shell][0], self.CALL[shell])
        setup = self.SETUP[shell].format(file=file, folder=self.folder.name)
        self.send(f"{setup}; echo READY$((1+1))\n")
        self.read("READY2")

    def send(self, text):
        os.write(self.fd, text.encode())

    def read(self, wanted, seconds=30):
        """What the terminal shows until it has what is wanted."""
        shown, end = "", time.monotonic() + seconds
        while not re.search(wanted, shown) and time.monotonic() < end:
            if select.select([self.fd], [], [], 0.2)[0]:
                shown += os.read(self.fd, 65536).decode(errors="replace")
        return shown

    def typed(self, line, wanted):
        """The same after a line and two tabulators."""
        self.send(line + "\t\t")
        shown = self.read(wanted)
        self.send("\x15")  # the line is dropped
        time.sleep(0.1)
        return shown

    def close(self):
        os.kill(self.pid, signal.SIGKILL)
        os.waitpid(self.pid, 0)
        os.close(self.fd)
        self.folder.cleanup()


class Manual(unittest.TestCase):
    def test_every_option_is_in_it(self):
        page = written("manual").replace("\\-", "-")
        self.assertGreaterEqual(len(commands()), 11)
        for command in commands():
            section = page[page.index(f".SS beltrami {command}\n"):].split("\n.SS", 1)[0]
            text = subprocess.run([BELTRAMI, command, "--help"], capture_output=True, text=True, check=True).stdout
            for option in re.findall(r"^ +(?:-\w,)?(--[\w-]+)", text, flags=re.M):
                with self.subTest(command=command, option=option):
                    self.assertIn(option, section)
        for section in (".SH NAME", ".SH SYNOPSIS", ".SH COMMANDS", ".SH EXIT STATUS", ".SH EXAMPLES"):
            self.assertIn(f"\n{section}\n", page)

    @unittest.skipUnless(shutil.which("groff"), "groff is not there")
    def test_groff_has_nothing_to_say(self):
        done = subprocess.run(["groff", "-man", "-Kutf8", "-Tutf8", "-ww", "-z"], input=written("manual"), capture_output=True,
                              text=True, check=True)  # fmt: skip
        self.assertEqual("", "\n".join(line for line in done.stderr.splitlines() if "adjust" not in line and "break" not in line))


class Completion(unittest.TestCase):
    def test_subcommands(self):
        self.assertEqual(["measure", "map"], completed("beltrami", "m"))
        self.assertLessEqual(set(commands()), set(completed("beltrami", "")))

    def test_options_are_those_of_the_subcommand(self):
        self.assertEqual(["--method"], completed("beltrami", "map", "face.obj", "--met")[:1])
        self.assertNotIn("--method", completed("beltrami", "info", "--"))

    def test_values(self):
        self.assertEqual(["harmonic"], completed("beltrami", "map", "face.obj", "--method", "h"))
        self.assertEqual(["harmonic"], completed("beltrami", "map", "face.obj", "--method", "=", "h"))
        self.assertIn("harmonic", completed("beltrami", "map", "face.obj", "--method", "="))

    @unittest.skipUnless(shutil.which("zsh"), "zsh is not there")
    def test_zsh_reads_its_script(self):
        subprocess.run(["zsh", "-n"], input=written("zsh"), text=True, check=True)


class AtATerminal(unittest.TestCase):
    def check(self, shell):
        if not shutil.which(shell):
            self.skipTest(f"{shell} is not there")
        terminal = Terminal(shell)
        self.addCleanup(terminal.close)
        for line, wanted in (("beltrami reg", "ister"), ("beltrami map face.obj --bound", "ary"), ("beltrami map face.obj --method har", "monic"),
                             ("beltrami distance --pic", "ture"), ("beltrami info _belt", "rami")):  # fmt: skip
            with self.subTest(shell=shell, line=line):
                self.assertRegex(terminal.typed(line, wanted), wanted)

    def test_bash(self):
        self.check("bash")

    def test_zsh(self):
        self.check("zsh")


if __name__ == "__main__":
    unittest.main()

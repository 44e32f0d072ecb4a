"""The manual page and the completions that the command writes of itself."""

import re
import shutil
import subprocess
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

    @unittest.skipUnless(shutil.which("zsh"), "zsh is not there")
    def test_zsh_reads_its_script(self):
        subprocess.run(["zsh", "-n"], input=written("zsh"), text=True, check=True)


if __name__ == "__main__":
    unittest.main()

#!/usr/bin/env python3
"""Opens a report page in headless Chromium and fails unless it draws itself without an error.

    check_page.py PAGE.html [CHROMIUM]

The page is opened at #selftest, where it draws every map with every overlay. Exit code 0: drawn, 1: not drawn or an
error, 77: no Chromium on this machine (skipped).
"""

import html.parser
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

BROWSERS = ["chromium", "chromium-browser", "google-chrome", "chrome"]
FLAGS = [
    "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-dev-shm-usage",
    "--disable-background-networking", "--disable-component-update", "--disable-sync", "--window-size=1280,2000",
]  # fmt: skip
SKIPPED = 77


class RootData(html.parser.HTMLParser):
    """The attributes of the html element."""

    def __init__(self):
        super().__init__()
        self.attributes = {}

    def handle_starttag(self, tag, attrs):
        if tag == "html":
            self.attributes = dict(attrs)


def find_browser(wanted):
    if wanted:
        return shutil.which(wanted)
    return next(filter(None, map(shutil.which, BROWSERS)), None)


def dump(browser, page):
    """The page's document after its scripts have run."""
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        command = [browser, *FLAGS, f"--user-data-dir={profile}", "--dump-dom", page.resolve().as_uri() + "#selftest"]
        done = subprocess.run(command, capture_output=True, timeout=120, check=False,
                              env={**os.environ, "HOME": profile})  # fmt: skip
    return done.stdout.decode("utf-8", "replace"), done.stderr.decode("utf-8", "replace")


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    page = pathlib.Path(sys.argv[1])
    if not page.is_file():
        sys.exit(f"{page}: no such file")
    browser = find_browser(sys.argv[2] if len(sys.argv) == 3 else "")
    if not browser:
        print("skipped: no Chromium found")
        return SKIPPED
    try:
        text, messages = dump(browser, page)
    except subprocess.TimeoutExpired:
        print(f"{page}: not drawn after 120 s")
        return 1
    root = RootData()
    root.feed(text[:10000])
    data = root.attributes
    if data.get("data-ready") == "ok" and data.get("data-errors") == "0":
        print(f"{page}: drawn, one figure in {data.get('data-milliseconds')} ms")
        return 0
    print(f"{page}: ready={data.get('data-ready')} errors={data.get('data-errors')} {data.get('data-message', '')}")
    if not text:
        print(messages[-2000:])
    return 1


if __name__ == "__main__":
    sys.exit(main())

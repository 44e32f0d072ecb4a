#!/usr/bin/env python3
"""Builds the documentation as a static site: site.py BUILD_FOLDER SITE_FOLDER. BUILD_FOLDER has the public headers
(installed/beltrami) and, if it was built, the Python module (python/beltrami).

Pages are docs/, README.md's neighbours and the examples; the references are made by Doxygen and Breathe from the contracts in
the headers, and by autodoc from the module's docstrings. Then every link between pages is followed."""

import html.parser
import os
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
BESIDE = {"CONTRIBUTING.md": "contributing", "CHANGELOG.md": "changes"}  # pages that lie outside docs/


def copy_pages(source):
    """docs/ and what its pages name outside of it, which become pages or files of the site."""
    shutil.copytree(ROOT / "docs", source, ignore=shutil.ignore_patterns("*.py"))
    shutil.copy(ROOT / "docs" / "conf.py", source)
    for name, page in BESIDE.items():
        text = (ROOT / name).read_text()
        (source / f"{page}.md").write_text(re.sub(r"\]\(docs/", "](", text))
    (source / "examples").mkdir()
    for example in sorted([*(ROOT / "examples").glob("*.cpp"), *(ROOT / "examples").glob("python/*.py")]):
        language = "cpp" if example.suffix == ".cpp" else "python"
        (source / "examples" / f"{example.stem}.md").write_text(f"# {example.name}\n\n```{language}\n{example.read_text()}```\n")
    for page in source.rglob("*.md"):
        page.write_text(re.sub(r"\]\(((?:\.\./)+)([^)#\s]+)(#[^)]*)?\)", lambda m: moved(page, source, m), page.read_text()))


def moved(page, source, match):
    """A link that leaves docs/."""
    target = (page.parent / match[1] / match[2]).resolve()
    up = os.path.relpath(source, page.parent)
    if target.is_relative_to(source) and target.exists():
        return match[0]
    name = match[2]
    if name in BESIDE:
        return f"]({up}/{BESIDE[name]}.md{match[3] or ''})"
    if name.startswith("examples/") and name.endswith((".cpp", ".py")):
        return f"]({up}/examples/{pathlib.Path(name).stem}.md)"
    if name in ("examples/python", "examples"):
        return f"]({up}/tutorials.md)"
    return file_beside(source, up, name)


def file_beside(source, up, name):
    """A file or folder of the project that is no page: its text is one."""
    path = ROOT / name
    page = source / "files" / (name.replace("/", "_") + ".md")
    page.parent.mkdir(exist_ok=True)
    text = "\n".join(sorted(p.name for p in path.iterdir())) if path.is_dir() else path.read_text()
    page.write_text(f"---\norphan: true\n---\n# {name}\n\n`````text\n{text}\n`````\n")
    return f"]({up}/files/{page.name})"


def write_reference(source, build):
    """One page a room of the library; one of the Python module."""
    headers = [header for header in sorted((build / "installed" / "beltrami").glob("*.h")) if header.stem not in ("beltrami", "version")]
    (source / "reference").mkdir()
    for header in headers:
        (source / "reference" / f"{header.stem}.rst").write_text(
            f"{header.stem}\n{'=' * len(header.stem)}\n\n``#include <beltrami/{header.name}>``\n\n.. doxygenfile:: {header.name}\n")
    listed = "\n".join(f"reference/{header.stem}" for header in headers)
    (source / "reference.md").write_text("# The library in C++\n\nBy rooms ([contributing](contributing.md) says what each is about).\n\n"
                                         f"```{{toctree}}\n:maxdepth: 1\n{listed}\n```\n")
    if (build / "python" / "beltrami").is_dir():
        (source / "reference-python.rst").write_text(
            "The module of Python\n====================\n\n.. automodule:: beltrami\n   :members:\n   :imported-members:\n   :undoc-members:\n")
        return ["reference", "reference-python"]
    return ["reference"]


def write_index(source, references):
    examples = "\n".join(sorted(f"examples/{page.stem}" for page in (source / "examples").glob("*.md")))
    (source / "tutorials.md").write_text("# Small programs\n\nEach is run by the tests.\n\n"
                                         f"```{{toctree}}\n:maxdepth: 1\n{examples}\n```\n")
    guide = sorted(page.stem for page in source.glob("*.md") if page.stem not in {"index", "tutorials", *references, *BESIDE.values()})
    first = ["methods", "command", "page", "python", "extremal-maps", "sliding", "mixed"]
    guide = [p for p in first if p in guide] + [p for p in guide if p not in first and not p.startswith("gallery")]
    trees = {"Guide": guide, "Galleries": sorted(p.stem for p in source.glob("gallery*.md")), "Programs": ["tutorials"],
             "Reference": references, "Notes": sorted(f"notes/{p.stem}" for p in (source / "notes").glob("*.md")),
             "Project": sorted(BESIDE.values())}
    with (source / "index.md").open("a") as index:
        for caption, pages in trees.items():
            index.write(f"\n```{{toctree}}\n:hidden:\n:caption: {caption}\n" + "\n".join(pages) + "\n```\n")


def run_doxygen(build, work):
    settings = {"INPUT": build / "installed" / "beltrami", "RECURSIVE": "YES", "GENERATE_HTML": "NO", "GENERATE_LATEX": "NO",
                "GENERATE_XML": "YES", "OUTPUT_DIRECTORY": work, "MACRO_EXPANSION": "YES", "EXPAND_ONLY_PREDEF": "YES",
                "PREDEFINED": "BELTRAMI_PUBLIC=", "QUIET": "YES", "WARNINGS": "NO", "WARN_IF_UNDOCUMENTED": "NO", "WARN_IF_DOC_ERROR": "NO", "WARN_IF_INCOMPLETE_DOC": "NO",
                "AUTOLINK_SUPPORT": "NO", "JAVADOC_AUTOBRIEF": "NO", "XML_PROGRAMLISTING": "NO"}
    text = "\n".join(f"{name} = {value}" for name, value in settings.items())
    subprocess.run(["doxygen", "-"], input=text.encode(), check=True)


def bring_styles(site):
    """Debian's furo takes one style sheet from the web server's own folder; here it lies beside the others."""
    for sheet in (site / "_static" / "styles").glob("*.css"):
        sheet.write_text(sheet.read_text().replace("/javascript/normalize.css/", ""))
    shutil.copy("/usr/share/javascript/normalize.css/normalize.css", site / "_static" / "styles")
    follow_the_readers_scheme(site / "_static" / "styles" / "furo.css")


def follow_the_readers_scheme(sheet):
    """Debian's compiler of furo's style sheet loses the colours of the dark where nobody has chosen them by hand."""
    text = sheet.read_text()
    if "prefers-color-scheme" in text:
        return
    (colours,) = re.findall(r'body\[data-theme="dark"\] (\{\s*--color-[^}]*\})', text)
    sheet.write_text(f'{text}\n@media not print {{ @media (prefers-color-scheme: dark) {{\n  body:not([data-theme="light"]) {colours}\n}} }}\n')


class Page(html.parser.HTMLParser):
    def __init__(self, path):
        super().__init__()
        self.links, self.anchors = [], set()
        self.feed(path.read_text())

    def handle_starttag(self, tag, attrs):
        attrs = dict(attrs)
        self.anchors |= {attrs.get("id"), attrs.get("name")}
        for name in ("href", "src"):
            if attrs.get(name):
                self.links.append(attrs[name])


def broken_links(site):
    pages = {path: Page(path) for path in site.rglob("*.html")}
    for path, page in pages.items():
        for link in page.links:
            if re.match(r"[a-z]+:", link):
                continue
            place, _, anchor = link.partition("#")
            target = (path.parent / place.partition("?")[0]).resolve() if place else path
            if not target.exists() or (anchor and target in pages and anchor not in pages[target].anchors):
                yield f"{path.relative_to(site)}: {link}"
    for sheet in site.rglob("*.css"):
        for link in re.findall(r"url\(['\"]?([^)'\"#?]+)|@import ['\"]([^'\"]+)", sheet.read_text()):
            place = link[0] or link[1]
            if not place.startswith("data:") and not (sheet.parent / place).exists():
                yield f"{sheet.relative_to(site)}: {place}"


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    build, site = (pathlib.Path(argument).resolve() for argument in sys.argv[1:])
    work = build / "site"
    shutil.rmtree(work, ignore_errors=True)
    shutil.rmtree(site, ignore_errors=True)
    work.mkdir()
    source = work / "source"
    copy_pages(source)
    write_index(source, write_reference(source, build))
    run_doxygen(build, work)
    environment = {**os.environ, "BELTRAMI_DOXYGEN": str(work / "xml"), "PYTHONPATH": str(build / "python"), "BELTRAMI_VERSION_FILE": str(ROOT / "CMakeLists.txt")}
    subprocess.run([sys.executable, "-m", "sphinx", "-q", "-j", "2", "-b", "html", str(source), str(site)], env=environment, check=True)
    bring_styles(site)
    broken = sorted(set(broken_links(site)))
    print("\n".join(broken))
    count = len(list(site.rglob("*.html")))
    print(f"{count} pages in {site}, {len(broken)} broken links")
    sys.exit(bool(broken))


if __name__ == "__main__":
    main()

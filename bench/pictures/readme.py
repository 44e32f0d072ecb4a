"""A Markdown page as GitHub shows it, for a screenshot: readme.py README.md OUT.html. Its picture and links stay where they
are: the page names its folder as the base."""

import pathlib
import sys

from markdown_it import MarkdownIt

# Sizes and colours are those of GitHub's own style for Markdown (github-markdown-css), in the light.
STYLE = """
body { margin: 0; background: #fff }
main { box-sizing: border-box; width: 1012px; margin: 0 auto; padding: 32px; border: 1px solid #d1d9e0; border-radius: 6px;
       color: #1f2328; font: 16px/1.5 -apple-system, "Segoe UI", "Noto Sans", Helvetica, Arial, sans-serif }
h1, h2 { margin: 24px 0 16px; padding-bottom: .3em; border-bottom: 1px solid #d1d9e0b3; line-height: 1.25 }
h1 { margin-top: 0; font-size: 2em } h2 { font-size: 1.5em }
p, pre { margin: 0 0 16px } img { max-width: 100% } a { color: #0969da; text-decoration: none }
code { padding: .2em .4em; border-radius: 6px; background: #818b981f; font: 85% ui-monospace, "DejaVu Sans Mono", monospace }
pre { padding: 16px; overflow: auto; border-radius: 6px; background: #f6f8fa; line-height: 1.45 }
pre code { padding: 0; background: none }
table { border-collapse: collapse } td, th { padding: 6px 13px; border: 1px solid #d1d9e0 }
"""

source, target = map(pathlib.Path, sys.argv[1:])
body = MarkdownIt("commonmark").enable("table").render(source.read_text())
target.write_text(f"<!doctype html><meta charset=utf-8><base href='{source.resolve().parent.as_uri()}/'>"
                  f"<style>{STYLE}</style><main>{body}</main>")

#!/usr/bin/env python3
"""Links of the project's Markdown: check_links.py [ROOT]. A relative link must lead to a file that is there and, with
#anchor, to a heading of it; a path in `code` that begins with a folder of the repository must exist. Links to other
sites are not followed."""
import os
import re
import sys
import urllib.parse

FENCE = re.compile(r"^```.*?^```\n?", re.M | re.S)
LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")
CODE = re.compile(r"`([^`\n]+)`")
FOLDERS = ("apps/", "docs/", "include/", "models/", "src/", "tests/", ".ci/")


def pages(root):
    for folder, folders, files in os.walk(root):
        folders[:] = [f for f in folders if f not in ("build", "node_modules", "findings") and not f.startswith(".git")]
        yield from (os.path.join(folder, f) for f in files if f.endswith(".md"))


def anchors(path, cache={}):
    """The anchors of a page's headings, made as GitHub makes them."""
    if path not in cache:
        found = {}
        with open(path, encoding="utf-8") as file:
            text = FENCE.sub("", file.read())
        for heading in re.findall(r"^#+ +(.*?) *$", text, re.M):
            heading = LINK.sub(lambda m: m.group(0)[1 : m.group(0).index("]")], heading)
            slug = re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")
            count = found.get(slug, 0)
            found[slug] = count + 1
            if count:
                found["%s-%d" % (slug, count)] = 1
        cache[path] = set(found)
    return cache[path]


def problems(root, page):
    with open(page, encoding="utf-8") as file:
        text = FENCE.sub("", file.read())
    for link in LINK.findall(CODE.sub("", text)):
        if re.match(r"[a-z]+:", link):
            continue
        path, _, anchor = urllib.parse.unquote(link).partition("#")
        target = os.path.normpath(os.path.join(os.path.dirname(page), path)) if path else page
        if not os.path.exists(target):
            yield "link to %s, which is not there" % link
        elif anchor and target.endswith(".md") and anchor not in anchors(target):
            yield "link to %s, which has no such heading" % link
    for path in CODE.findall(text):
        if path.startswith(FOLDERS) and re.fullmatch(r"[\w./-]+", path) and not os.path.exists(os.path.join(root, path)):
            yield "names `%s`, which is not there" % path


def main():
    here = os.path.dirname(os.path.abspath(__file__))
    root = os.path.abspath(sys.argv[1] if len(sys.argv) > 1 else os.path.join(here, "..", ".."))
    all_pages = sorted(pages(root))
    found = [(os.path.relpath(page, root), what) for page in all_pages for what in problems(root, page)]
    for page, what in found:
        print("%s: %s" % (page, what))
    print("%d pages, %d problems" % (len(all_pages), len(found)))
    sys.exit(1 if found or not all_pages else 0)


main()

"""Pages of the tree as Doxygen reads them: every heading gets an anchor, links between pages lead to those, and pictures and other
files that a page links to are copied beside the HTML.
Usage: doxygen_pages.py <source folder> <folder for pages> <folder of the HTML>"""
import os
import re
import shutil
import sys

root, pages_folder, html = sys.argv[1:]


def anchor(page, heading):
    """Of a heading of a page, given as links give it; of the page itself without one."""
    name = re.sub(r"[^a-z0-9]+", "_", page.removesuffix(".md").lower())
    return "page_" + name + ("_" + re.sub(r"[^a-z0-9_]+", "_", heading) if heading else "")


def github_anchor(heading):
    return re.sub(r"[^\w\- ]", "", heading.replace("`", "").lower()).replace(" ", "-")


def target(page, link):
    """Where a relative link of a page leads in the HTML."""
    path, _, heading = link.partition("#")
    path = os.path.normpath(os.path.join(os.path.dirname(page), path)) if path else page
    if path in pages:
        return "#" + anchor(path, heading)
    if os.path.isdir(os.path.join(root, path)):  # docs/decisions
        return "pages.html"
    copy = os.path.join(html, "files", path)
    os.makedirs(os.path.dirname(copy), exist_ok=True)
    shutil.copyfile(os.path.join(root, path), copy)
    return os.path.join("files", path)


def rewritten(page, text):
    lines, code, first = [], False, True
    for line in text.splitlines():
        if line.startswith("```"):
            code = not code
            if line == "```":  # without a language Doxygen would take it for C++
                line = "```{.unparsed}" if code else line
        elif not code:
            heading = re.match(r"(#+) (.*)", line)
            if heading:
                line = f"{line} {{#{anchor(page, '' if first else github_anchor(heading[2]))}}}"
                first = False
            elif not line.startswith("    "):
                line = re.sub(r"\]\((?![a-z]+:)([^)\s]+)\)", lambda m: f"]({target(page, m[1])})", line)
                line = re.sub(r'<img src="([^"]+)"', lambda m: f'<img src="{target(page, m[1])}"', line)
        lines.append(line)
    return "\n".join(lines) + "\n"


pages = {}
for folder, inner, names in os.walk(os.path.join(root, "docs")):
    inner.sort()
    for name in sorted(names):
        if name.endswith(".md"):
            pages[os.path.relpath(os.path.join(folder, name), root)] = None
for name in sorted(os.listdir(root)):
    if name.endswith(".md"):
        pages[name] = None
shutil.rmtree(pages_folder, ignore_errors=True)
shutil.rmtree(html, ignore_errors=True)
for page in pages:
    with open(os.path.join(root, page), encoding="utf-8") as file:
        text = rewritten(page, file.read())
    os.makedirs(os.path.dirname(os.path.join(pages_folder, page)), exist_ok=True)
    with open(os.path.join(pages_folder, page), "w", encoding="utf-8") as file:
        file.write(text)

#!/usr/bin/env python3
"""Says what the documents promise and do not keep:
  * a key of the literature, as [Sch06] or [Sch06, 5.3], that docs/references.md does not have, has twice, or has in vain
  * a relative link or picture of a page that leads nowhere, or to a heading that is not there
  * a section or equation of a page of docs/ that is not there
  * a case of cases/ without a row in README's table, or a table that a blank line breaks
  * two pages of docs/changes or docs/decisions with one number
  * a number under "then" in docs/reproduce.md that is not the one of tests/reference
Usage: check_docs.py <source folder>"""
import os
import re
import sys

KEY = re.compile(r"\[([A-Z][A-Za-z]*[0-9]{2})(?:, [^\]]*)?\](?!\()")
# A capitalised word with a comma after it is meant as a key too: [CASES, 11].
NO_KEY = re.compile(r"\[([A-Z][A-Za-z]+)(?:, [^\]]*)\](?!\()")
SECTION = re.compile(r"([a-z]+)\.md(?:\]\([^)]*\))?,? sections? ([0-9]+(?:\.[0-9]+)?)(?: and ([0-9]+(?:\.[0-9]+)?))?")
EQUATION = re.compile(r"([a-z]+)\.md(?:\]\([^)]*\))?,? (?:eq\.|eqs\.|equation|equations) \(?([0-9]+[a-z]?)\)?")
COMMENT = {".hpp": "//", ".h": "//", ".cpp": "//", ".inc": "//", ".toml": "#", ".cmake": "#", ".py": "#", ".sh": "#"}


def files(root, folders):
    for folder in folders:
        for path, inner, names in os.walk(os.path.join(root, folder)):
            inner.sort()
            for name in sorted(names):
                yield os.path.join(path, name)


def comments(text, mark):
    """Comments of a source, each with the number of its first line; lines that follow each other are one."""
    block, begin = [], 0
    for number, line in enumerate(text.splitlines(), 1):
        at = line.find(mark)
        if at >= 0:
            if not block:
                begin = number
            block.append(line[at:].lstrip("/#! <"))
        if block and (at < 0 or not line.strip().startswith(mark)):
            yield begin, " ".join(block)
            block = []
    if block:
        yield begin, " ".join(block)


def paragraphs(text):
    """Paragraphs of a page without its code, each with the number of its first line."""
    block, begin, code = [], 0, False
    for number, line in enumerate(text.splitlines() + [""], 1):
        if line.startswith("```"):
            code = not code
        elif line.strip() and not code:
            if not block:
                begin = number
            block.append(line)
            continue
        if block:
            yield begin, " ".join(block)
            block = []


def headings(text):
    return [line.lstrip("#").strip() for line in text.splitlines() if re.match(r"#+ ", line)]


def anchor(heading):
    return re.sub(r"[^\w\- ]", "", heading.replace("`", "").lower()).replace(" ", "-")


def digit(text):
    """One unit of the last digit of a number."""
    mantissa, _, exponent = text.partition("e")
    return 10.0 ** (int(exponent or 0) - len(mantissa.partition(".")[2]))


def quoted_tables(page):
    """Tables of docs/reproduce.md that quote published numbers: (number, [(name of a row, numbers under "then")])."""
    for number, block in re.findall(r"^\*\*Table ([0-9.]+),.*?^```\n(.*?)^```", page, re.M | re.S):
        lines = block.splitlines()
        kinds = [cells.split() for cells in lines[1].split("|")[1:]]
        rows = []
        for line in lines[2:]:
            name, *cells = line.split("|")
            then = [cell.split()[0] for cell, kind in zip(cells, kinds) if kind[:1] == ["then"] and cell.split()]
            rows.append((name.split()[-1], then))
        yield number, rows


def misquoted(root, page):
    """Numbers of docs/reproduce.md that are not those of tests/reference, in the order of its columns."""
    for number, rows in quoted_tables(page):
        with open(os.path.join(root, f"tests/reference/schroeder-table-{number}.csv"), encoding="utf-8") as table:
            printed = [line.strip().split(",") for line in table][1:]
        unit = 1e4 if number == "3.5" else 1  # hundredths of a second as microseconds
        for name, then in rows:
            same = [cells for cells in printed if cells[0] == name or
                    (re.match(r"[0-9]", name) and re.match(r"[0-9]", cells[0]) and float(cells[0]) == float(name))]
            if len(same) != 1:
                yield f"Table {number} has no row {name}"
                continue
            left = same[0][1:]
            for shown in then:
                while left and not (shown == left[0] if "-" in (shown, left[0]) else
                                    abs(float(shown) - unit * float(left[0])) <= 0.5001 * digit(shown)):
                    left.pop(0)
                if not left:
                    yield f"Table {number}, {name}: {shown} is not printed there"
                    break
                left.pop(0)


def check(root):
    faults = []
    pages = {}
    for path in list(files(root, ["docs"])) + [os.path.join(root, "README.md")]:
        if path.endswith(".md"):
            with open(path, encoding="utf-8") as page:
                pages[os.path.relpath(path, root)] = page.read()

    # The literature.
    defined, used = {}, set()
    for number, line in enumerate(pages["docs/references.md"].splitlines(), 1):
        entry = re.match(r"\| \[(\w+)\] \|", line)
        if entry:
            if entry[1] in defined:
                faults.append(f"docs/references.md:{number}: [{entry[1]}] is there already, in line {defined[entry[1]]}")
            defined[entry[1]] = number

    def read(place, text):
        for key in KEY.findall(text):
            used.add(key)
            if key not in defined:
                faults.append(f"{place}: [{key}] is not in docs/references.md")
        for word in NO_KEY.findall(text):
            faults.append(f"{place}: [{word}, ...] reads like a key of the literature, and docs/references.md has none")
        for pattern, name, where in ((SECTION, "section", sections), (EQUATION, "equation", equations)):
            for match in pattern.findall(text):
                page = f"docs/{match[0]}.md"
                if page not in pages:
                    faults.append(f"{place}: there is no {page}")
                    continue
                for number in filter(None, match[1:]):
                    if number not in where[page]:
                        faults.append(f"{place}: {page} has no {name} {number}")

    sections, equations = {}, {}
    for page, text in pages.items():
        sections[page] = {m[1] for m in (re.match(r"([0-9]+(?:\.[0-9]+)?)\.? ", h) for h in headings(text)) if m}
        found = re.findall(r"^    \(([0-9]+[a-z]?)\)  ", text, re.M)
        equations[page] = set(found)
        for number in sorted(set(found)):
            if found.count(number) > 1:
                faults.append(f"{page}: equation {number} is there {found.count(number)} times")

    for page, text in pages.items():
        for number, block in paragraphs(text):
            if not (page == "docs/references.md" and block.startswith("| key")):
                read(f"{page}:{number}", block)
            if sections[page]:  # of this page, when no other is named
                for wanted in re.findall(r"(?<!\.md, )(?<!\.md\), )\bsection ([0-9]+(?:\.[0-9]+)?)", block):
                    if wanted not in sections[page]:
                        faults.append(f"{page}:{number}: this page has no section {wanted}")
    described = pages["docs/references.md"]
    for key in KEY.findall(re.sub(r"^\| \[\w+\] \|", "", described, flags=re.M)):
        if key not in defined:
            faults.append(f"docs/references.md: [{key}] is not in docs/references.md")
    for path in files(root, ["src", "include", "tests", "tools", "cases"]):
        place, end = os.path.relpath(path, root), os.path.splitext(path)[1]
        if end in COMMENT and place not in ("tools/check_docs.py", "tests/house/check_docs_test.py"):
            with open(path, encoding="utf-8") as source:
                for number, comment in comments(source.read(), COMMENT[end]):
                    read(f"{place}:{number}", comment)
    for key in sorted(defined.keys() - used):
        faults.append(f"docs/references.md:{defined[key]}: nobody refers to [{key}]")

    # Links.
    for page, text in pages.items():
        text = re.sub(r"^```.*?^```", "", text, flags=re.M | re.S)
        links = re.findall(r"\]\(([^)\s]+)\)", text) + re.findall(r'<img src="([^"]+)"', text)
        for link in links:
            if re.match(r"[a-z]+:", link):
                continue
            target, _, heading = link.partition("#")
            path = os.path.normpath(os.path.join(os.path.dirname(page), target)) if target else page
            if not os.path.exists(os.path.join(root, path)):
                faults.append(f"{page}: the link {link} leads nowhere")
            elif heading and path in pages and heading not in map(anchor, headings(pages[path])):
                faults.append(f"{page}: {path} has no heading #{heading}")

    # README's table of cases, one table without a gap.
    lines = pages["README.md"].splitlines()
    starts = [i for i, line in enumerate(lines) if line.startswith("| case |")]
    rows = []
    if not starts:
        faults.append("README.md: there is no table of cases")
    else:
        end = starts[0]
        while end < len(lines) and lines[end].startswith("|"):
            end += 1
        rows = re.findall(r"^\| \[\w+\]\(cases/(\w+)\.toml\) \|", "\n".join(lines[starts[0]:end]), re.M)
    for name in sorted(os.listdir(os.path.join(root, "cases"))):
        case, end = os.path.splitext(name)
        if end == ".toml" and rows.count(case) != 1:
            faults.append(f"README.md: the table of cases has {rows.count(case)} rows of cases/{name}, not one")

    faults += [f"docs/reproduce.md: {fault}" for fault in misquoted(root, pages["docs/reproduce.md"])]

    # Numbers of pages.
    for folder in ("docs/changes", "docs/decisions"):
        numbers = {}
        for name in sorted(os.listdir(os.path.join(root, folder))):
            if not re.fullmatch(r"[0-9]{4}-[a-z0-9-]+\.md", name):
                faults.append(f"{folder}/{name}: a page here is called NNNN-what-it-is.md")
            elif name[:4] in numbers:
                faults.append(f"{folder}/{name}: {numbers[name[:4]]} has this number")
            numbers[name[:4]] = name
    return faults, len(pages), len(defined)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    found, page_count, key_count = check(sys.argv[1])
    for fault in found:
        print(fault)
    if found:
        sys.exit(f"{len(found)} faults in the documents")
    print(f"{page_count} pages and {key_count} works: every key, link, section, equation, case and number is there once")

"""The pages of the target `docs`: every link leads somewhere, nothing is fetched from a network, and a public name without
documentation is an error.
Usage: api_reference_test.py <folder of the docs> <cmake/RunDoxygen.cmake> <cmake> <doxygen>"""
import os
import re
import shutil
import subprocess
import sys
from html.parser import HTMLParser

docs, run_doxygen, cmake, doxygen = sys.argv[1:]
docs = os.path.abspath(docs)
html = os.path.join(docs, "html")
anchors, links = {}, []


class Page(HTMLParser):
    def __init__(self, name):
        super().__init__()
        self.name = name
        anchors[name] = set()

    def handle_starttag(self, tag, attributes):
        for key, value in attributes:
            if key in ("id", "name"):
                anchors[self.name].add(value)
            if key in ("href", "src") and value:
                links.append((self.name, tag, value))


for name in sorted(os.listdir(html)):
    if name.endswith(".html"):
        with open(os.path.join(html, name), encoding="utf-8") as file:
            Page(name).feed(file.read())

faults = []
for page, tag, link in links:
    if re.match(r"[a-z]+:", link):
        if tag != "a" and not link.startswith("javascript:"):
            faults.append(f"{page} fetches {link}")
        continue
    target, _, anchor = link.partition("#")
    target = target or page
    if not os.path.exists(os.path.join(html, target)):
        faults.append(f"{page}: the link {link} leads nowhere")
    elif anchor and anchor not in anchors.get(target, ()):
        faults.append(f"{page}: {target} has no {anchor}")
wanted = ["index.html", "namespacefgtd.html", "classfgtd_1_1Plan.html", "classfarfield_1_1Plan.html", "classrbf_1_1Plan.html", "structgaussdrift_1_1Case.html",
          "page_docs_method.html", "page_docs_usage.html"]
faults += [f"there is no {name}" for name in wanted if name not in anchors]
if faults or len(links) < 1000:
    sys.exit("\n".join(faults + [f"{len(links)} links in {len(anchors)} pages"]))

# The same settings on a header with one name that is not documented.
scratch = os.path.join(docs, "undocumented")
shutil.rmtree(scratch, ignore_errors=True)
os.makedirs(os.path.join(scratch, "include"))
with open(os.path.join(docs, "Doxyfile"), encoding="utf-8") as file:
    settings = file.read()


def ends_with_success(member):
    with open(os.path.join(scratch, "include/a.hpp"), "w", encoding="utf-8") as file:
        file.write(f"/// @file\n/// A header.\n/// A namespace.\nnamespace a {{\n/// A class.\nstruct A {{\n{member}\n}};\n}}\n")
    with open(os.path.join(scratch, "Doxyfile"), "w", encoding="utf-8") as file:
        file.write(settings + f"INPUT = {scratch}/include\nOUTPUT_DIRECTORY = {scratch}\nWARN_LOGFILE = {scratch}/warnings.txt\n")
    result = subprocess.run([cmake, "-D", f"DOXYGEN={doxygen}", "-D", f"FOLDER={scratch}", "-P", run_doxygen], capture_output=True, text=True)
    return result.returncode == 0, result.stderr


good, said = ends_with_success("  int told;  ///< a number")
if not good:
    sys.exit("a header that is documented fails:\n" + said)
good, said = ends_with_success("  int untold;")
if good or "untold" not in said:
    sys.exit("a name that is not documented is not told:\n" + said)

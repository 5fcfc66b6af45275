"""Does every public name of a package have a docstring whose example runs?

  pages_test.py PACKAGE        with the folder of the packages on PYTHONPATH
"""
import doctest
import importlib
import inspect
import sys


def public_names(package):
    """Pairs of a dotted name and what it is: what the package exports, and the public functions of its classes."""
    for name in package.__all__:
        thing = getattr(package, name)
        if inspect.isclass(thing) or inspect.isfunction(thing):
            yield name, thing
        if inspect.isclass(thing):
            for inner, member in inspect.getmembers(thing):
                if not inner.startswith("_") and inspect.isfunction(member):
                    yield f"{name}.{inner}", member


package = importlib.import_module(sys.argv[1])
without, attempted, failed = [], 0, 0
finder, runner = doctest.DocTestFinder(recurse=False), doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE)
for name, thing in [("", package), *public_names(package)]:
    tests = finder.find(thing, f"{sys.argv[1]}.{name}", module=False, globs={})
    if not any(test.examples for test in tests):
        without.append(name)
    for test in tests:
        result = runner.run(test)
        attempted, failed = attempted + result.attempted, failed + result.failed
print(f"{sys.argv[1]}: {attempted} lines of examples, {failed} of them fail; "
      f"without an example: {', '.join(without) or 'none'}")
sys.exit(bool(failed or without or not attempted))

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
without = [name for name, thing in public_names(package) if ">>>" not in (inspect.getdoc(thing) or "")]
result = doctest.testmod(package, optionflags=doctest.NORMALIZE_WHITESPACE)
print(f"{sys.argv[1]}: {result.attempted} lines of examples, {result.failed} of them fail; "
      f"without an example: {', '.join(without) or 'none'}")
sys.exit(bool(result.failed or without or not result.attempted))

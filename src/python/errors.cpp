// Exceptions are classes of the package, in Python: here they are found by their names.
#include "python/errors.hpp"

namespace gaussdrift::python {

namespace py = pybind11;

void set_error(const char* package, const char* name, const char* text, const py::dict& numbers) {
  const py::object kind = py::module_::import(package).attr(name);
  const py::object error = kind(text);
  for (const auto& [key, value] : numbers) py::setattr(error, key, value);
  PyErr_SetObject(kind.ptr(), error.ptr());
}

}  // namespace gaussdrift::python

// Errors of the libraries as those of their Python packages, with the same texts.
#pragma once

#include <pybind11/pybind11.h>

#include <exception>
#include <new>
#include <stdexcept>
#include <string>

namespace gaussdrift::python {

/// Sets the error of a package, "fgtd" and "InvalidArgument", with numbers that its exception keeps.
void set_error(const char* package, const char* name, const char* text, const pybind11::dict& numbers = {});

/// What the libraries throw, as the errors of a package. Another exception passes.
template <class InvalidArgument, class ToleranceError, class MemoryLimitError, class TimeLimitError>
void translate(const char* package, const std::exception_ptr& thrown) {
  try {
    std::rethrow_exception(thrown);
  } catch (const InvalidArgument& error) {
    set_error(package, "InvalidArgument", error.what());
  } catch (const std::invalid_argument& error) {  // a shape that no library can see
    set_error(package, "InvalidArgument", (std::string(package) + ": " + error.what()).c_str());
  } catch (const ToleranceError& error) {
    set_error(package, "ToleranceError", error.what());
  } catch (const MemoryLimitError& error) {
    pybind11::dict numbers;
    numbers["needed"] = error.needed;
    numbers["limit"] = error.limit;
    set_error(package, "MemoryLimitError", error.what(), numbers);
  } catch (const TimeLimitError& error) {
    pybind11::dict numbers;
    numbers["seconds"] = error.seconds;
    numbers["method"] = to_string(error.method);
    set_error(package, "TimeLimitError", error.what(), numbers);
  }
}

}  // namespace gaussdrift::python

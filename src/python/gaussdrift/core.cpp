// gaussdrift._core: what the Python package gaussdrift takes from the simulator. Its pages are in __init__.py.
#include <pybind11/functional.h>
#include <pybind11/stl.h>

#include <atomic>
#include <string>
#include <utility>
#include <vector>

#include "accuracy/forecast.hpp"
#include "gaussdrift/gaussdrift.hpp"
#include "python/errors.hpp"
#include "python/gaussdrift/frames.hpp"
#include "python/without_lock.hpp"

namespace py = pybind11;

namespace gaussdrift::python {

namespace {

ReadResult parse(const std::string& text, const std::string& file, const std::vector<std::string>& overrides,
                 int threads) {
  return without_lock([&] {
    ReadResult read = parse_case(text, file, overrides, threads);
    return read;
  });
}

/// see(frame) is called at each output; where it returns False the run stops.
py::dict run(const Case& spec, int threads, const py::object& see) {
  Signals signals;
  std::atomic<bool> wanted = true;
  RunSummary summary;
  std::vector<std::string> warnings;
  {
    const py::gil_scoped_release released;
    refuse_what_does_not_fit(spec, threads);
    Simulation simulation(spec, threads);
    simulation.observe("python", [&](const Frame& frame) {
      if (signals.have_come()) return;  // its error is set, and nothing else may run in Python
      const py::gil_scoped_acquire lock;
      if (see(dict_of(frame)).is(py::bool_(false))) wanted = false;
    });
    simulation.on_progress([&](const Progress&) { return wanted && !signals.have_come(); });
    simulation.abandon_when([&] { return !wanted || signals.have_come(); });
    try {
      summary = simulation.run();
    } catch (const Abandoned&) {  // a signal came before the first step
    }
    if (summary.complete) warnings = warnings_of(spec, summary);
  }
  if (signals.have_come()) throw py::error_already_set();
  py::dict told = dict_of(summary);
  told["warnings"] = warnings;
  return told;
}

std::pair<std::string, std::string> check(const Case& spec, int threads) {
  return without_lock([&] {
    const accuracy::Forecast forecast = accuracy::forecast(spec, threads);
    return std::pair(accuracy::to_text(spec, forecast), accuracy::to_json(spec, forecast));
  });
}

void translate_errors(std::exception_ptr thrown) {
  try {
    std::rethrow_exception(thrown);
  } catch (const CaseError& error) {
    py::dict numbers;
    numbers["count"] = error.count();
    set_error("gaussdrift", "CaseError", error.what(), numbers);
  } catch (const InputError& error) {
    set_error("gaussdrift", "InputError", error.what());
  } catch (const NumericalError& error) {
    set_error("gaussdrift", "NumericalError", error.what());
  } catch (const FileError& error) {
    set_error("gaussdrift", "FileError", error.what());
  } catch (const Error& error) {
    set_error("gaussdrift", "Error", error.what());
  }
}

}  // namespace

}  // namespace gaussdrift::python

PYBIND11_MODULE(_core, module) {
  using gaussdrift::Case;
  using gaussdrift::ReadResult;
  py::register_local_exception_translator(gaussdrift::python::translate_errors);
  py::class_<Case>(module, "Case", py::module_local())
      .def_readonly("name", &Case::name)
      .def_readonly("title", &Case::title)
      .def("text", [](const Case& spec) { return gaussdrift::case_text(spec); })
      .def("has_target", [](const Case& spec) { return spec.accuracy.target.has_value(); });
  module.def("parse", [](const std::string& text, const std::string& file, const std::vector<std::string>& overrides,
                         int threads) {
    ReadResult read = gaussdrift::python::parse(text, file, overrides, threads);
    return py::make_tuple(std::move(read.spec), read.warnings);
  });
  module.def("settled", [](const Case& spec, int threads) {
    return gaussdrift::python::without_lock([&] { return gaussdrift::choose_settings(spec, threads); });
  });
  module.def("run", &gaussdrift::python::run);
  module.def("check", &gaussdrift::python::check);
}

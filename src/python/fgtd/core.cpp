// fgtd._core: what the Python package fgtd takes from the library. Its pages are in __init__.py.
#include <fgtd/fgtd.hpp>
#include <sstream>

#include "python/errors.hpp"
#include "python/sums.hpp"

namespace py = pybind11;

namespace fgtd {

// Found by the argument: see python/sums.hpp.
py::dict choice_of(const Choice& choice) {
  py::dict told;
  told["method"] = to_string(choice.method);
  told["tolerance"] = choice.tolerance;
  told["bound"] = choice.bound;
  told["seconds"] = choice.seconds;
  told["sources"] = choice.sources;
  told["targets"] = choice.targets;
  py::dict all;
  for (const Parameter& parameter : parameters(choice)) all[py::str(parameter.name)] = parameter.value;
  told["parameters"] = all;
  std::ostringstream text;
  text << choice;
  told["text"] = text.str();
  return told;
}

}  // namespace fgtd

namespace gaussdrift::python {

namespace {

std::unique_ptr<Sums> plan(const py::object& sources, const py::object& weights, double sigma, double tolerance,
                           int derivatives, const std::string& method, int threads, std::size_t memory_limit,
                           double most_seconds, std::size_t expected_targets,
                           std::vector<std::vector<double>> expected_grid) {
  const Rows rows(sources, "sources");
  const Weights columns(weights, "weights");
  fgtd::Options options;
  options.tolerance = tolerance;
  options.derivative_order = derivatives;
  options.method = one_named("method", fgtd::methods(), method);
  options.threads = threads;
  options.memory_limit = memory_limit;
  options.most_seconds = most_seconds;
  read_expected(options, expected_targets, std::move(expected_grid));
  return in_dimension<4>(rows, "sources", [&]<int d>() {
    return sums_of<d>([&] { return fgtd::Plan<d>(rows.columns<d>(), columns.matrix(), sigma, options); });
  });
}

}  // namespace

}  // namespace gaussdrift::python

PYBIND11_MODULE(_core, module) {
  py::register_local_exception_translator([](std::exception_ptr thrown) {
    gaussdrift::python::translate<fgtd::InvalidArgument, fgtd::ToleranceError, fgtd::MemoryLimitError,
                                  fgtd::TimeLimitError>("fgtd", thrown);
  });
  gaussdrift::python::bind_sums(module);
  module.def("plan", &gaussdrift::python::plan);
  module.attr("smallest_tolerance") = fgtd::smallest_tolerance;
}

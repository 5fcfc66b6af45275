// fgtd._core: what the Python package fgtd takes from the library. Its pages are in __init__.py.
#include <fgtd/fgtd.hpp>
#include <memory>
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

template <int d>
std::unique_ptr<Sums> make(const Rows& sources, const Weights& weights, double sigma, const fgtd::Options& options) {
  return without_lock([&] {
    return std::make_unique<SumsOf<d, fgtd::Plan<d>>>(
        fgtd::Plan<d>(sources.columns<d>(), weights.matrix(), sigma, options));
  });
}

fgtd::Method method_named(const std::string& name) {
  std::string known;
  for (const fgtd::Method method : fgtd::methods()) {
    if (to_string(method) == name) return method;
    known += (known.empty() ? "" : ", ") + to_string(method);
  }
  throw std::invalid_argument("there is no method \"" + name + "\". There are: " + known);
}

std::unique_ptr<Sums> plan(const py::object& sources, const py::object& weights, double sigma, double tolerance,
                           int derivatives, const std::string& method, int threads, std::size_t memory_limit,
                           double most_seconds, std::size_t expected_targets,
                           std::vector<std::vector<double>> expected_grid) {
  const Rows rows(sources, "sources");
  const Weights columns(weights, "weights");
  fgtd::Options options;
  options.tolerance = tolerance;
  options.derivative_order = derivatives;
  options.method = method_named(method);
  options.threads = threads;
  options.memory_limit = memory_limit;
  options.most_seconds = most_seconds;
  read_expected(options, expected_targets, std::move(expected_grid));
  switch (rows.dimension()) {
    case 1:
      return make<1>(rows, columns, sigma, options);
    case 2:
      return make<2>(rows, columns, sigma, options);
    case 3:
      return make<3>(rows, columns, sigma, options);
    case 4:
      return make<4>(rows, columns, sigma, options);
  }
  throw std::invalid_argument("sources must have 1 to 4 coordinates, a point a row; they have " +
                              std::to_string(rows.dimension()));
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

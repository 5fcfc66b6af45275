// fgtd._core: what the Python package fgtd takes from the library. Its pages are in __init__.py.
#include <fgtd/density.hpp>
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

/// A covariance d x d.
template <int d>
fgtd::Covariance<d> covariance_of(const py::object& matrix) {
  const Rows rows(matrix, "bandwidth");
  const auto given = rows.columns<d>();
  if (given.cols() != d) throw std::invalid_argument("a matrix as bandwidth must have as many rows as columns");
  return given.transpose();
}

/// bandwidth: the name of a rule, a number or a matrix.
py::array bandwidth_matrix(const py::object& points, const py::object& weights, const py::object& bandwidth) {
  const Rows rows(points, "points");
  const Weights columns(weights, "weights");
  return in_dimension<4>(rows, "points", [&]<int d>() {
    fgtd::Bandwidth<d> given;
    if (py::isinstance<py::str>(bandwidth))
      given = one_named("bandwidth", fgtd::bandwidth_rules(), bandwidth.cast<std::string>());
    else if (py::array::ensure(bandwidth).ndim() == 0)
      given = bandwidth.cast<double>();
    else
      given = covariance_of<d>(bandwidth);
    return array_of(without_lock(
        [&] { return Eigen::MatrixXd(fgtd::bandwidth_matrix<d>(rows.columns<d>(), columns.matrix().col(0), given)); }));
  });
}

py::array normalised_weights(const py::object& weights) {
  const Weights columns(weights, "weights");
  return array_of(Eigen::MatrixXd(fgtd::normalised_weights(columns.matrix().col(0))));
}

/// Root and peak of the whitening of a covariance.
py::tuple whitening(const py::object& covariance) {
  return in_dimension<4>(Rows(covariance, "bandwidth"), "bandwidth", [&]<int d>() {
    const fgtd::Whitening<d> white(covariance_of<d>(covariance));
    return py::make_tuple(array_of(Eigen::MatrixXd(white.root())), white.peak());
  });
}

py::array whitened(const py::object& points, const py::object& covariance) {
  const Rows rows(points, "points");
  return in_dimension<4>(rows, "points", [&]<int d>() {
    const fgtd::Whitening<d> white(covariance_of<d>(covariance));
    return array_of_points<d>(without_lock([&] { return white.of(rows.columns<d>()); }));
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
  module.def("bandwidth_matrix", &gaussdrift::python::bandwidth_matrix);
  module.def("normalised_weights", &gaussdrift::python::normalised_weights);
  module.def("whitening", &gaussdrift::python::whitening);
  module.def("whitened", &gaussdrift::python::whitened);
  module.attr("smallest_tolerance") = fgtd::smallest_tolerance;
}

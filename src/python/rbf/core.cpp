// rbf._core: what the Python package rbf takes from the library. Its pages are in __init__.py.
#include <rbf/interpolant.hpp>
#include <rbf/rbf.hpp>
#include <sstream>

#include "python/errors.hpp"
#include "python/sums.hpp"

namespace py = pybind11;

namespace rbf {

// Found by the argument: see python/sums.hpp.
py::dict choice_of(const Choice& choice) {
  py::dict told;
  told["method"] = to_string(choice.method);
  told["tolerance"] = choice.tolerance;
  told["range"] = choice.range;
  told["largest"] = choice.largest;
  told["bound"] = choice.bound;
  told["gaussians"] = choice.terms.size();
  told["seconds"] = choice.seconds;
  told["centres"] = choice.centres;
  told["targets"] = choice.targets;
  std::ostringstream text;
  text << choice;
  told["text"] = text.str();
  return told;
}

py::dict choice_of(const FitReport& report) {
  py::dict told;
  told["kernel"] = to_string(report.function.kernel);
  told["shape"] = report.function.shape;
  told["solver"] = to_string(report.solver);
  told["residual"] = report.residual;
  told["condition"] = report.condition;
  told["iterations"] = report.iterations;
  told["left_out"] = report.left_out;
  std::ostringstream text;
  text << report;
  told["text"] = text.str();
  return told;
}

}  // namespace rbf

namespace gaussdrift::python {

namespace {

rbf::Function function(const std::string& kernel, double shape) {
  return {one_named("kernel", rbf::kernels(), kernel), shape};
}

std::unique_ptr<Sums> plan(const std::string& kernel, double shape, const py::object& centres,
                           const py::object& weights, double tolerance, int derivatives, const std::string& method,
                           int threads, std::size_t memory_limit, double most_seconds, double range,
                           std::size_t expected_targets, std::vector<std::vector<double>> expected_grid) {
  const Rows rows(centres, "centres");
  const Weights columns(weights, "weights");
  const rbf::Function phi = function(kernel, shape);
  rbf::Options options;
  options.tolerance = tolerance;
  options.derivative_order = derivatives;
  options.method = one_named("method", rbf::methods(), method);
  options.threads = threads;
  options.memory_limit = memory_limit;
  options.most_seconds = most_seconds;
  options.range = range;
  read_expected(options, expected_targets, std::move(expected_grid));
  return in_dimension<3>(rows, "centres", [&]<int d>() {
    return sums_of<d>([&] { return rbf::Plan<d>(phi, rows.columns<d>(), columns.matrix(), options); });
  });
}

/// An interpolant with the face of a plan.
template <int d>
class Fit {
 public:
  explicit Fit(rbf::Interpolant<d> interpolant) : interpolant_(std::move(interpolant)) {}
  template <class Targets>
  Eigen::MatrixXd evaluate_combinations(const Targets& targets,
                                        const std::vector<rbf::Combination<d>>& operators) const {
    return interpolant_.evaluate_combinations(targets, operators);
  }
  const rbf::FitReport& choice() const { return interpolant_.report(); }

 private:
  rbf::Interpolant<d> interpolant_;
};

/// The interpolant, its weights and the errors of values that are left out.
py::tuple fit(const std::string& kernel, double shape, const py::object& points, const py::object& values,
              double accuracy, double regularisation, const std::string& solver, int threads,
              std::size_t memory_limit) {
  const Rows rows(points, "points");
  const Weights columns(values, "values");
  const rbf::Function phi = function(kernel, shape);
  rbf::FitOptions options;
  options.accuracy = accuracy;
  options.regularisation = regularisation;
  options.solver =
      one_named("solver", std::vector{rbf::Solver::automatic, rbf::Solver::dense, rbf::Solver::krylov}, solver);
  options.threads = threads;
  options.memory_limit = memory_limit;
  return in_dimension<3>(rows, "points", [&]<int d>() {
    const rbf::Interpolant<d> fitted =
        without_lock([&] { return rbf::Interpolant<d>(phi, rows.columns<d>(), columns.matrix(), options); });
    std::unique_ptr<Sums> sums = std::make_unique<SumsOf<d, Fit<d>>>(Fit<d>(fitted));
    return py::make_tuple(std::move(sums), array_of(Eigen::MatrixXd(fitted.weights())),
                          array_of(Eigen::MatrixXd(fitted.left_out_errors())));
  });
}

double range_of(const py::object& centres, const py::object& targets) {
  const Rows from(centres, "centres"), to(targets, "targets");
  if (to.dimension() != from.dimension()) throw std::invalid_argument("targets have other coordinates than centres");
  return in_dimension<3>(from, "centres",
                         [&]<int d>() { return rbf::range_of<d>(from.columns<d>(), to.columns<d>()); });
}

}  // namespace

}  // namespace gaussdrift::python

PYBIND11_MODULE(_core, module) {
  py::register_local_exception_translator([](std::exception_ptr thrown) {
    try {
      std::rethrow_exception(thrown);
    } catch (const rbf::IllConditioned& error) {
      gaussdrift::python::set_error("rbf", "IllConditioned", error.what());
    } catch (...) {
      gaussdrift::python::translate<rbf::InvalidArgument, rbf::ToleranceError, rbf::MemoryLimitError,
                                    rbf::TimeLimitError>("rbf", std::current_exception());
    }
  });
  gaussdrift::python::bind_sums(module);
  module.def("plan", &gaussdrift::python::plan);
  module.def("fit", &gaussdrift::python::fit);
  module.def("range_of", &gaussdrift::python::range_of);
  module.attr("smallest_tolerance") = rbf::smallest_tolerance;
}

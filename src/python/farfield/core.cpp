// farfield._core: what the Python package farfield takes from the library. Its pages are in __init__.py.
#include <farfield/farfield.hpp>
#include <memory>
#include <sstream>
#include <utility>

#include <pybind11/stl.h>

#include "python/arrays.hpp"
#include "python/errors.hpp"
#include "python/named.hpp"
#include "python/without_lock.hpp"

namespace gaussdrift::python {

namespace py = pybind11;

namespace {

/// A plan of some dimension.
class Pairs {
 public:
  virtual ~Pairs() = default;
  virtual int dimension() const = 0;
  /// Potentials, which may be none, and fields M x d.
  virtual std::pair<py::array, py::array> evaluate(const py::object& charges) const = 0;
  virtual py::dict choice() const = 0;
};

template <int d>
class PairsIn : public Pairs {
 public:
  explicit PairsIn(farfield::Plan<d> plan) : plan_(std::move(plan)) {}
  int dimension() const override { return d; }
  std::pair<py::array, py::array> evaluate(const py::object& charges) const override {
    const Weights columns(charges, "charges");
    if (columns.matrix().cols() != 1) throw std::invalid_argument("charges must be N numbers, one a source");
    farfield::Values<d> values = without_lock([&] { return plan_.evaluate(columns.matrix().col(0)); });
    return {array_of(Eigen::MatrixXd(std::move(values.potential))), array_of_points<d>(std::move(values.field))};
  }
  py::dict choice() const override {
    const farfield::Choice& choice = plan_.choice();
    py::dict told;
    told["kernel"] = to_string(choice.kernel);
    told["method"] = to_string(choice.method);
    told["tolerance"] = choice.tolerance;
    told["bound"] = choice.bound;
    told["seconds"] = choice.seconds;
    told["sources"] = choice.sources;
    told["targets"] = choice.targets;
    std::ostringstream text;
    text << choice;
    told["text"] = text.str();
    return told;
  }

 private:
  farfield::Plan<d> plan_;
};

std::unique_ptr<Pairs> plan(const std::string& kernel, const py::object& sources, const py::object& targets,
                            double tolerance, const std::string& method, int threads, double core_radius,
                            bool potential, std::size_t memory_limit, double most_seconds) {
  const Rows from(sources, "sources");
  const Rows to = targets.is_none() ? from : Rows(targets, "targets");
  if (to.dimension() != from.dimension()) {
    throw std::invalid_argument("targets have " + std::to_string(to.dimension()) + " coordinates, the sources " +
                                std::to_string(from.dimension()));
  }
  farfield::Options options;
  options.tolerance = tolerance;
  options.method = one_named("method", farfield::methods(), method);
  options.threads = threads;
  options.core_radius = core_radius;
  options.potential = potential;
  options.memory_limit = memory_limit;
  options.most_seconds = most_seconds;
  const farfield::Kernel wanted = one_named("kernel", farfield::kernels(), kernel);
  return in_dimension<3>(from, "sources", [&]<int d>() {
    return without_lock([&]() -> std::unique_ptr<Pairs> {
      return std::make_unique<PairsIn<d>>(targets.is_none()
                                              ? farfield::Plan<d>(wanted, from.columns<d>(), options)
                                              : farfield::Plan<d>(wanted, from.columns<d>(), to.columns<d>(), options));
    });
  });
}

}  // namespace

}  // namespace gaussdrift::python

namespace py = pybind11;

PYBIND11_MODULE(_core, module) {
  using gaussdrift::python::Pairs;
  py::register_local_exception_translator([](std::exception_ptr thrown) {
    try {
      std::rethrow_exception(thrown);
    } catch (const farfield::RangeError& error) {
      py::dict where;
      where["quantity"] = error.quantity;
      where["target"] = error.target;
      gaussdrift::python::set_error("farfield", "RangeError", error.what(), where);
    } catch (...) {
      gaussdrift::python::translate<farfield::InvalidArgument, farfield::ToleranceError, farfield::MemoryLimitError,
                                    farfield::TimeLimitError>("farfield", std::current_exception());
    }
  });
  py::class_<Pairs>(module, "Pairs", py::module_local())
      .def_property_readonly("dimension", &Pairs::dimension)
      .def("evaluate", &Pairs::evaluate)
      .def("choice", &Pairs::choice);
  module.def("plan", &gaussdrift::python::plan);
  module.attr("smallest_tolerance") = farfield::smallest_tolerance;
}

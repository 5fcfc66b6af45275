// Plans of any dimension behind one face: sums at points or on a tensor grid, of combinations of derivatives.
#pragma once

#include <pybind11/stl.h>

#include <array>
#include <fgtd/fgtd.hpp>
#include <memory>
#include <mutex>
#include <shared_mutex>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "python/arrays.hpp"
#include "python/named.hpp"
#include "python/without_lock.hpp"

namespace gaussdrift::python {

/// A list of (multi-index, coefficient): a linear differential operator, as Python writes it.
using Operator = std::vector<std::pair<std::vector<int>, double>>;

/// The operators in d dimensions. Throws std::invalid_argument for a multi-index of another length.
template <int d>
std::vector<fgtd::Combination<d>> combinations(const std::vector<Operator>& operators) {
  std::vector<fgtd::Combination<d>> all;
  for (const Operator& one : operators) {
    fgtd::Combination<d> terms;
    for (const auto& [index, coefficient] : one) {
      if (index.size() != d) {
        throw std::invalid_argument("a multi-index has " + std::to_string(d) +
                                    " numbers here, one an axis; this one has " + std::to_string(index.size()));
      }
      fgtd::Term<d> term{{}, coefficient};
      std::copy(index.begin(), index.end(), term.derivative.begin());
      terms.push_back(term);
    }
    all.push_back(std::move(terms));
  }
  return all;
}

/// A plan of some dimension.
class Sums {
 public:
  virtual ~Sums() = default;
  virtual int dimension() const = 0;
  /// M x (c * operators).
  virtual pybind11::array at(const pybind11::object& targets, const std::vector<Operator>& operators) const = 0;
  virtual pybind11::array on_grid(std::vector<std::vector<double>> axes,
                                  const std::vector<Operator>& operators) const = 0;
  virtual void set_weights(const pybind11::object& weights) = 0;
  /// Method, parameters, bound and cost, by name.
  virtual pybind11::dict choice() const = 0;
};

/// Plan: a class of a library. Its evaluations may run in several threads at a time; new weights wait for them.
template <int d, class Plan>
class SumsOf : public Sums {
 public:
  explicit SumsOf(Plan plan) : plan_(std::move(plan)) {}

  int dimension() const override { return d; }
  pybind11::array at(const pybind11::object& targets, const std::vector<Operator>& operators) const override {
    const Rows rows(targets, "targets");
    if (rows.dimension() != d) {
      throw std::invalid_argument("targets have " + std::to_string(rows.dimension()) + " coordinates, the sources " +
                                  std::to_string(d));
    }
    const auto wanted = combinations<d>(operators);
    return array_of(without_lock([&] {
      const std::shared_lock lock(mutex_);
      return plan_.evaluate_combinations(rows.columns<d>(), wanted);
    }));
  }
  pybind11::array on_grid(std::vector<std::vector<double>> axes,
                          const std::vector<Operator>& operators) const override {
    const fgtd::TensorGrid grid{std::move(axes)};
    const auto wanted = combinations<d>(operators);
    return array_of(without_lock([&] {
      const std::shared_lock lock(mutex_);
      return plan_.evaluate_combinations(grid, wanted);
    }));
  }
  void set_weights(const pybind11::object& weights) override {
    if constexpr (requires(Plan plan, Eigen::MatrixXd matrix) { plan.set_weights(matrix); }) {
      const Weights columns(weights, "weights");
      without_lock([&] {
        const std::unique_lock lock(mutex_);
        plan_.set_weights(columns.matrix());
      });
    } else {
      throw std::invalid_argument("what is fitted has the weights that it needs");
    }
  }
  pybind11::dict choice() const override {
    const std::shared_lock lock(mutex_);
    return choice_of(plan_.choice());  // of the module, found by its argument
  }

 private:
  Plan plan_;
  mutable std::shared_mutex mutex_;
};

/// The plan that make() returns, which runs without Python's lock.
template <int d, class Make>
std::unique_ptr<Sums> sums_of(const Make& make) {
  return without_lock([&]() -> std::unique_ptr<Sums> {
    auto plan = make();
    return std::make_unique<SumsOf<d, decltype(plan)>>(std::move(plan));
  });
}

/// Options of the same name in fgtd and rbf.
template <class Options>
void read_expected(Options& options, std::size_t targets, std::vector<std::vector<double>> grid) {
  options.expected_targets = targets;
  if (!grid.empty()) options.expected_grid = fgtd::TensorGrid{std::move(grid)};
}

/// The class in Python, without a constructor. Each module has its own.
inline pybind11::class_<Sums> bind_sums(pybind11::module_& module) {
  return pybind11::class_<Sums>(module, "Sums", pybind11::module_local())
      .def_property_readonly("dimension", &Sums::dimension)
      .def("at", &Sums::at)
      .def("on_grid", &Sums::on_grid)
      .def("set_weights", &Sums::set_weights)
      .def("choice", &Sums::choice);
}

}  // namespace gaussdrift::python

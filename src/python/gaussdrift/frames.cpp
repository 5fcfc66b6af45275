// Names are those of series.csv and summary.json.
#include "python/gaussdrift/frames.hpp"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace gaussdrift::python {

namespace py = pybind11;

namespace {

/// Values on a lattice, in its shape; the first axis is the fastest in memory.
py::array on_lattice(const std::vector<double>& values, const Lattice& lattice, int components) {
  std::vector<py::ssize_t> shape, strides;
  py::ssize_t stride = sizeof(double) * components;
  for (int k = 0; k < lattice.dimension; ++k) {
    shape.push_back(static_cast<py::ssize_t>(lattice.points[k]));
    strides.push_back(stride);
    stride *= shape.back();
  }
  if (components > 1) {
    shape.push_back(components);
    strides.push_back(sizeof(double));
  }
  return py::array_t<double>(shape, strides, values.data());  // without an owner: a copy
}

py::array positions_of(const Particles& particles) {
  const py::ssize_t count = static_cast<py::ssize_t>(particles.size());
  py::array_t<double, py::array::f_style> rows({count, py::ssize_t{particles.dimension}});
  for (int k = 0; k < particles.dimension; ++k)
    std::copy(particles.position[k].begin(), particles.position[k].end(), rows.mutable_data() + k * count);
  return rows;
}

template <class Number>
py::array copied(const std::vector<Number>& numbers) {
  return py::array_t<Number>(static_cast<py::ssize_t>(numbers.size()), numbers.data());
}

}  // namespace

py::dict dict_of(const Frame& frame) {
  py::dict told;
  told["index"] = frame.index;
  told["time"] = frame.time;
  const Lattice& lattice = frame.density->lattice;
  py::list axes;
  for (int k = 0; k < lattice.dimension; ++k) axes.append(copied(lattice.nodes(k)));
  told["axes"] = axes;
  told["density"] = on_lattice(frame.density->rho, lattice, 1);
  told["exact"] = frame.exact ? py::object(on_lattice(*frame.exact, lattice, 1)) : py::none();
  py::dict fields;
  for (const FieldOnGrid& field : frame.density->fields)
    fields[py::str(field.name)] = on_lattice(field.values, lattice, field.components);
  told["fields"] = fields;
  told["positions"] = positions_of(*frame.particles);
  told["weights"] = copied(frame.particles->alpha);
  told["ids"] = copied(frame.particles->id);
  return told;
}

py::dict dict_of(const RunSummary& summary) {
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> time, mass, minimum, maximum, l1, l2, linf, transform_error, seconds;
  for (const auto& [at, numbers] : summary.frames) {
    time.push_back(at);
    mass.push_back(numbers.mass);
    minimum.push_back(numbers.minimum);
    maximum.push_back(numbers.maximum);
    l1.push_back(numbers.error ? numbers.error->l1 : unknown);
    l2.push_back(numbers.error ? numbers.error->l2 : unknown);
    linf.push_back(numbers.error ? numbers.error->linf : unknown);
    transform_error.push_back(numbers.transform_error);
    seconds.push_back(numbers.seconds);
  }
  py::dict series;
  series["time"] = copied(time);
  series["mass"] = copied(mass);
  series["minimum"] = copied(minimum);
  series["maximum"] = copied(maximum);
  series["L1"] = copied(l1);
  series["L2"] = copied(l2);
  series["Linf"] = copied(linf);
  series["transform_error"] = copied(transform_error);
  series["seconds"] = copied(seconds);
  py::list checks;
  for (const CheckResult& check : summary.checks) {
    py::dict one;
    one["text"] = check.text;
    one["value"] = check.value;
    one["passed"] = check.passed;
    checks.append(one);
  }
  py::dict told;
  told["series"] = series;
  told["checks"] = checks;
  told["particles"] = summary.particles;
  told["grid_points"] = summary.grid_points;
  told["steps"] = summary.steps;
  told["spacing"] = summary.spacing;
  told["core_radius"] = summary.core_radius;
  told["threads"] = summary.threads;
  told["transform"] = summary.transform_choice;
  told["seconds"] = summary.seconds;
  told["time"] = summary.time;
  told["complete"] = summary.complete;
  return told;
}

}  // namespace gaussdrift::python

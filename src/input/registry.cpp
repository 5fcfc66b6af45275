#include "input/registry.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "expression/expression.hpp"
#include "field/gaussian_velocity.hpp"
#include "field/grid_data.hpp"
#include "field/named_fields.hpp"
#include "field/shapes.hpp"
#include "read/missing_data.hpp"

namespace gaussdrift::input {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

std::string quoted(std::string_view text) { return fmt::format("\"{}\"", text); }

std::string joined(const std::vector<std::string_view>& words) {
  std::vector<std::string> shown;
  shown.reserve(words.size());
  for (const auto word : words) shown.push_back(quoted(word));
  return fmt::format("{}", fmt::join(shown, ", "));
}

}  // namespace

const std::vector<Table>& tables() {
  static const std::vector<Table> list = {
      {.name = "case", .required = false, .meaning = "what the case is called and where it comes from"},
      {.name = "params",
       .required = false,
       .meaning = "names for numbers: `R = 0.25`; later ones may use earlier ones"},
      {.name = "domain", .required = true, .meaning = "the box on which density is evaluated and particles start"},
      {.name = "velocity",
       .required = true,
       .meaning = "the prescribed velocity u; several `[[velocity]]` add up",
       .kinds = {"u", "streamfunction", "field", "file", "gaussians"}},
      {.name = "density",
       .required = true,
       .meaning = "the density rho_0 at t = 0; several `[[density]]` add up",
       .kinds = {"expression", "shape", "file"}},
      {.name = "particles",
       .required = true,
       .meaning = "the lattice on which particles start, and the blob each carries"},
      {.name = "time", .required = true, .meaning = "how long, and in which steps"},
      {.name = "evaluate", .required = false, .meaning = "the lattice on which density is summed for output"},
      {.name = "output", .required = false, .meaning = "when to write, and what: either `times` or `frames`"},
      {.name = "reference",
       .required = false,
       .meaning =
           "the exact density that every output is compared with: norms, and the arrays `rho_exact` and `error`"},
      {.name = "accuracy",
       .required = false,
       .meaning = "how accurate a run has to be, and whether its errors are told apart by cause"},
      {.name = "check",
       .required = false,
       .meaning =
           "a bound that the results have to keep, or the run ends with exit code 5; several `[[check]]` are possible",
       .kinds = {"what"}},
      {.name = "effects.reaction",
       .required = false,
       .meaning = "weights change along the paths: alpha' = -rate alpha, so d_t rho + div(rho u) + rate rho = 0"},
      {.name = "effects.diffusion",
       .required = false,
       .meaning = "the density diffuses, d_t rho + div(rho u) = D Laplacian rho; `reference.kind` is then `none` "
                  "unless it is `exact`"},
      {.name = "effects.charge",
       .required = false,
       .meaning = "particles are charged and repel each other: X' = u + mobility E(X), E = sum_k q_k (X - X_k) / r^d; "
                  "`reference.kind` is then `none` unless it is `exact`"},
      {.name = "effects.vortex",
       .required = false,
       .meaning = "the density is a vorticity, and its blobs move each other by the velocity that belongs to it; 2D, "
                  "`cutoff = \"gauss2\"`; `reference.kind` is then `none` unless it is `exact`"},
      {.name = "effects.remesh",
       .required = false,
       .meaning = "weights go back to a fresh lattice where particles have moved apart, or every so many steps"},
  };
  return list;
}

namespace {

/// The parameters of the named formulas that a key chooses from.
template <class Named>
void add_parameters(std::vector<Key>& list, std::string_view table, std::string_view with,
                    const std::vector<Named>& all) {
  for (const Named& one : all)
    for (const NamedParameter& parameter : one.about.parameters)
      list.push_back({.table = table,
                      .name = parameter.name,
                      .type = parameter.kind == NamedParameter::Kind::point ? Type::point : Type::number,
                      .required = parameter.fallback.empty(),
                      .fallback = parameter.fallback,
                      .range = parameter.range,
                      .unit = parameter.unit,
                      .symbol = parameter.symbol,
                      .meaning = parameter.meaning,
                      .with = with,
                      .value = one.about.name});
}

template <class Named>
std::vector<std::string_view> names_of(const std::vector<Named>& all) {
  std::vector<std::string_view> names;
  for (const Named& one : all) names.push_back(one.about.name);
  return names;
}

std::vector<Key> written_keys() {
  return {
      {.table = "",
       .name = "gaussdrift",
       .type = Type::whole,
       .required = true,
       .range = {1, 1},
       .meaning = "version of the case format; this program reads version 1"},

      {.table = "case", .name = "title", .meaning = "one line for pictures and reports"},
      {.table = "case", .name = "cite", .meaning = "the source of the case"},

      {.table = "domain",
       .name = "min",
       .type = Type::numbers,
       .required = true,
       .unit = "length",
       .meaning = "lower corner: 2 numbers in 2D, 3 in 3D"},
      {.table = "domain",
       .name = "max",
       .type = Type::numbers,
       .required = true,
       .unit = "length",
       .meaning = "upper corner, above `min` on every axis"},

      {.table = "velocity",
       .name = "u",
       .type = Type::expressions,
       .unit = "length / time",
       .symbol = "u",
       .meaning = "velocity, one expression a dimension"},
      {.table = "velocity",
       .name = "streamfunction",
       .type = Type::expression,
       .unit = "length^2 / time",
       .symbol = "psi",
       .meaning = "2D: u = (d psi/dy, -d psi/dx), by exact derivatives; the divergence is 0"},
      {.table = "velocity",
       .name = "field",
       .type = Type::choice,
       .choices = names_of(named_fields()),
       .meaning = "a named field, with its parameters beside it"},

      {.table = "velocity",
       .name = "file",
       .meaning = "data on a grid for ParaView: .vti, .vtr, or .pvd for several times, between which it is linear; "
                  "relative to the case file"},
      {.table = "velocity",
       .name = "array",
       .meaning = "name of the array in the file; may be left out if there is one",
       .with = "file"},
      {.table = "velocity",
       .name = "arrays",
       .type = Type::texts,
       .meaning = "names of arrays with one component each, `[\"u\", \"v\"]`, instead of `array`",
       .with = "file"},
      {.table = "velocity",
       .name = "interpolation",
       .type = Type::choice,
       .fallback = "linear",
       .choices = {interpolation_names.begin(), interpolation_names.end()},
       .meaning = "between grid points: linear, or cubic with continuous derivatives",
       .with = "file"},
      {.table = "velocity",
       .name = "outside",
       .type = Type::choice,
       .fallback = "error",
       .choices = {outside_names.begin(), outside_names.end()},
       .meaning = "outside the grid: an error, the value of the nearest point of its surface, or zero",
       .with = "file"},
      {.table = "velocity",
       .name = "missing",
       .type = Type::choice,
       .fallback = "error",
       .choices = {read::missing_names.begin(), read::missing_names.end()},
       .meaning = "where the file has no value: an error; `zero`, a coast; `nearest`, the mean of the nearest points "
                  "that have one; `keep` takes all numbers as they are. Missing is what is not finite, what "
                  "`vtkGhostType` or `vtkValidPointMask` hide, what an attribute `_FillValue` or `missing_value` says, "
                  "and numbers that programs use for it, such as 1e20 or -9999, or that lie far outside the rest",
       .with = "file"},
      {.table = "velocity",
       .name = "missing_value",
       .type = Type::number,
       .meaning = "a number that marks missing data, besides the marks that are recognised",
       .with = "file"},

      {.table = "velocity",
       .name = "gaussians",
       .meaning =
           "a table (CSV) of scattered points: the field is a sum of divergence-free Gaussians there; relative to "
           "the case file"},
      {.table = "velocity",
       .name = "kind",
       .type = Type::choice,
       .fallback = "velocity",
       .choices = {gaussian_kind_names.begin(), gaussian_kind_names.end()},
       .meaning =
           "what the table has beside the coordinates `x,y[,z]`: samples of the velocity `u,v[,w]`, to which the "
           "field is fitted; samples of the vorticity (`omega`; in 3D `omega_x,omega_y,omega_z`), to which its "
           "curl is fitted; or coefficients of either (`gamma_x,gamma_y[,gamma_z]`; of the curl form in 2D "
           "`gamma`)",
       .with = "gaussians"},
      {.table = "velocity",
       .name = "width",
       .type = Type::number,
       .fallback = "",
       .range = positive,
       .unit = "length",
       .symbol = "1/sqrt(sigma)",
       .meaning = "of the Gaussians exp(-r^2/width^2); twice the average spacing of the points if it is left out",
       .with = "gaussians"},
      {.table = "velocity",
       .name = "residual",
       .type = Type::number,
       .fallback = "1e-6",
       .range = {1e-12, 1, false, true},
       .meaning = "of a fit: what is left of the samples, in the Euclidean norm",
       .with = "gaussians"},
      {.table = "velocity",
       .name = "regularisation",
       .type = Type::number,
       .fallback = "",
       .range = {0, infinity},
       .meaning = "of a fit: added to the diagonal of its matrix, relative to that; 0 interpolates the samples, more "
                  "smooths them. If it is left out: 0 or, where the Gaussians can hardly be told apart, the least of "
                  "1e-12, 1e-10, 1e-8 and 1e-6 that will do",
       .with = "gaussians"},
      {.table = "velocity",
       .name = "tolerance",
       .type = Type::number,
       .fallback = "1e-8",
       .range = {1e-14, 1, false, true},
       .meaning = "of the sum of the Gaussians, relative to the largest velocity at the points",
       .with = "gaussians"},

      {.table = "density",
       .name = "expression",
       .type = Type::expression,
       .symbol = "rho_0",
       .meaning = "density at t = 0"},
      {.table = "density",
       .name = "shape",
       .type = Type::choice,
       .choices = names_of(named_shapes()),
       .meaning = "a named shape, with its parameters beside it"},

      {.table = "density",
       .name = "file",
       .meaning = "data on a grid for ParaView: .vti or .vtr; relative to the case file"},
      {.table = "density",
       .name = "array",
       .meaning = "name of the array in the file; may be left out if there is one",
       .with = "file"},
      {.table = "density",
       .name = "interpolation",
       .type = Type::choice,
       .fallback = "linear",
       .choices = {interpolation_names.begin(), interpolation_names.end()},
       .meaning = "between grid points: linear, or cubic with continuous derivatives",
       .with = "file"},
      {.table = "density",
       .name = "outside",
       .type = Type::choice,
       .fallback = "zero",
       .choices = {outside_names.begin(), outside_names.end()},
       .meaning = "outside the grid: an error, the value of the nearest point of its surface, or zero",
       .with = "file"},
      {.table = "density",
       .name = "missing",
       .type = Type::choice,
       .fallback = "error",
       .choices = {read::missing_names.begin(), read::missing_names.end()},
       .meaning = "where the file has no value: as for velocities",
       .with = "file"},
      {.table = "density",
       .name = "missing_value",
       .type = Type::number,
       .meaning = "a number that marks missing data, besides the marks that are recognised",
       .with = "file"},

      {.table = "particles",
       .name = "per_axis",
       .type = Type::whole,
       .required = true,
       .range = {2, infinity},
       .symbol = "n_g",
       .meaning = "lattice points on the longest axis; the spacing h is the same on all axes"},
      {.table = "particles",
       .name = "overlap",
       .type = Type::number,
       .fallback = "2",
       .range = {0.01, 100},
       .symbol = "c",
       .meaning = "core radius of a blob divided by h: eps = c h"},
      {.table = "particles",
       .name = "cutoff",
       .type = Type::choice,
       .fallback = "gauss2",
       .choices = {"gauss2", "gauss4", "gauss6", "gauss8", "two-gauss"},
       .symbol = "zeta",
       .meaning = "the blob: a Gaussian of order 2, its combinations with derivatives of order 4, 6, 8, or a pair of "
                  "Gaussians of order 4"},
      {.table = "particles",
       .name = "width_ratio",
       .type = Type::number,
       .fallback = "2",
       .range = {0.01, 100},
       .symbol = "a",
       .meaning = "widths of the pair two-gauss are eps and a eps; not 1"},
      {.table = "particles",
       .name = "threshold",
       .type = Type::number,
       .fallback = "1e-12",
       .range = {0, 0.01},
       .meaning = "lattice points with less than this part of the largest weight, and of the largest charge, have no "
                  "particle; the run tells how many, and how much they would carry. 0, the default with "
                  "`[effects.reaction]`, which can raise small weights: every point that carries anything"},

      {.table = "time",
       .name = "end",
       .type = Type::number,
       .required = true,
       .range = {0, infinity},
       .unit = "time",
       .symbol = "T",
       .meaning = "the run ends here; it begins at 0"},
      {.table = "time",
       .name = "step",
       .type = Type::number,
       .range = {0, infinity, true},
       .unit = "time",
       .symbol = "tau",
       .meaning = "time step; the last one before an output is shortened to land on it; needed unless `method` chooses "
                  "its own, then the longest it may choose"},
      {.table = "time",
       .name = "method",
       .type = Type::choice,
       .fallback = "rk4",
       .choices = {"rk4", "euler", "heun", "rk4-38", "dopri5"},
       .meaning = "Runge-Kutta method: the classical one of order 4, Euler's (1), Heun's (2), Kutta's 3/8 rule (4), or "
                  "that of Dormand and Prince (5), which chooses its steps"},
      {.table = "time",
       .name = "tolerance",
       .type = Type::number,
       .fallback = "1e-08",
       .range = {1e-13, 1, false, true},
       .meaning = "error of a position that one step may make, relative to the longest side of the domain; only with "
                  "`method = \"dopri5\"`"},

      {.table = "evaluate",
       .name = "per_axis",
       .type = Type::whole,
       .fallback = "200",
       .range = {2, infinity},
       .symbol = "n_ge",
       .meaning = "evaluation points on the longest axis; the spacing is the same on all axes"},
      {.table = "evaluate",
       .name = "spacing",
       .type = Type::number,
       .range = {0, infinity, true},
       .unit = "length",
       .symbol = "h_e",
       .meaning = "of the evaluation points, on all axes, instead of `per_axis`: for domains that are long and narrow"},
      {.table = "evaluate",
       .name = "tolerance",
       .type = Type::number,
       .fallback = "1e-08",
       .range = {1e-14, 1, false, true},
       .meaning = "error allowed in the Gauss transform, relative to the largest density at that output"},
      {.table = "evaluate",
       .name = "method",
       .type = Type::choice,
       .fallback = "auto",
       .choices = {"auto", "direct", "hermite", "cells", "outer", "chebyshev", "spread"},
       .meaning = "how the Gauss transform is summed; auto takes the cheapest"},

      {.table = "output",
       .name = "times",
       .type = Type::numbers,
       .range = {0, infinity},
       .unit = "time",
       .meaning = "ascending times between 0 and `time.end`"},
      {.table = "output",
       .name = "frames",
       .type = Type::whole,
       .fallback = "5",
       .range = {1, 1e6},
       .meaning = "so many times instead, evenly spaced from 0 to `time.end`; 1 means the end alone"},
      {.table = "output",
       .name = "vtk",
       .type = Type::choices,
       .fallback = "density, particles",
       .choices = {"density", "particles"},
       .meaning = "files for ParaView"},
      {.table = "output",
       .name = "images",
       .type = Type::choices,
       .fallback = "surface, slices",
       .choices = {"surface", "contour", "heatmap", "slices", "projection", "isosurface", "error"},
       .meaning =
           "pictures. In 2D `surface`, `contour`, `heatmap`; in 3D `slices`, `projection`, `isosurface`; in both "
           "`error`, which needs a reference. Of the defaults the one for the dimension"},
      {.table = "output",
       .name = "report",
       .type = Type::choice,
       .fallback = "html",
       .choices = {"html", "none"},
       .meaning =
           "`html`: a page about the run, report.html, with report.json, and summary.png where pictures and densities "
           "are wanted"},

      {.table = "reference",
       .name = "kind",
       .type = Type::choice,
       .fallback = "characteristics",
       .choices = {"characteristics", "exact", "none"},
       .meaning = "`characteristics` traces every grid point back to the start; `exact` is a formula; `none` compares "
                  "with nothing and costs nothing"},
      {.table = "reference",
       .name = "rho",
       .type = Type::expression,
       .symbol = "rho",
       .meaning = "the exact density in x, y, z, t and params; with `kind = \"exact\"`"},
      {.table = "reference",
       .name = "points",
       .type = Type::whole,
       .range = {16, 1e9},
       .meaning =
           "most grid points that are compared. Fewer than the grid has are a sample, half of it where there is "
           "density, and the largest values; then files have no `rho_exact` and `error`. Without it the whole grid "
           "if a picture shows the error or if, with density files, it takes at most 15 % of the work of the run; else "
           "what that allows, 16 to 4096 points, and 256 at most where velocity or reaction are not smooth (data on a "
           "grid, `abs`, ...). Where it does not allow 16 the error is not measured, unless a check or a target needs "
           "it"},

      {.table = "accuracy",
       .name = "target",
       .type = Type::number,
       .range = {1e-9, 0.5},
       .meaning =
           "largest error at the last output, relative to max |rho|: `run` and `check` then choose particles.per_axis, "
           "overlap and cutoff, time.step and evaluate.tolerance of least predicted cost; `--accuracy` is the same"},
      {.table = "accuracy",
       .name = "budget",
       .type = Type::choice,
       .fallback = "auto",
       .choices = {"auto", "measured", "none"},
       .meaning =
           "whether a run with a reference measures what time stepping, smoothing, quadrature and Gauss transform each "
           "add to its error; `auto`: where that costs about a tenth of the run at most"},

      {.table = "check",
       .name = "what",
       .type = Type::choice,
       .required = true,
       .choices = {"Linf", "L1", "L2", "mass"},
       .meaning = "a norm of the error relative to that of the exact density, or the mass relative to that at "
                  "the start"},
      {.table = "check", .name = "max", .type = Type::number, .meaning = "it must not be larger"},
      {.table = "check", .name = "min", .type = Type::number, .meaning = "it must not be smaller"},
      {.table = "check",
       .name = "at",
       .type = Type::number,
       .unit = "time",
       .meaning = "only at this output time; without it at all of them"},

      {.table = "effects.reaction",
       .name = "rate",
       .type = Type::expression,
       .required = true,
       .unit = "1 / time",
       .symbol = "u_0",
       .meaning = "rate of decay, an expression in x, y, z, t and params; negative where weights grow"},
      {.table = "effects.diffusion",
       .name = "D",
       .type = Type::number,
       .required = true,
       .range = {0, infinity, true},
       .unit = "length^2 / time",
       .symbol = "D",
       .meaning = "coefficient of diffusion, constant in space and time"},
      {.table = "effects.diffusion",
       .name = "method",
       .type = Type::choice,
       .fallback = "core-spreading",
       .choices = {"core-spreading", "particle-exchange"},
       .meaning =
           "`core-spreading` widens the blobs, eps(t)^2 = eps^2 + 4 D t: exact where the flow does not strain, and "
           "a warning tells how far it does; `particle-exchange` moves weight between neighbours: of order "
           "eps^2 in any flow, with steps of at most about eps^2 / (2 D)"},
      {.table = "effects.diffusion",
       .name = "tolerance",
       .type = Type::number,
       .fallback = "1e-06",
       .range = {1e-10, 0.1},
       .meaning =
           "particles with more than this part of the largest density are surrounded by others, which receive what "
           "diffuses; only with `method = \"particle-exchange\"`"},
      {.table = "effects.charge",
       .name = "mobility",
       .type = Type::number,
       .required = true,
       .range = {-infinity, infinity},
       .unit = "length^d / (charge time)",
       .symbol = "mu",
       .meaning = "velocity in a field of size 1; negative where equal charges attract each other"},
      {.table = "effects.charge",
       .name = "density",
       .type = Type::expression,
       .unit = "charge / length^d",
       .symbol = "rho_q",
       .meaning =
           "density of charge at the start, an expression in x, y, z and params; every particle keeps its charge. "
           "Without it the charge is the weight"},
      {.table = "effects.charge",
       .name = "tolerance",
       .type = Type::number,
       .fallback = "1e-06",
       .range = {1e-14, 0.1},
       .meaning = "error of E, relative to the sum of the sizes of all fields, as farfield promises it"},
      {.table = "effects.vortex",
       .name = "tolerance",
       .type = Type::number,
       .fallback = "1e-06",
       .range = {1e-14, 0.1},
       .meaning = "error of the velocity, relative to the sum of the sizes of all velocities, as farfield promises it"},
      {.table = "effects.remesh",
       .name = "every",
       .type = Type::whole,
       .range = {1, 1e9},
       .meaning = "steps between two remeshings; without it as `stretch` says"},
      {.table = "effects.remesh",
       .name = "stretch",
       .type = Type::number,
       .fallback = "1.5",
       .range = {1, infinity, true},
       .meaning =
           "remesh whenever particles that were neighbours are farther apart than so many spacings h; the overlap has "
           "then fallen to `particles.overlap` divided by this. Instead of `every`"},
      {.table = "effects.remesh",
       .name = "kernel",
       .type = Type::choice,
       .fallback = "gauss8",
       .choices = {"gauss8", "lambda44", "lambda66", "m4prime"},
       .meaning =
           "how weights are shared among nodes: `gauss8` keeps moments up to order 7 and forgives a stretch of 1.5; "
           "the "
           "piecewise polynomials keep them up to order 4, 6 and 2, are cheaper, and want a stretch of at most 1.1"},
      {.table = "effects.remesh",
       .name = "tolerance",
       .type = Type::number,
       .fallback = "1e-09",
       .range = {0, 0.01},
       .meaning =
           "nodes with less than this part of the largest weight are left out, and their weight goes to the others"},
  };
}

}  // namespace

const std::vector<Key>& keys() {
  static const std::vector<Key> list = [] {
    std::vector<Key> all;
    for (Key& key : written_keys()) {
      all.push_back(std::move(key));
      if (all.back().table == "velocity" && all.back().name == "field")
        add_parameters(all, "velocity", "field", named_fields());
      if (all.back().table == "density" && all.back().name == "shape")
        add_parameters(all, "density", "shape", named_shapes());
    }
    return all;
  }();
  return list;
}

const std::vector<Quantity>& quantities() {
  static const std::vector<Quantity> list = {
      {"d", "dimension of the scene, 2 or 3", "", "", "domain.min, domain.max"},
      {"h", "spacing of the lattice on which particles start, the same on all axes",
       "h = L / (n_g - 1), L the longest side of the domain", "length", "particles.per_axis, domain"},
      {"eps", "core radius: the width of a blob", "eps = c h", "length", "particles.overlap, particles.per_axis"},
      {"sigma", "sharpness of the Gaussians that are summed, exp(-sigma r^2)", "sigma = 1 / eps^2", "1 / length^2",
       "particles.overlap, particles.per_axis"},
      {"zeta_eps", "the blob of core radius eps", "zeta_eps(x) = eps^-d zeta(x / eps)", "1 / length^d",
       "particles.cutoff, particles.overlap"},
      {"x_j", "where particle j starts: a point of the lattice", "", "length", "particles.per_axis, domain"},
      {"X_j", "where particle j is at time t", "X_j' = u(X_j, t), X_j(0) = x_j", "length", "velocity"},
      {"alpha_j", "weight of particle j, the mass that it carries; particles.threshold leaves out the smallest",
       "alpha_j = h^d rho_0(x_j)", "density length^d", "density, particles.per_axis"},
      {"rho_eps^h", "the density of all blobs, which is what a run computes",
       "rho_eps^h(x, t) = sum_j alpha_j zeta_eps(x - X_j(t))", "density", ""},
  };
  return list;
}

std::string range_text(const Range& range) {
  const auto& [least, most, least_open, most_open] = range;
  const bool below = std::isfinite(least), above = std::isfinite(most);
  const std::string lower = fmt::format("{} {}", least_open ? "greater than" : "at least", least);
  const std::string upper = fmt::format("{} {}", most_open ? "less than" : "at most", most);
  if (below && above && least == most) return fmt::format("{}", least);
  if (below && above) return lower + " and " + upper;
  return below ? lower : above ? upper : "";
}

const Key& find_key(std::string_view table, std::string_view name, std::string_view value) {
  for (const Key& key : keys())
    if (key.table == table && key.name == name && key.value == value) return key;
  throw std::logic_error(fmt::format("no key {}.{} in the registry", table, name));
}

const Table& find_table(std::string_view name) {
  for (const Table& table : tables())
    if (table.name == name) return table;
  throw std::logic_error(fmt::format("no table {} in the registry", name));
}

std::vector<std::string> key_names(std::string_view table) {
  std::vector<std::string> names;
  for (const Key& key : keys())
    if (key.table == table && std::find(names.begin(), names.end(), key.name) == names.end())
      names.emplace_back(key.name);
  return names;
}

std::vector<std::string> key_names(std::string_view table, std::string_view kind, std::string_view value) {
  std::vector<std::string> names;
  const auto& kinds = find_table(table).kinds;
  const auto excluded = [&](std::string_view name) {
    return name != kind && std::find(kinds.begin(), kinds.end(), name) != kinds.end();
  };
  for (const Key& key : keys())
    if (key.table == table && key.belongs(kind, value) && !excluded(key.name)) names.emplace_back(key.name);
  return names;
}

std::vector<std::string> table_names() {
  std::vector<std::string> names;
  for (const Table& table : tables()) names.emplace_back(table.name);
  return names;
}

std::string type_text(const Key& key) {
  switch (key.type) {
    case Type::text:
      return "a string";
    case Type::texts:
      return "a list of strings";
    case Type::number:
      return "a number or an expression";
    case Type::whole:
      return "a whole number";
    case Type::numbers:
      return "a list of numbers";
    case Type::point:
      return "a list of numbers, one a dimension";
    case Type::expression:
      return "an expression in a string";
    case Type::expressions:
      return "a list of expressions in strings, one a dimension";
    case Type::choice:
      return key.choices.size() == 1 ? quoted(key.choices[0]) : "one of " + joined(key.choices);
    case Type::choices:
      return "a list of some of " + joined(key.choices);
  }
  return "";
}

namespace {

std::string capital(std::string_view text) {
  return text.empty() ? "" : fmt::format("{}{}", static_cast<char>(std::toupper(text[0])), text.substr(1));
}

/// The keys of a table that go with a kind and a value (both empty: those of no named formula).
std::string keys_markdown(std::string_view table, std::string_view with, std::string_view value) {
  std::string text;
  for (const Key& key : keys()) {
    if (key.table != table || key.value != value || (!value.empty() && key.with != with)) continue;
    if (text.empty())
      text = "\n| key | what | type and range | default | unit | symbol |\n| --- | --- | --- | --- | --- | --- |\n";
    const std::string range = range_text(key.range);
    std::string fallback = key.required ? "required" : std::string(key.fallback);
    if (key.type == Type::choice && !key.fallback.empty()) fallback = quoted(fallback);
    if (key.type == Type::choices && !key.fallback.empty()) fallback = fmt::format("[{}]", fallback);
    const std::string with_text = value.empty() && !key.with.empty() ? fmt::format("; goes with `{}`", key.with) : "";
    text += fmt::format("| `{}` | {}{} | {}{}{} | {} | {} | {} |\n", key.name, key.meaning, with_text, type_text(key),
                        range.empty() ? "" : ", ", range, fallback, key.unit, key.symbol);
  }
  return text;
}

std::string formula_markdown(std::string_view with, const NamedFormula& formula) {
  const std::string where = formula.least_dimension == 3 ? " (3D)" : formula.most_dimension == 2 ? " (2D)" : "";
  return fmt::format("\n#### `{} = \"{}\"`{}\n\n{}.\n\n* value: {}\n", with, formula.name, where,
                     capital(formula.meaning), formula.formula);
}

}  // namespace

std::string registry_markdown() {
  const Key& version = find_key("", "gaussdrift");
  std::string text = fmt::format("`{}` at the top of the file, required: {}.\n", version.name, version.meaning);
  for (const Table& table : tables()) {
    text += fmt::format("\n### `[{}]`\n\n{}.\n", table.name, capital(table.meaning));
    if (!table.kinds.empty()) {
      std::vector<std::string> kinds;
      for (const auto kind : table.kinds) kinds.push_back(fmt::format("`{}`", kind));
      text += fmt::format("\nEach has exactly one of {}.\n", fmt::join(kinds, ", "));
    }
    text += keys_markdown(table.name, "", "");
    if (table.name == "velocity")
      for (const NamedField& field : named_fields())
        text += formula_markdown("field", field.about) +
                fmt::format("* divergence: {}\n* exact flow: {}\n", field.divergence, field.exact_flow) +
                keys_markdown("velocity", "field", field.about.name);
    if (table.name == "density")
      for (const NamedShape& shape : named_shapes())
        text += formula_markdown("shape", shape.about) + keys_markdown("density", "shape", shape.about.name);
  }
  text +=
      "\n### What follows from the keys\n\nSymbols of the thesis that are no keys.\n\n"
      "| symbol | what | formula | unit | set by |\n| --- | --- | --- | --- | --- |\n";
  for (const Quantity& quantity : quantities())
    text += fmt::format("| `{}` | {} | {} | {} | {} |\n", quantity.symbol, quantity.meaning,
                        quantity.formula.empty() ? "" : fmt::format("`{}`", quantity.formula), quantity.unit,
                        quantity.set_by);
  return text;
}

std::string functions_markdown() {
  std::string text = "| function | value |\n| --- | --- |\n";
  for (const FunctionInfo& function : expression_functions()) {
    const char* arguments = function.arguments == 1 ? "a" : function.arguments < 0 ? "a, b, ..." : "a, b";
    text += fmt::format("| `{}({})` | {} |\n", function.name, arguments, function.meaning);
  }
  return text;
}

}  // namespace gaussdrift::input

#include "input/registry.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <set>
#include <stdexcept>

#include "base/catalogue.hpp"
#include "effect/catalogue.hpp"
#include "expression/expression.hpp"
#include "fgtd/fgtd.hpp"
#include "field/density/shapes.hpp"
#include "field/gaussians/gaussian_velocity.hpp"
#include "field/gridded/grid_data.hpp"
#include "field/named/named_fields.hpp"
#include "particle/cutoff.hpp"
#include "read/missing_data.hpp"
#include "render/styles.hpp"
#include "time/tableau.hpp"
#include "write/output_files.hpp"

namespace gaussdrift::input {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

std::string in_quotes(std::string_view text) { return fmt::format("\"{}\"", text); }

std::string quoted_list(const std::vector<std::string_view>& words) {
  std::vector<std::string> shown;
  shown.reserve(words.size());
  for (const auto word : words) shown.push_back(in_quotes(word));
  return fmt::format("{}", fmt::join(shown, ", "));
}

/// The names of the methods that sum the Gauss transform.
std::vector<std::string_view> summation_methods() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const fgtd::Method method : fgtd::methods()) list.push_back(fgtd::to_string(method));
    return list;
  }();
  return {names.begin(), names.end()};
}

}  // namespace

namespace {

std::vector<Table> written_tables() {
  return {
      {.name = "case", .required = false, .meaning = "the title of the case and where it comes from"},
      {.name = "params",
       .required = false,
       .meaning = "names for numbers, such as `R = 0.25`. A parameter may use those above it"},
      {.name = "domain",
       .required = true,
       .meaning = "the box in which particles start and on which the density is evaluated"},
      {.name = "velocity",
       .required = true,
       .meaning = "the prescribed velocity u. Several `[[velocity]]` add up",
       .kinds = {"u", "streamfunction", "field", "file", "gaussians"}},
      {.name = "density",
       .required = true,
       .meaning = "the density rho_0 at time 0. Several `[[density]]` add up",
       .kinds = {"expression", "shape", "file"}},
      {.name = "particles",
       .required = true,
       .meaning = "the lattice on which particles start, and the blob that each of them carries. A blob is a smooth "
                  "bump that spreads the weight of its particle"},
      {.name = "time", .required = true, .meaning = "how long the run lasts, and in which steps"},
      {.name = "evaluate", .required = false, .meaning = "the lattice on which the density is summed for output"},
      {.name = "output",
       .required = false,
       .meaning = "what is written, and when. The times are given by `times` or by `frames`"},
      {.name = "reference",
       .required = false,
       .meaning = "the exact density with which every output is compared. It gives the norms of the error, and the "
                  "arrays `rho_exact` and `error` in the files"},
      {.name = "accuracy",
       .required = false,
       .meaning = "how accurate the run has to be, and whether its error is split by cause"},
      {.name = "check",
       .required = false,
       .meaning = "a bound that the results have to keep. If they break it, the run ends with exit code 5. Several "
                  "`[[check]]` are possible",
       .kinds = {"what"}},
  };
}

}  // namespace

const std::vector<Table>& tables() {
  static base::FromCatalogues<std::vector<Table>> list;
  return list.get([] {
    std::vector<Table> all = written_tables();
    for (const NamedEffect& effect : effects())
      all.push_back({.name = table_of(effect), .required = false, .meaning = std::string(effect.about.meaning)});
    return all;
  });
}

namespace {

Type type_of(NamedParameter::Kind kind) {
  switch (kind) {
    case NamedParameter::Kind::number:
      return Type::number;
    case NamedParameter::Kind::whole:
      return Type::whole;
    case NamedParameter::Kind::point:
      return Type::point;
    case NamedParameter::Kind::choice:
      return Type::choice;
    case NamedParameter::Kind::expression:
    case NamedParameter::Kind::expression_in_time:
      return Type::expression;
  }
  return Type::number;
}

/// "how weights are shared. `gauss8` is smooth. ...".
template <class Thing>
std::string with_choices(std::string_view meaning, const std::vector<Thing>& things) {
  std::string text(meaning);
  for (const Thing& thing : things) text += fmt::format(". `{}` {}", thing.name, thing.meaning);
  return text;
}

/// The key of a parameter. `with`, `value`: what it goes with in a table of several kinds.
Key key_of(std::string_view table, const NamedParameter& parameter, std::string_view with = {},
           std::string_view value = {}) {
  const auto choices = parameter.choices ? parameter.choices() : std::vector<NamedChoice>{};
  return {.table = std::string(table),
          .name = parameter.name,
          .type = type_of(parameter.kind),
          .required = parameter.fallback.empty() && !parameter.optional,
          .fallback = parameter.fallback,
          .range = parameter.range,
          .choices = base::names_of(choices),
          .unit = parameter.unit,
          .symbol = parameter.symbol,
          .meaning = with_choices(parameter.meaning, choices),
          .with = with,
          .value = value};
}

/// The parameters of the named formulas that a key chooses from.
template <class Named>
void add_parameters(std::vector<Key>& list, std::string_view table, std::string_view with,
                    const std::vector<Named>& all) {
  for (const Named& one : all)
    for (const NamedParameter& parameter : one.about.parameters)
      list.push_back(key_of(table, parameter, with, one.about.name));
}

std::string tables_that_grow_weights() {
  std::vector<std::string> names;
  for (const NamedEffect& effect : effects())
    if (!effect.traits.grows_weights.words.empty()) names.push_back(fmt::format("`[{}]`", table_of(effect)));
  return fmt::format("{}", fmt::join(names, " or "));
}

/// A text that is made, kept as long as the program runs.
std::string_view kept(std::string text) {
  static std::mutex one_at_a_time;
  static std::set<std::string> texts;
  const std::lock_guard lock(one_at_a_time);
  return *texts.insert(std::move(text)).first;
}

std::string joined(const std::vector<std::string_view>& words) { return fmt::format("{}", fmt::join(words, ", ")); }

template <class Thing>
std::vector<std::string_view> default_names(const std::vector<Thing>& all) {
  std::vector<std::string_view> names;
  for (const Thing& one : all)
    if (one.about.by_default) names.push_back(one.about.name);
  return names;
}

/// "`surface`, `contour` and `heatmap`".
std::string in_words(const std::vector<std::string_view>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += fmt::format("{}`{}`", i == 0 ? "" : i + 1 < names.size() ? ", " : " and ", names[i]);
  return text;
}

std::string meaning_of_images() {
  std::vector<std::string_view> flat, solid, both, errors;
  for (const render::Style& style : render::styles()) {
    const PictureStyle& about = style.about;
    auto& list = about.shows_error ? errors : !about.shows(3) ? flat : !about.shows(2) ? solid : both;
    list.push_back(about.name);
  }
  const std::string in_both = both.empty() ? "" : in_words(both) + "; ";
  return fmt::format(
      "pictures that are drawn. In 2D {}; in 3D {}; in both {}{}, which needs a reference. The default is `{}` in 2D "
      "and `{}` in 3D",
      in_words(flat), in_words(solid), in_both, in_words(errors), render::default_style(2).about.name,
      render::default_style(3).about.name);
}

std::vector<Key> written_keys() {
  return {
      {.table = "",
       .name = "gaussdrift",
       .type = Type::whole,
       .required = true,
       .range = {1, 1},
       .meaning = "version of the case format. This program reads version 1"},

      {.table = "case", .name = "title", .meaning = "one line of text for pictures and reports"},
      {.table = "case", .name = "cite", .meaning = "where the case comes from, for example a paper"},

      {.table = "domain",
       .name = "min",
       .type = Type::numbers,
       .required = true,
       .unit = "length",
       .meaning = "lower corner: 2 numbers in 2D, 3 numbers in 3D"},
      {.table = "domain",
       .name = "max",
       .type = Type::numbers,
       .required = true,
       .unit = "length",
       .meaning = "upper corner. It lies above `min` on every axis"},

      {.table = "velocity",
       .name = "u",
       .type = Type::expressions,
       .unit = "length / time",
       .symbol = "u",
       .meaning = "the velocity: one expression for each axis"},
      {.table = "velocity",
       .name = "streamfunction",
       .type = Type::expression,
       .unit = "length^2 / time",
       .symbol = "psi",
       .meaning =
           "in 2D: the function psi with u = (d psi/dy, -d psi/dx). Its derivatives are exact, so the divergence is 0"},
      {.table = "velocity",
       .name = "field",
       .type = Type::choice,
       .choices = base::names_of(named_fields()),
       .meaning = "name of a velocity field. Its parameters stand beside it"},

      {.table = "velocity",
       .name = "file",
       .meaning = "a file of ParaView with the velocity on a grid: .vti, .vtr, or .pvd for several times. Between two "
                  "times the velocity is linear. The path is relative to the case file"},
      {.table = "velocity",
       .name = "array",
       .meaning = "name of the array in the file. It may be left out if the file has only one",
       .with = "file"},
      {.table = "velocity",
       .name = "arrays",
       .type = Type::texts,
       .meaning = "names of arrays with one component each, such as `[\"u\", \"v\"]`. They replace `array`",
       .with = "file"},
      {.table = "velocity",
       .name = "interpolation",
       .type = Type::choice,
       .fallback = "linear",
       .choices = {interpolation_names.begin(), interpolation_names.end()},
       .meaning = "between grid points: `linear`, or `cubic` with continuous derivatives",
       .with = "file"},
      {.table = "velocity",
       .name = "outside",
       .type = Type::choice,
       .fallback = "error",
       .choices = {outside_names.begin(), outside_names.end()},
       .meaning = "what holds outside the grid: `error` stops the run there, `clamp` takes the value at the nearest "
                  "point of the surface of the grid, `zero` takes 0",
       .with = "file"},
      {.table = "velocity",
       .name = "missing",
       .type = Type::choice,
       .fallback = "error",
       .choices = {read::missing_names.begin(), read::missing_names.end()},
       .meaning = "what to do where the file has no value. `error` refuses the file, `zero` makes a coast, `nearest` "
                  "takes the mean of the nearest points that have a value, `keep` takes every number as it is. A value "
                  "is missing if it is not finite, if `vtkGhostType` or `vtkValidPointMask` hides it, or if "
                  "`_FillValue` or `missing_value` of its array names it. Numbers that programs use as a mark, such as "
                  "1e20 or -9999, and numbers far outside the rest are missing too",
       .with = "file"},
      {.table = "velocity",
       .name = "missing_value",
       .type = Type::number,
       .meaning = "a number that marks missing data. The usual marks are recognised without it",
       .with = "file"},

      {.table = "velocity",
       .name = "gaussians",
       .meaning = "a table (CSV) of scattered points. The field is a sum of divergence-free Gaussians at these points. "
                  "The path is relative to the case file"},
      {.table = "velocity",
       .name = "kind",
       .type = Type::choice,
       .fallback = "velocity",
       .choices = {gaussian_kind_names.begin(), gaussian_kind_names.end()},
       .meaning = "what the table has beside the coordinates `x,y[,z]`. `velocity`: samples `u,v[,w]`, to which the "
                  "field is fitted. `vorticity`: samples `omega` (in 3D `omega_x,omega_y,omega_z`), to which the curl "
                  "of the field is fitted. `coefficients`: the columns `gamma_x,gamma_y[,gamma_z]` of a field that is "
                  "known already. `curl-coefficients`: those of a field that was fitted to a vorticity, in 2D `gamma`",
       .with = "gaussians"},
      {.table = "velocity",
       .name = "width",
       .type = Type::number,
       .fallback = "",
       .range = positive,
       .unit = "length",
       .symbol = "1/sqrt(sigma)",
       .meaning = "width of the Gaussians exp(-r^2/width^2). Without it, twice the average spacing of the points",
       .with = "gaussians"},
      {.table = "velocity",
       .name = "residual",
       .type = Type::number,
       .fallback = "1e-6",
       .range = {1e-12, 1, false, true},
       .meaning = "accuracy of the fit: the part of the samples that it may leave, in the Euclidean norm",
       .with = "gaussians"},
      {.table = "velocity",
       .name = "regularisation",
       .type = Type::number,
       .fallback = "",
       .range = {0, infinity},
       .meaning = "how much the fit smooths. The diagonal of its matrix is enlarged by this part. With 0 the field "
                  "passes through all samples. Without this key it is 0. Where Gaussians can hardly be told apart, it "
                  "is then the smallest of 1e-12, 1e-10, 1e-8 and 1e-6 with which the fit succeeds",
       .with = "gaussians"},
      {.table = "velocity",
       .name = "tolerance",
       .type = Type::number,
       .fallback = "1e-8",
       .range = {1e-14, 1, false, true},
       .meaning = "error allowed in the sum of the Gaussians, relative to the largest velocity at the points",
       .with = "gaussians"},

      {.table = "density",
       .name = "expression",
       .type = Type::expression,
       .symbol = "rho_0",
       .meaning = "the density at time 0"},
      {.table = "density",
       .name = "shape",
       .type = Type::choice,
       .choices = base::names_of(named_shapes()),
       .meaning = "name of a shape. Its parameters stand beside it"},

      {.table = "density",
       .name = "file",
       .meaning = "a file of ParaView with the density on a grid: .vti or .vtr. The path is relative to the case file"},
      {.table = "density",
       .name = "array",
       .meaning = "name of the array in the file. It may be left out if the file has only one",
       .with = "file"},
      {.table = "density",
       .name = "interpolation",
       .type = Type::choice,
       .fallback = "linear",
       .choices = {interpolation_names.begin(), interpolation_names.end()},
       .meaning = "between grid points: `linear`, or `cubic` with continuous derivatives",
       .with = "file"},
      {.table = "density",
       .name = "outside",
       .type = Type::choice,
       .fallback = "zero",
       .choices = {outside_names.begin(), outside_names.end()},
       .meaning = "what holds outside the grid: `error` stops the run there, `clamp` takes the value at the nearest "
                  "point of the surface of the grid, `zero` takes 0",
       .with = "file"},
      {.table = "density",
       .name = "missing",
       .type = Type::choice,
       .fallback = "error",
       .choices = {read::missing_names.begin(), read::missing_names.end()},
       .meaning = "what to do where the file has no value. The choices are those of `velocity.missing`",
       .with = "file"},
      {.table = "density",
       .name = "missing_value",
       .type = Type::number,
       .meaning = "a number that marks missing data. The usual marks are recognised without it",
       .with = "file"},

      {.table = "particles",
       .name = "per_axis",
       .type = Type::whole,
       .required = true,
       .range = {2, infinity},
       .symbol = "n_g",
       .meaning = "number of lattice points along the longest axis. The spacing h is the same on all axes"},
      {.table = "particles",
       .name = "overlap",
       .type = Type::number,
       .fallback = "2",
       .range = {0.01, 100},
       .symbol = "c",
       .meaning =
           "core radius of a blob in units of the spacing: eps = c h. It says how far neighbouring blobs overlap"},
      {.table = "particles",
       .name = "cutoff",
       .type = Type::choice,
       .fallback = cutoffs().front().name,
       .choices = base::names_of(cutoffs()),
       .symbol = "zeta",
       .meaning = with_choices("shape of the blob. A higher order blurs less", cutoffs())},
      {.table = "particles",
       .name = "threshold",
       .type = Type::number,
       .fallback = "1e-12",
       .range = {0, 0.01},
       .meaning = fmt::format(
           "lattice points that carry less than this part of the largest weight, and of the largest charge, get no "
           "particle. The run says how many they are and how much they would carry. With {}, which can raise small "
           "weights, the default is 0: every point that carries anything gets a particle",
           tables_that_grow_weights())},

      {.table = "time",
       .name = "end",
       .type = Type::number,
       .required = true,
       .range = {0, infinity},
       .unit = "time",
       .symbol = "T",
       .meaning = "time at which the run ends; it begins at 0"},
      {.table = "time",
       .name = "step",
       .type = Type::number,
       .range = {0, infinity, true},
       .unit = "time",
       .symbol = "tau",
       .meaning = "time step; the last one before an output is shortened to end there. A `method` that chooses its "
                  "own steps needs no `step`; if there is one, no step is longer"},
      {.table = "time",
       .name = "method",
       .type = Type::choice,
       .fallback = time::tableaux().front().name,
       .choices = base::names_of(time::tableaux()),
       .meaning = with_choices("Runge-Kutta method", time::tableaux())},
      {.table = "time",
       .name = "tolerance",
       .type = Type::number,
       .fallback = "1e-08",
       .range = {1e-13, 1, false, true},
       .meaning = "for a `method` that chooses its own steps: the error of position that one step may make, relative "
                  "to the longest side of the domain"},

      {.table = "evaluate",
       .name = "per_axis",
       .type = Type::whole,
       .fallback = "200",
       .range = {2, infinity},
       .symbol = "n_ge",
       .meaning = "number of evaluation points along the longest axis. The spacing is the same on all axes"},
      {.table = "evaluate",
       .name = "spacing",
       .type = Type::number,
       .range = {0, infinity, true},
       .unit = "length",
       .symbol = "h_e",
       .meaning =
           "distance between evaluation points on all axes. It replaces `per_axis` and suits long, narrow domains"},
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
       .choices = summation_methods(),
       .meaning = "algorithm that sums the Gauss transform. `auto` takes the cheapest"},
      {.table = "evaluate",
       .name = "most_seconds",
       .type = Type::number,
       .range = {0, infinity, true},
       .unit = "s",
       .meaning = "most seconds that one density may be predicted to take; a case that takes longer is refused before "
                  "its first step. Without this key 300 for a method that is named, and no limit for `auto`"},

      {.table = "output",
       .name = "times",
       .type = Type::numbers,
       .range = {0, infinity},
       .unit = "time",
       .meaning = "times at which output is written, in ascending order between 0 and `time.end`"},
      {.table = "output",
       .name = "frames",
       .type = Type::whole,
       .fallback = "5",
       .range = {1, 1e6},
       .meaning = "number of outputs, evenly spaced from 0 to `time.end`; 1 means the end alone. It replaces `times`"},
      {.table = "output",
       .name = "vtk",
       .type = Type::choices,
       .fallback = kept(joined(default_names(write::output_files()))),
       .choices = base::names_of(write::output_files()),
       .meaning = "files that are written for ParaView"},
      {.table = "output",
       .name = "images",
       .type = Type::choices,
       .fallback = kept(joined(default_names(render::styles()))),
       .choices = base::names_of(render::styles()),
       .meaning = meaning_of_images()},
      {.table = "output",
       .name = "report",
       .type = Type::choice,
       .fallback = "html",
       .choices = {"html", "none"},
       .meaning = "the page about the run. `html` writes report.html and its numbers, report.json. With pictures and "
                  "density files it also writes summary.png"},

      {.table = "reference",
       .name = "kind",
       .type = Type::choice,
       .fallback = "characteristics",
       .choices = {"characteristics", "exact", "none"},
       .meaning = "where the exact density comes from. `characteristics` traces every grid point back to the start. "
                  "`exact` takes a formula. `none` compares with nothing and costs nothing"},
      {.table = "reference",
       .name = "rho",
       .type = Type::expression,
       .symbol = "rho",
       .meaning = "for `kind = \"exact\"`: the exact density, an expression in x, y, z, t and params"},
      {.table = "reference",
       .name = "points",
       .type = Type::whole,
       .range = {16, 1e9},
       .meaning = "largest number of grid points that are compared. If the grid has more points, a sample is compared: "
                  "half of it lies where there is density, and the largest values belong to it. The files then have no "
                  "`rho_exact` and `error`. Without this key the whole grid is compared if a picture shows the error, "
                  "or if there are density files and the comparison takes at most 15 % of the work of the run. "
                  "Otherwise a sample is compared that takes that much, 16 to 4096 points. It has at most 256 points "
                  "where velocity or reaction are not smooth (data on a grid, `abs`, ...). If 16 points are too many, "
                  "the error is not measured, unless a check or a target needs it"},

      {.table = "accuracy",
       .name = "target",
       .type = Type::number,
       .range = {1e-9, 0.5},
       .meaning = "largest error allowed at the last output, relative to max |rho|. `run` and `check` then choose the "
                  "cheapest settings that are predicted to reach it: particles.per_axis, overlap and cutoff, time.step "
                  "and evaluate.tolerance. The option `--accuracy` does the same"},
      {.table = "accuracy",
       .name = "budget",
       .type = Type::choice,
       .fallback = "auto",
       .choices = {"auto", "measured", "none"},
       .meaning =
           "whether the run measures how much of its error comes from time stepping, smoothing, quadrature and Gauss "
           "transform. This needs a reference. `auto` measures where that costs at most about a tenth of the run"},

      {.table = "check",
       .name = "what",
       .type = Type::choice,
       .required = true,
       .choices = {"Linf", "L1", "L2", "mass"},
       .meaning = "the number to check: a norm of the error relative to that of the exact density, or the mass "
                  "relative to that at the start"},
      {.table = "check", .name = "max", .type = Type::number, .meaning = "the number must not be larger"},
      {.table = "check", .name = "min", .type = Type::number, .meaning = "the number must not be smaller"},
      {.table = "check",
       .name = "at",
       .type = Type::number,
       .unit = "time",
       .meaning = "the output time to check. Without it every output is checked"},
  };
}

}  // namespace

const std::vector<Key>& keys() {
  static base::FromCatalogues<std::vector<Key>> list;
  return list.get([] {
    std::vector<Key> all;
    for (Key& key : written_keys()) {
      all.push_back(std::move(key));
      const auto is = [&](std::string_view table, std::string_view name) {
        return all.back().table == table && all.back().name == name;
      };
      if (is("velocity", "field")) add_parameters(all, "velocity", "field", named_fields());
      if (is("density", "shape")) add_parameters(all, "density", "shape", named_shapes());
      if (is("particles", "cutoff"))
        for (const NamedCutoff& cutoff : cutoffs())
          for (const NamedParameter& parameter : cutoff.parameters) all.push_back(key_of("particles", parameter));
    }
    for (const NamedEffect& effect : effects())
      for (const NamedParameter& parameter : effect.about.parameters)
        all.push_back(key_of(table_of(effect), parameter));
    return all;
  });
}

const std::vector<Quantity>& quantities() {
  static const std::vector<Quantity> list = {
      {"d", "dimension of the scene, 2 or 3", "", "", "domain.min, domain.max"},
      {"h", "spacing of the lattice on which particles start, the same on all axes",
       "h = L / (n_g - 1), L the longest side of the domain", "length", "particles.per_axis, domain"},
      {"eps", "core radius: the width of a blob", "eps = c h", "length", "particles.overlap, particles.per_axis"},
      {"sigma", "sharpness of the Gaussians that are summed: exp(-sigma r^2)", "sigma = 1 / eps^2", "1 / length^2",
       "particles.overlap, particles.per_axis"},
      {"zeta_eps", "the blob of core radius eps", "zeta_eps(x) = eps^-d zeta(x / eps)", "1 / length^d",
       "particles.cutoff, particles.overlap"},
      {"x_j", "the lattice point where particle j starts", "", "length", "particles.per_axis, domain"},
      {"X_j", "where particle j is at time t", "X_j' = u(X_j, t), X_j(0) = x_j", "length", "velocity"},
      {"alpha_j", "weight of particle j: the mass that it carries", "alpha_j = h^d rho_0(x_j)", "density length^d",
       "density, particles.per_axis"},
      {"rho_eps^h", "sum of all blobs: the density that a run computes",
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
      return "a list of numbers, one for each axis";
    case Type::expression:
      return "an expression in a string";
    case Type::expressions:
      return "a list of strings, one expression for each axis";
    case Type::choice:
      return key.choices.size() == 1 ? in_quotes(key.choices[0]) : "one of " + quoted_list(key.choices);
    case Type::choices:
      return "a list of some of " + quoted_list(key.choices);
  }
  return "";
}

std::string_view first_sentence(std::string_view meaning) { return meaning.substr(0, meaning.find(". ")); }

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
    if (key.type == Type::choice && !key.fallback.empty()) fallback = in_quotes(fallback);
    if (key.type == Type::choices && !key.fallback.empty()) fallback = fmt::format("[{}]", fallback);
    const std::string with_text =
        value.empty() && !key.with.empty() ? fmt::format(". It goes with `{}`", key.with) : "";
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

/// What a run can write and draw.
std::string outputs_markdown() {
  std::string text = "\n| file | what |\n| --- | --- |\n";
  for (const write::FileKind& kind : write::output_files())
    text += fmt::format("| `{}` | {} |\n", kind.about.name, kind.about.meaning);
  text += "\n| picture | dimensions | what |\n| --- | --- | --- |\n";
  for (const render::Style& style : render::styles()) {
    const PictureStyle& about = style.about;
    const std::string_view dimensions = !about.shows(3) ? "2" : !about.shows(2) ? "3" : "2 and 3";
    text += fmt::format("| `{}` | {} | {} |\n", about.name, dimensions, about.meaning);
  }
  return text;
}

}  // namespace

std::string registry_markdown() {
  const Key& version = find_key("", "gaussdrift");
  std::string text = fmt::format("`{}` at the top of the file, required: {}.\n", version.name, version.meaning);
  for (const Table& table : tables()) {
    text += fmt::format("\n### `[{}]`\n\n{}.\n", table.name, capital(table.meaning));
    if (table.kinds.size() > 1) {
      std::vector<std::string> kinds;
      for (const auto kind : table.kinds) kinds.push_back(fmt::format("`{}`", kind));
      text += fmt::format("\nEach has exactly one of {}.\n", fmt::join(kinds, ", "));
    }
    text += keys_markdown(table.name, "", "");
    if (table.name == "output") text += outputs_markdown();
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
      "\n### What follows from the keys\n\nThese symbols of the thesis are no keys. The keys set them.\n\n"
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

// Tables of scattered points that [velocity] and [density] name as `samples`.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/number.hpp"
#include "field/samples/sample_fit.hpp"
#include "gaussdrift/error.hpp"
#include "input/data_files.hpp"
#include "input/sample_table.hpp"
#include "input/tables/tables.hpp"

namespace gaussdrift::input {

Key samples_key(const std::string& columns) {
  return {.name = "samples",
          .meaning = "a table (CSV) of scattered points, with the columns " + columns +
                     ". A function is fitted to them by radial basis functions. The path is relative to the case file"};
}

Key kernel_key() {
  return {.name = "kernel",
          .type = Type::choice,
          .choices = sample_kernel_names(),
          .meaning =
              "the radial function that is summed. docs/rbf.md has the formulas. `thin-plate` takes no width. "
              "Without it, `matern52` for up to 2500 samples and `matern32` for more",
          .with = "samples"};
}

Key width_key() {
  return {.name = "width",
          .type = Type::number,
          .fallback = "",
          .range = positive,
          .unit = "length",
          .meaning =
              "width c of the kernel, which docs/rbf.md calls its shape. Without it, it is chosen as `width_by` "
              "says",
          .with = "samples"};
}

Key width_by_key() {
  return {.name = "width_by",
          .type = Type::choice,
          .fallback = "left-out",
          .choices = width_by_names(),
          .meaning =
              "how the width is chosen, where none is given. `left-out`: left-out samples are predicted best. "
              "`likelihood`: the samples are most likely as values of a Gaussian process whose covariance is the "
              "kernel",
          .with = "samples"};
}

Key regularisation_key() {
  return {.name = "regularisation",
          .type = Type::number,
          .fallback = "",
          .range = {0, infinity},
          .meaning =
              "added to the diagonal of the equations, in units of the kernel. Samples with noise need it. With 0, "
              "the default, the function takes every sample",
          .with = "samples"};
}

namespace {

/// A density must be known where particles may start; with `zero` it must not break off there.
void check_border(Reader& in, const SamplesSpec& spec, const SampleTable& table, const Place& place) {
  const SampleFit& fit = *spec.fit;
  const auto d = static_cast<std::size_t>(fit.dimension);
  for (std::size_t k = 0; in.facts.domain_valid && k < d; ++k) {
    const double low = in.facts.box.min[k], high = in.facts.box.max[k];
    const double rounding = 1e-12 * (high - low);
    const bool beyond_low = low<fit.low[k] - rounding, beyond_high = high> fit.high[k] + rounding;
    if (!beyond_low && !beyond_high) continue;
    const std::string reach =
        fmt::format("the samples reach from {} to {} along {}, the domain from {} to {}",
                    base::told_apart(fit.low[k], low), base::told_apart(fit.high[k], high), "xyz"[k],
                    base::told_apart(low, fit.low[k]), base::told_apart(high, fit.high[k]));
    if (spec.outside == "error") {
      in.diagnostics.error(place, reach,
                           "outside = \"zero\" or \"clamp\" says what stands beyond the samples; or make the domain "
                           "smaller");
      return;
    }
    if (spec.outside != "zero") continue;
    double border = 0;  // largest sample within two spacings of a face beyond which the domain goes on
    for (std::size_t i = 0; i < table.values.size(); ++i) {
      const double x = table.positions[i * d + k], near = 3 * fit.report.spacing;
      if ((beyond_low && x < fit.low[k] + near) || (beyond_high && x > fit.high[k] - near))
        border = std::max(border, std::abs(table.values[i]));
    }
    constexpr double telling = 0.01;
    if (border > telling * fit.largest) {
      in.diagnostics.warning(
          place,
          fmt::format("the density breaks off where the samples end: {}, and samples there are up to "
                      "{:.2g}, of {:.2g} at most",
                      reach, border, fit.largest),
          "outside = \"clamp\" continues it; or make the domain smaller, or add samples");
      return;
    }
  }
}

/// Reads the table and fits, at once, so that everything wrong with it has its place in the case file.
void fit(Reader& in, std::string_view table_name, const Value& value, const std::vector<std::string>& names,
         bool divergence_free, SamplesSpec& spec) {
  const int errors_before = in.diagnostics.errors();
  spec.kernel = in.choice(table_name, "kernel");
  spec.outside = in.choice(table_name, "outside");
  SampleFitOptions options{.kernel = spec.kernel, .divergence_free = divergence_free, .threads = in.threads};
  if (const auto width = in.number(table_name, "width")) options.width = width->number;
  options.width_by = in.choice(table_name, "width_by");
  if (const auto lambda = in.number(table_name, "regularisation"))
    spec.regularisation = options.regularisation = lambda->number;
  const auto kernel = rbf::kernel_named(spec.kernel);  // none: the default
  if (const Entry* entry = in.find(table_name, "width"); entry && kernel && !rbf::takes_shape(*kernel))
    in.diagnostics.error(entry->place, fmt::format("kernel = \"{}\" takes no width", spec.kernel), "remove \"width\"");
  if (const Entry* entry = in.find(table_name, "width_by")) {
    if (kernel && !rbf::takes_shape(*kernel))
      in.diagnostics.error(entry->place, fmt::format("kernel = \"{}\" has no width to choose", spec.kernel),
                           "remove \"width_by\"");
    if (options.width > 0)
      in.diagnostics.error(entry->place, "the width is given, so it is not chosen",
                           "remove \"width_by\", or \"width\"");
  }
  if (const Entry* entry = in.find(table_name, "divergence_free");
      entry && divergence_free && kernel && rbf::highest_derivative(*kernel) < 2)
    in.diagnostics.error(entry->place,
                         fmt::format("kernel = \"{}\" has no second derivatives at distance 0, which a field without "
                                     "divergence is made of",
                                     spec.kernel),
                         "take multiquadric or a Matern kernel");
  if (value.kind != Value::Kind::text)
    in.wrong_type(value, in.label_of(find_key(table_name, "samples")), "the name of a file in a string");
  if (!in.facts.dimension || in.diagnostics.errors() > errors_before) return;
  spec.file = find_data_file(in.folder, value.text);
  try {
    const SampleTable table = read_sample_table(spec.file, names, in.facts.dimension,
                                                spec.regularisation > 0 ? Coinciding::allowed : Coinciding::refused);
    try {
      spec.fit =
          std::make_shared<const SampleFit>(fit_samples(in.facts.dimension, table.positions, table.values, options));
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: {}", spec.file.string(), error.what()));
    }
    const rbf::Function& function = spec.fit->report.function;
    spec.kernel = to_string(function.kernel);
    if (rbf::takes_shape(function.kernel)) spec.width = function.shape;
    if (table_name == "density") check_border(in, spec, table, value.place);
  } catch (const Error& error) {
    in.diagnostics.error(value.place, error.what(), where_data_file_was(in.folder, value.text));
  }
}

std::vector<std::string> axes(int dimension) {
  return dimension == 3 ? std::vector<std::string>{"x", "y", "z"} : std::vector<std::string>{"x", "y"};
}

void write_samples(Writer& out, const SamplesSpec& spec) {
  out.entry("samples", out.data_file(spec.file));
  out.entry("kernel", written(spec.kernel));
  if (spec.width > 0) out.entry("width", written(spec.width));
  out.entry("regularisation", written(spec.regularisation));
  out.entry("outside", written(spec.outside));
}

}  // namespace

SamplesDensitySpec sampled_density(Reader& in, const Value& value) {
  SamplesDensitySpec spec;
  std::vector<std::string> names = axes(in.facts.dimension);
  names.emplace_back("rho");
  fit(in, "density", value, names, false, spec);
  return spec;
}

SamplesVelocitySpec sampled_velocity(Reader& in, const Value& value) {
  SamplesVelocitySpec spec;
  spec.divergence_free = in.flag("velocity", "divergence_free");
  std::vector<std::string> names = axes(in.facts.dimension);
  names.insert(names.end(), {"u", "v"});
  if (in.facts.dimension == 3) names.emplace_back("w");
  fit(in, "velocity", value, names, spec.divergence_free, spec);
  return spec;
}

void write_part(Writer& out, const SamplesDensitySpec& spec) { write_samples(out, spec); }

void write_part(Writer& out, const SamplesVelocitySpec& spec) {
  write_samples(out, spec);
  out.entry("divergence_free", spec.divergence_free ? "true" : "false");
}

}  // namespace gaussdrift::input

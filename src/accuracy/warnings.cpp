// What the numbers of a run do not show by themselves.
#include <fmt/format.h>

#include <optional>

#include "accuracy/would_run.hpp"
#include "gaussdrift/accuracy.hpp"
#include "sim/borders/outside.hpp"

namespace gaussdrift {

namespace {

std::string place_text(const Vector& place, int dimension) {
  std::string text;
  for (int k = 0; k < dimension; ++k)
    text += fmt::format("{}{:.4g}", k ? ", " : "(", place[static_cast<std::size_t>(k)]);
  return text + ")";
}

/// Whether gaps between particles are known to be too small to matter in this output. The two particles that are
/// farthest apart may carry next to nothing.
bool gaps_are_small(const RunSummary& summary, const FrameNumbers& numbers, std::optional<double> quadrature) {
  constexpr double small = 0.01;  // of the largest density
  const bool is_last = &numbers == &summary.frames.back().second;
  if (is_last && quadrature && *quadrature < small) return true;
  // What is wrong by less has no such gap. A sample may have missed it.
  return numbers.error && numbers.error->linf < small && numbers.untraced == 0 &&
         numbers.compared >= summary.grid_points;
}

}  // namespace

std::vector<std::string> warnings_of(const Case& spec, const RunSummary& summary, std::optional<double> quadrature) {
  std::vector<std::string> warnings;
  if (spec.evaluate.hermite && summary.transform_achievable > spec.evaluate.tolerance)
    warnings.push_back(fmt::format(
        "evaluate.r, p and n take the place of the tolerance. The error of the sum is at most {:.1e} of max "
        "rho; what was measured of it is in the table of outputs.",
        summary.transform_achievable));
  else if (summary.transform_achievable > spec.evaluate.tolerance)
    warnings.push_back(
        fmt::format("evaluate.tolerance = {:.1e} cannot be promised for these weights. The error of the sum is at most "
                    "{:.1e} of max rho.",
                    spec.evaluate.tolerance, summary.transform_achievable));
  if (!spec.evaluate.hermite && summary.derivatives_achievable > spec.evaluate.tolerance)
    warnings.push_back(
        fmt::format("evaluate.tolerance = {:.1e} cannot be promised for the derivatives of output.fields. The error of "
                    "the sum is at most {:.1e} of the largest value of each.",
                    spec.evaluate.tolerance, summary.derivatives_achievable));
  for (const auto& [time, numbers] : summary.frames)
    if (numbers.stretch > spec.particles.overlap && !gaps_are_small(summary, numbers, quadrature)) {
      const std::string table = accuracy::table_against_gaps(spec);
      warnings.push_back(fmt::format(
          "at t = {:.4g} particles that start as neighbours are up to {:.3g} spacings apart. That is more than the "
          "width "
          "of a blob, {:g} spacings, so blobs no longer overlap there enough and the density may have false gaps and "
          "peaks. Use {}more overlap on a finer lattice.",
          time, numbers.stretch, spec.particles.overlap, table.empty() ? "" : table + ", or "));
      break;
    }
  warnings.insert(warnings.end(), summary.warnings.begin(), summary.warnings.end());
  for (const EffectSummary& effect : summary.effects)
    if (!effect.warning.empty()) warnings.push_back(fmt::format("{}: {}", effect.name, effect.warning));
  if (summary.reference.untraced > 0)
    warnings.push_back(
        fmt::format("the exact density is not known at {} grid points of all outputs (one is {}: {}); the norms of the "
                    "error leave them out",
                    summary.reference.untraced, place_text(summary.reference.first_untraced, spec.domain.dimension),
                    summary.reference.trouble));
  for (const std::string& text : {about_leaving(summary.frames), about_beyond(summary.beyond_at_start)})
    if (!text.empty()) warnings.push_back(text);
  return warnings;
}

}  // namespace gaussdrift

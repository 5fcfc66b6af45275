// The lines and the JSON of `gaussdrift check`.
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "accuracy/forecast.hpp"
#include "accuracy/grouped.hpp"
#include "base/counted.hpp"
#include "base/size_text.hpp"
#include "effect/catalogue.hpp"
#include "reference/reference.hpp"
#include "sim/borders/edges.hpp"
#include "sim/borders/outside.hpp"

namespace gaussdrift::accuracy {

namespace {

std::string effects_text(const std::vector<std::string>& effects) {
  if (effects.empty()) return "transport only";
  std::string text = "transport";
  for (const std::string& effect : effects) text += ", " + effect;
  return text;
}

std::string head_text(const Case& spec, const Forecast& r) {
  const Domain& domain = spec.domain;
  std::string box;
  for (int k = 0; k < domain.dimension; ++k) {
    const auto axis = static_cast<std::size_t>(k);
    box += fmt::format("{}[{:g},{:g}]", k ? "x" : "", domain.min[axis], domain.max[axis]);
  }
  if (domain.on_sphere()) box += fmt::format(" degrees, R = {:.10g}", domain.sphere);
  const std::string divergence = r.solenoidal ? "div u = 0"
                                 : r.largest_divergence <= r.divergence_noise
                                     ? "div u = 0 (sampled)"
                                     : fmt::format("max|div u| = {:.3g} (sampled)", r.largest_divergence);
  std::string text = fmt::format("{}  {}D  {}   {}   max|u| = {:.3g}\n", spec.name, domain.dimension, box, divergence,
                                 r.largest_speed);
  if (!spec.title.empty())
    text += fmt::format("title      {}{}\n", spec.title, spec.cite.empty() ? "" : ", after " + spec.cite);
  if (domain.has_edges()) text += fmt::format("edges      {}\n", edges_text(domain));
  if (domain.coast != AtCoast::refuse) text += fmt::format("coast      {}\n", coast_words(domain.coast));
  return text;
}

std::string particles_text(const Case& spec, const Forecast& r) {
  const std::string_view besides = carried_besides(spec.effects);
  std::string text;
  text += fmt::format("velocity   {}\n", r.velocity);
  for (const std::string& warning : r.step_warnings) text += fmt::format("           {}\n", warning);
  text += fmt::format("density    {}\n", r.initial_density);
  text += fmt::format(
      "particles  {} on the lattice, h = {:.3g}{}, eps = {:g}h = {:.3g}, cutoff {}; {}{} carry weight{}{}\n",
      grouped(r.lattice_points), r.spacing, spec.domain.on_sphere() ? " degrees" : "", spec.particles.overlap,
      r.core_radius, spec.particles.cutoff, r.whole ? "" : "about ", grouped(r.particles),
      besides.empty() ? "" : fmt::format(" or {}", besides), spec.density.empty() ? " in the middle of the run" : "");
  if (!spec.sources.empty())
    text += fmt::format("sources    {} release about {} particles during the run\n", spec.sources.size(),
                        grouped(static_cast<std::size_t>(r.released)));
  if (r.seeding.left_out > 0)
    text += fmt::format(
        "           {} with less than {:g} of the largest weight are left out: {:.1e} of the mass{} "
        "(particles.threshold)\n",
        grouped(r.seeding.left_out), spec.particles.threshold, r.seeding.carried.front().part(),
        besides.empty() ? "" : fmt::format(", {:.1e} of the {}", r.seeding.carried.back().part(), besides));
  if (const std::string beyond = about_beyond(r.beyond_at_start); !beyond.empty())
    text += fmt::format("           {}\n", beyond);
  return text;
}

/// What happens beside transport, what it is compared with, and how the density is summed.
std::string run_text(const Case& spec, const Forecast& r) {
  std::string text;
  text += fmt::format("effects    {}\n", effects_text(r.effects));
  for (const std::string& warning : r.effect_warnings) text += fmt::format("           {}\n", warning);
  if (!r.reference.empty()) text += fmt::format("reference  {}\n", r.reference);
  text += fmt::format("transform  {}\n", r.density.choice);
  text += fmt::format("           asked for {:.1g} of max rho, measured {:.1e} on {} grid points at t = {:g}\n",
                      spec.evaluate.tolerance, r.density.measured_error, r.density.sample, spec.time.start);
  if (spec.evaluate.hermite && r.density.achievable > spec.evaluate.tolerance)
    text += fmt::format("           evaluate.r, p and n take the place of the tolerance: the bound is {:.1e}\n",
                        r.density.achievable);
  else if (r.density.achievable > spec.evaluate.tolerance)
    text +=
        fmt::format("           this tolerance cannot be promised here: the bound is {:.1e}\n", r.density.achievable);
  text += fmt::format("           max rho = {:.6g} on the {}-point grid at t = {:g}\n", r.density_maximum,
                      grouped(r.grid_points), spec.time.start);
  return text;
}

std::string cost_text(const Forecast& r) {
  std::string text;
  text += fmt::format(
      "cost       {} x {}, {} of {}: about {:.2g} s on {} (seeding {:.2g}, steps "
      "{:.2g}, density "
      "{:.2g}, reference {:.2g}, files {:.2g}, pictures {:.2g}, {}report {:.2g}); memory {}; disk {}\n",
      base::counted(grouped(r.steps), "step"), base::counted(grouped(r.particles), "particle"),
      base::counted(r.frames, "frame"), base::counted(grouped(r.grid_points), "point"), r.seconds,
      base::counted(static_cast<std::size_t>(r.threads), "thread"), r.seed_seconds,
      static_cast<double>(r.steps) * r.step_seconds, static_cast<double>(r.frames) * r.evaluate_seconds,
      r.reference_seconds, r.file_seconds, r.picture_seconds,
      r.animation_seconds > 0 ? fmt::format("animation {:.2g}, ", r.animation_seconds) : "", r.report_seconds,
      base::size_text(r.memory_bytes()), base::size_text(r.disk_bytes));
  if (r.memory.all() >= r.memory_limit.left()) {
    const Extent extent{.particles = r.particles_at_most, .grid_points = static_cast<double>(r.grid_points)};
    text += fmt::format("           {} {} of memory, so `run` refuses this case: {}; {}\n", r.memory_limit.who,
                        base::size_text(r.memory_limit.bytes), what_memory_is_for(r.memory, r.program_bytes, extent),
                        how_to_lower(r.memory, r.program_bytes));
  }
  return text;
}

std::string errors_text(const Forecast& r) {
  std::string text;
  for (const std::string& sentence : r.left_out) text += fmt::format("sampled    {}\n", sentence);
  if (r.budget.known() && r.budget.outside >= 1e-3)
    text += fmt::format("leaving    {} of the mass is outside the domain at the last output\n",
                        percent_text(r.budget.outside));
  if (!r.budget.known())
    text += fmt::format("errors     not predicted: {}\n", r.budget.not_covered);
  else
    text += fmt::format("expected error at the end, largest, relative to max rho: {:.2g}\n{}", r.budget.total,
                        to_text(r.budget));
  return text;
}

nlohmann::ordered_json predicted_json(const Forecast& r) {
  nlohmann::ordered_json told{{"seconds", r.seconds},
                              {"seed_seconds", r.seed_seconds},
                              {"step_seconds", static_cast<double>(r.steps) * r.step_seconds},
                              {"density_seconds", static_cast<double>(r.frames) * r.evaluate_seconds},
                              {"reference_seconds", r.reference_seconds},
                              {"file_seconds", r.file_seconds},
                              {"picture_seconds", r.picture_seconds},
                              {"report_seconds", r.report_seconds},
                              {"memory_bytes", r.memory_bytes()},
                              {"disk_bytes", r.disk_bytes},
                              {"threads", r.threads}};
  if (r.animation_seconds > 0) told["animation_seconds"] = r.animation_seconds;
  return told;
}

}  // namespace

std::string to_text(const Case& spec, const Forecast& r) {
  return head_text(spec, r) + particles_text(spec, r) + run_text(spec, r) + cost_text(r) + errors_text(r);
}

std::string to_json(const Case& spec, const Forecast& r) {
  std::vector<std::string> effects{"transport"};
  effects.insert(effects.end(), r.effects.begin(), r.effects.end());
  const nlohmann::ordered_json document{{"case", spec.name},
                                        {"dimension", spec.domain.dimension},
                                        {"velocity", r.velocity},
                                        {"density", r.initial_density},
                                        {"reference", to_string(spec.reference.kind)},
                                        {"reference_paths", r.reference},
                                        {"largest_speed", r.largest_speed},
                                        {"largest_divergence", r.largest_divergence},
                                        {"effects", effects},
                                        {"step_warnings", r.step_warnings},
                                        {"effect_warnings", r.effect_warnings},
                                        {"lattice_points", r.lattice_points},
                                        {"particles", r.particles},
                                        {"left_out", r.seeding.left_out},
                                        {"mass_left_out", r.seeding.carried.front().part()},
                                        {"mass_outside_at_start", r.beyond_at_start},
                                        {"mass_outside_at_end", r.budget.outside},
                                        {"particles_counted", r.whole},
                                        {"lattice_points_looked_at", r.looked_at},
                                        {"spacing", r.spacing},
                                        {"core_radius", r.core_radius},
                                        {"grid_points", r.grid_points},
                                        {"steps", r.steps},
                                        {"frames", r.frames},
                                        {"density_maximum", r.density_maximum},
                                        {"transform",
                                         {{"chosen", r.density.choice},
                                          {"measured_error", r.density.measured_error},
                                          {"achievable", r.density.achievable}}},
                                        {"sampled", r.left_out},
                                        {"budget", to_json(r.budget)},
                                        {"predicted", predicted_json(r)}};
  return document.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace gaussdrift::accuracy

#include "write/summary.hpp"

#include <nlohmann/json.hpp>

#include <cmath>

#include "effect/catalogue.hpp"
#include "reference/reference.hpp"
#include "sim/checks.hpp"

namespace gaussdrift::write {

namespace {

using json = nlohmann::ordered_json;

json number(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

json particles_of(const Case& spec, const RunSummary& summary) {
  json particles{{"lattice_points", summary.lattice_points},
                 {"carried", summary.particles},
                 {"left_out", summary.seeding.left_out},
                 {"threshold", spec.particles.threshold},
                 {"mass_left_out", summary.seeding.carried.front().part()}};
  if (const std::string_view besides = carried_besides(spec.effects); !besides.empty())
    particles[fmt::format("{}_left_out", besides)] = summary.seeding.carried.back().part();
  if (summary.beyond_at_start > 0) particles["mass_outside_at_start"] = summary.beyond_at_start;
  particles["spacing"] = summary.spacing;
  particles["core_radius"] = summary.core_radius;
  particles["cutoff"] = spec.particles.cutoff;
  return particles;
}

json effects_of(const RunSummary& summary) {
  json effects = json::array();
  for (const EffectSummary& effect : summary.effects) {
    json row{{"name", effect.name},
             {"seconds", effect.seconds},
             {"equation", effect.equation},
             {"changes", effect.changes},
             {"conserves", effect.conserves}};
    for (const auto& [name, value] : effect.numbers) row[name] = value;
    if (!effect.warning.empty()) row["warning"] = effect.warning;
    effects.push_back(std::move(row));
  }
  return effects;
}

json reference_of(const Case& spec, const RunSummary& summary) {
  json reference{{"kind", to_string(spec.reference.kind)}};
  if (spec.reference.kind != ReferenceSpec::Kind::none) reference["untraced"] = summary.reference.untraced;
  if (!summary.reference_word.empty()) reference["paths"] = summary.reference_word;
  if (summary.reference.untraced > 0) reference["trouble"] = summary.reference.trouble;
  return reference;
}

json checks_of(const RunSummary& summary) {
  json checks = json::array();
  for (const CheckResult& result : summary.checks) {
    checks.push_back({{"what", to_string(result.check.what)},
                      {"value", number(result.value)},
                      {"t", result.time},
                      {"max", result.check.max ? json(*result.check.max) : json(nullptr)},
                      {"min", result.check.min ? json(*result.check.min) : json(nullptr)},
                      {"passed", result.passed}});
    if (!result.check.by.empty()) checks.back()["by"] = result.check.by;
    if (!result.check.tracer.empty()) checks.back()["tracer"] = result.check.tracer;
  }
  return checks;
}

json seconds_of(const RunSummary& summary) {
  json seconds = json::object();
  for (const auto& [stage, value] : summary.stages.stages()) seconds[stage] = value;
  seconds["total"] = summary.seconds;
  return seconds;
}

json frames_of(const Case& spec, const RunSummary& summary) {
  json frames = json::array();
  for (const auto& [time, n] : summary.frames) {
    json centroid = json::array();
    for (int k = 0; k < spec.domain.dimension; ++k) centroid.push_back(n.centroid[static_cast<std::size_t>(k)]);
    frames.push_back({{"t", time},
                      {"mass", n.mass},
                      {"minimum", n.minimum},
                      {"maximum", n.maximum},
                      {"centroid", centroid},
                      {"outside", n.outside},
                      {"transform_error", n.transform_error},
                      {"evaluate_seconds", n.evaluate_seconds}});
    if (spec.time.date) frames.back()["date"] = spec.time.date(time);
    if (n.inside) frames.back()["inside"] = *n.inside;
    if (n.released) frames.back()["released"] = *n.released;
    if (n.decayed) frames.back()["decayed"] = *n.decayed;
    if (n.stopped) frames.back()["stopped"] = {{"particles", n.stopped->particles}, {"mass", n.stopped->mass}};
    for (const Departed& departed : n.left)
      frames.back()["left"][departed.reason] = {{"particles", departed.particles}, {"mass", departed.mass}};
    for (const TracerNumbers& tracer : n.tracers) {
      json& row = frames.back()["tracers"][tracer.name];
      row = {{"mass", tracer.mass}, {"minimum", tracer.minimum}, {"maximum", tracer.maximum}};
      if (tracer.released) row["released"] = *tracer.released;
      if (tracer.reacted) row["reacted"] = *tracer.reacted;
      if (tracer.left) row["left"] = *tracer.left;
      if (tracer.error) {
        row["L1"] = number(tracer.error->l1);
        row["L2"] = number(tracer.error->l2);
        row["Linf"] = number(tracer.error->linf);
      }
    }
    if (n.stretch > 0) frames.back()["stretch"] = n.stretch;
    if (n.error) {
      frames.back()["L1"] = number(n.error->l1);
      frames.back()["L2"] = number(n.error->l2);
      frames.back()["Linf"] = number(n.error->linf);
      frames.back()["compared"] = n.compared;
      frames.back()["untraced"] = n.untraced;
      if (!n.no_norms.empty()) frames.back()["no_norms"] = n.no_norms;
    }
  }
  return frames;
}

}  // namespace

std::string summary_json(const Case& spec, const RunSummary& summary, const json& more) {
  json document{
      {"case", spec.name},
      {"title", spec.title},
      {"label", spec.label},
      {"complete", summary.complete},
      {"effects", effects_of(summary)},
      {"particles", particles_of(spec, summary)},
      {"time",
       {{"start", spec.time.start},
        {"method", spec.time.method},
        {"step", spec.time.step},
        {"end", spec.time.at(spec.time.end)},
        {"reached", summary.time},
        {"steps", summary.steps},
        {"steps_rejected", summary.steps_rejected}}},
      {"evaluate",
       {{"grid_points", summary.grid_points},
        {"tolerance", summary.transform_tolerance},
        {"achievable", summary.transform_achievable},
        {"chosen", summary.transform_choice}}},
      {"reference", reference_of(spec, summary)},
      {"checks", checks_of(summary)},
      {"threads", summary.threads},
      {"seconds", seconds_of(summary)},
      {"frames", frames_of(spec, summary)},
  };
  if (summary.derivatives_achievable > 0)
    document["evaluate"]["derivatives"] = {{"achievable", summary.derivatives_achievable},
                                           {"transform_error", summary.derivatives_error}};
  if (const auto* worst = worst_output(summary.frames)) {
    const ErrorNorms& error = *worst->second.error;
    document["worst"] = {{"t", worst->first}, {"L1", error.l1}, {"L2", error.l2}, {"Linf", error.linf}};
  }
  for (const auto& [key, value] : more.items()) document[key] = value;
  return document.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

}  // namespace gaussdrift::write

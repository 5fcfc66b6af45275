#include "study/describe.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "base/stopwatch.hpp"
#include "sim/outside.hpp"
#include "sim/simulation.hpp"
#include "time/schedule.hpp"

namespace gaussdrift::study {

namespace {

// Up to this many particles, evenly spread over the list, stand for all when fields are sampled.
constexpr std::size_t sampled_particles = 2000;

Particles sample_of(const Particles& all) {
  Particles some;
  some.dimension = all.dimension;
  const std::size_t wanted = std::min(sampled_particles, all.size());
  for (std::size_t i = 0; i < wanted; ++i) {
    const std::size_t j = i * all.size() / wanted;
    for (int k = 0; k < all.dimension; ++k) some.position[k].push_back(all.position[k][j]);
    some.alpha.push_back(all.alpha[j]);
    some.id.push_back(all.id[j]);
  }
  return some;
}

using Columns = std::array<std::vector<double>, max_dimension>;

Columns velocity_at(const VelocityField& field, double t, const Particles& particles) {
  Columns u;
  VectorsView view{particles.dimension, particles.size(), {}};
  for (int k = 0; k < particles.dimension; ++k) {
    u[k].assign(particles.size(), 0.0);
    view.axis[k] = u[k].data();
  }
  field.add(t, particles.view(), view);
  return u;
}

void sample_field(const Scene& scene, const Particles& particles, double end, Description& result) {
  Particles sample = sample_of(particles);
  for (const double t : {0.0, 0.5 * end, end}) {
    const Columns u = velocity_at(*scene.velocity, t, sample);
    for (std::size_t j = 0; j < sample.size(); ++j) {
      double square = 0;
      for (int k = 0; k < sample.dimension; ++k) square += u[k][j] * u[k][j];
      if (!std::isfinite(square)) {
        if (t > 0) continue;  // particles will have moved by then; the run itself watches them
        std::string place;
        Vector x{};
        for (int k = 0; k < sample.dimension; ++k) {
          x[k] = sample.position[k][j];
          place += fmt::format("{}{:.6g}", k ? ", " : "", x[k]);
        }
        const std::string reason = scene.velocity->why_not_finite(t, x);
        throw NumericalError(fmt::format("the velocity is not finite at t = {:.6g}, ({}); {}", t, place,
                                         reason.empty() ? "guard the expression or move the density" : reason));
      }
      result.largest_speed = std::max(result.largest_speed, std::sqrt(square));
    }
    std::vector<double> divergence(sample.size(), 0.0);
    scene.velocity->add_divergence(t, sample.view(), divergence.data());
    for (const double value : divergence)
      result.largest_divergence = std::max(result.largest_divergence, std::abs(value));
  }
  result.solenoidal = scene.velocity->is_solenoidal();
  result.divergence_noise = 1e3 * std::numeric_limits<double>::epsilon() * result.largest_speed / scene.core_radius;
}

// Seconds a step, from a few steps of a copy that is thrown away.
double time_steps(const Case& description, Carrier& carrier, const Particles& particles) {
  if (description.time.end <= 0) return 0;
  const time::Interval interval(0, description.time.end, description.time.step);
  base::StageTimes ignored;
  Particles copy = particles;
  // The fastest of several batches: the first pay for starting threads, and other programs may disturb any of them.
  double fastest = std::numeric_limits<double>::infinity();
  std::size_t taken = 0;
  const base::Stopwatch watch;
  for (std::size_t count = 1; taken < interval.steps() && watch.seconds() < 0.05; count *= 2) {
    count = std::min(count, interval.steps() - taken);
    const base::Stopwatch batch;
    carrier.advance(copy, interval, taken, count, 0, ignored);
    fastest = std::min(fastest, batch.seconds() / static_cast<double>(count));
    taken += count;
  }
  return fastest;
}

// Seconds of the reference of all outputs, from tracing some points spread over the grid to the last one.
double time_reference(const Case& description, const Scene& scene, const Comparison& compared, int threads) {
  const std::size_t all = compared.points;
  if (all == 0) return 0;
  const auto reference = make_reference(description, scene, threads, compared.following);
  const auto& times = description.output.times;
  const std::size_t most = has_smooth_paths(scene) ? 2048 : 24;
  std::vector<std::size_t> points;
  for (std::size_t i = 0; i < std::min(all, most); ++i)
    points.push_back(
        static_cast<std::size_t>((static_cast<double>(i) + 0.5) / static_cast<double>(std::min(all, most)) *
                                 static_cast<double>(scene.evaluation.size())));
  std::vector<double> rho;
  const base::Stopwatch watch;
  reference->evaluate_at(times.back(), points, rho);
  double outputs = 1;  // in units of the last one: a flow that depends on t is traced to the start for each
  if (description.reference.kind == ReferenceSpec::Kind::exact)
    outputs = static_cast<double>(times.size());
  else if ((!scene.velocity->is_steady() || all < scene.evaluation.size()) && times.back() > 0)
    outputs = std::accumulate(times.begin(), times.end(), 0.0) / times.back();
  return watch.seconds() * outputs * static_cast<double>(all) / static_cast<double>(points.size());
}

// Steps that a method will choose, and seconds a step, from a trial with a sample of the particles that stops after a
// while and is extrapolated.
void predict_chosen_steps(const Case& description, const Scene& scene, const Particles& particles, int threads,
                          Description& result) {
  Case transport = description;
  transport.effects = {};
  Carrier trial(transport, scene, threads);
  Particles sample = sample_of(particles);
  base::StageTimes ignored;
  const base::Stopwatch watch;
  const double end = description.time.end;
  double now = 0;
  constexpr int pieces = 20;  // of the run, so that a long one can be left early; each costs at most a step
  for (int i = 1; i <= pieces && watch.seconds() < 0.2 && now < end; ++i) {
    const double to = i == pieces ? end : end * i / pieces;
    result.steps += trial.carry(sample, now, to, result.steps, ignored, [](double, std::size_t) {});
    now = to;
  }
  if (now <= 0) return;
  result.step_seconds = watch.seconds() / static_cast<double>(std::max<std::size_t>(1, result.steps)) *
                        static_cast<double>(particles.size()) / static_cast<double>(sample.size());
  result.steps = static_cast<std::size_t>(std::ceil(static_cast<double>(result.steps) * end / now));
}

bool wants(const Case& scene, OutputSpec::Vtk kind) {
  return std::find(scene.output.vtk.begin(), scene.output.vtk.end(), kind) != scene.output.vtk.end();
}

std::string grouped(std::size_t number) {
  std::string digits = std::to_string(number), text;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) text += ' ';
    text += digits[i];
  }
  return text;
}

std::string bytes_text(double bytes) {
  if (bytes < 1e6) return fmt::format("{:.0f} kB", bytes / 1e3);
  if (bytes < 1e9) return fmt::format("{:.3g} MB", bytes / 1e6);
  return fmt::format("{:.3g} GB", bytes / 1e9);
}

std::string effects_text(const std::vector<std::string>& effects) {
  if (effects.empty()) return "transport only";
  std::string text = "transport";
  for (const std::string& effect : effects) text += ", " + effect;
  return text;
}

}  // namespace

Description describe(const Case& description, int threads) {
  Description result;
  result.threads = base::resolve_threads(threads);
  const Scene scene = make_scene(description);
  Particles particles = seed_scene(scene, threads, &result.seeding);
  result.beyond_at_start = part_beyond(scene.density->mass(), particles, scene.seeding);
  Carrier carrier(description, scene, threads);
  carrier.begin(particles);
  result.step_warnings = carrier.warnings();
  for (const auto& effect : carrier.effects()) {
    result.effects.push_back(effect->describe());
    if (const std::string warning = effect->warning(); !warning.empty()) result.effect_warnings.push_back(warning);
  }
  result.velocity = scene.velocity->describe();
  result.initial_density = scene.density->describe();
  result.lattice_points = scene.seeding.size();
  result.particles = particles.size();
  result.grid_points = scene.evaluation.size();
  result.steps = total_steps(description);
  result.frames = description.output.times.size();
  result.spacing = scene.seeding.spacing;
  result.core_radius = scene.core_radius;
  sample_field(scene, particles, description.time.end, result);

  DensityOptions options;
  options.tolerance = description.evaluate.tolerance;
  options.method = description.evaluate.method;
  options.threads = threads;
  const DensityGrid density = evaluate_density(particles, scene.cutoff, scene.evaluation, options, &result.density);
  result.density_maximum = *std::max_element(density.rho.begin(), density.rho.end());
  if (carrier.is_adaptive())
    predict_chosen_steps(description, scene, particles, threads, result);
  else
    result.step_seconds = time_steps(description, carrier, particles);
  const Comparison plan = plan_comparison(description, scene, particles.size(), threads);
  const std::size_t compared_points = plan.points;
  result.reference = plan.left_out.empty() ? plan.word : plan.left_out;
  result.reference_seconds = time_reference(description, scene, plan, threads);
  result.evaluate_seconds = result.density.evaluate_seconds + result.density.measure_seconds;

  const auto pictures = static_cast<double>(description.output.images.size() * result.frames);
  result.picture_seconds =
      pictures > 0 ? 0.4 + 0.13 * pictures : 0;  // start of the renderer, and a picture, on two cores
  const auto frames = static_cast<double>(result.frames), n = static_cast<double>(result.particles),
             m = static_cast<double>(result.grid_points), d = static_cast<double>(description.domain.dimension);
  result.seconds = static_cast<double>(result.steps) * result.step_seconds + frames * result.evaluate_seconds +
                   result.reference_seconds + result.picture_seconds;
  // Positions, weights, ids, a stepped copy, the sorted copy of the transform; density, its transform's result and
  // sample.
  result.memory_bytes = n * 8 * (4 * d + 6) + m * 8 * 3 + (pictures > 0 ? 3e8 + frames * m * 4 : 0);
  // Numbers are written as base64, four letters for three bytes; with the error beside rho, three arrays instead of
  // one.
  constexpr double base64 = 4. / 3;
  const bool compared = compared_points >= result.grid_points;
  if (wants(description, OutputSpec::Vtk::density))
    result.disk_bytes += frames * (base64 * 8 * m * (compared ? 3 : 1) + 1500);
  if (wants(description, OutputSpec::Vtk::particles)) result.disk_bytes += frames * (base64 * 8 * n * 9 + 2500);
  result.disk_bytes += pictures * 8e4;
  if (description.output.report) result.disk_bytes += 5e4 + (pictures > 0 ? 5e5 : 0);  // the page and its picture
  result.budget = predict_budget(description, scene, Effort::whatever, threads);
  return result;
}

std::string to_text(const Case& scene, const Description& r) {
  const Domain& domain = scene.domain;
  std::string box, grid_shape;
  for (int k = 0; k < domain.dimension; ++k) {
    const auto axis = static_cast<std::size_t>(k);
    box += fmt::format("{}[{:g},{:g}]", k ? "x" : "", domain.min[axis], domain.max[axis]);
  }
  const std::string divergence = r.solenoidal ? "div u = 0"
                                 : r.largest_divergence <= r.divergence_noise
                                     ? "div u = 0 (sampled)"
                                     : fmt::format("max|div u| = {:.3g} (sampled)", r.largest_divergence);
  std::string text = fmt::format("{}  {}D  {}   {}   max|u| = {:.3g}\n", scene.name, domain.dimension, box, divergence,
                                 r.largest_speed);
  if (!scene.title.empty())
    text += fmt::format("title      {}{}\n", scene.title, scene.cite.empty() ? "" : ", after " + scene.cite);
  text += fmt::format("velocity   {}\n", r.velocity);
  for (const std::string& warning : r.step_warnings) text += fmt::format("           {}\n", warning);
  text += fmt::format("density    {}\n", r.initial_density);
  text += fmt::format("particles  {} on the lattice, h = {:.3g}, eps = {:g}h = {:.3g}, cutoff {}; {} carry weight{}\n",
                      grouped(r.lattice_points), r.spacing, scene.particles.overlap, r.core_radius,
                      scene.particles.cutoff, grouped(r.particles), r.seeding.carried.size() > 1 ? " or charge" : "");
  if (r.seeding.left_out > 0)
    text += fmt::format(
        "           {} with less than {:g} of the largest weight are left out: {:.1e} of the mass{} "
        "(particles.threshold)\n",
        grouped(r.seeding.left_out), scene.particles.threshold, r.seeding.carried.front().part(),
        r.seeding.carried.size() > 1 ? fmt::format(", {:.1e} of the charge", r.seeding.carried.back().part()) : "");
  if (const std::string beyond = about_beyond(r.beyond_at_start); !beyond.empty())
    text += fmt::format("           {}\n", beyond);
  text += fmt::format("effects    {}\n", effects_text(r.effects));
  for (const std::string& warning : r.effect_warnings) text += fmt::format("           {}\n", warning);
  if (!r.reference.empty()) text += fmt::format("reference  {}\n", r.reference);
  text += fmt::format("transform  {}\n", r.density.choice);
  text += fmt::format("           asked for {:.1g} of max rho, measured {:.1e} on {} grid points at t = 0\n",
                      scene.evaluate.tolerance, r.density.measured_error, r.density.sample);
  if (r.density.achievable > scene.evaluate.tolerance)
    text +=
        fmt::format("           this tolerance cannot be promised here: the bound is {:.1e}\n", r.density.achievable);
  text += fmt::format("           max rho = {:.6g} on the {}-point grid at t = 0\n", r.density_maximum,
                      grouped(r.grid_points));
  text += fmt::format(
      "cost       {} steps x {} particles, {} frames of {} points: about {:.2g} s on {} threads (steps {:.2g}, density "
      "{:.2g}, reference {:.2g}, pictures {:.2g}); memory {}; disk {}\n",
      grouped(r.steps), grouped(r.particles), r.frames, grouped(r.grid_points), r.seconds, r.threads,
      static_cast<double>(r.steps) * r.step_seconds, static_cast<double>(r.frames) * r.evaluate_seconds,
      r.reference_seconds, r.picture_seconds, bytes_text(r.memory_bytes), bytes_text(r.disk_bytes));
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

std::string to_json(const Case& scene, const Description& r) {
  std::vector<std::string> effects{"transport"};
  effects.insert(effects.end(), r.effects.begin(), r.effects.end());
  const nlohmann::ordered_json document{{"case", scene.name},
                                        {"dimension", scene.domain.dimension},
                                        {"velocity", r.velocity},
                                        {"density", r.initial_density},
                                        {"reference", to_string(scene.reference.kind)},
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
                                        {"budget", to_json(r.budget)},
                                        {"predicted",
                                         {{"seconds", r.seconds},
                                          {"reference_seconds", r.reference_seconds},
                                          {"memory_bytes", r.memory_bytes},
                                          {"disk_bytes", r.disk_bytes},
                                          {"threads", r.threads}}}};
  return document.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace gaussdrift::study

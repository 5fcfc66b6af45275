#include "sim/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <span>

#include "effect/catalogue.hpp"
#include "gaussdrift/error.hpp"
#include "particle/seeding.hpp"
#include "sim/borders/edges.hpp"
#include "sim/make_fields.hpp"

namespace gaussdrift {

namespace {

/// What depends on the time of the clock as rates do. Nothing that has one is turned round.
std::unique_ptr<ScalarField> coefficient_of(const NamedEffect& effect, const EffectSpec& values, const Case& spec) {
  if (values.file) return make_rate(spec, *values.file);
  return effect.field.empty() || !values.has(effect.field) ? nullptr : make_rate(spec, values.text(effect.field));
}

void make_effect_fields(const Case& spec, Scene& scene) {
  std::vector<std::unique_ptr<ScalarField>> decays;
  for (const auto& [effect, values] : effects_of(spec.effects)) {
    const auto field_of = [&, &values = values](std::string_view key) -> std::unique_ptr<ScalarField> {
      if (key.empty() || !values.has(key)) return nullptr;
      return make_scalar(spec, values.text(key));
    };
    const auto decay_of = [&, &effect = effect, &values = values]() -> std::unique_ptr<ScalarField> {
      if (!effect->half_life.empty() && values.has(effect->half_life))
        return make_rate(spec, fmt::format("{}", std::numbers::ln2 / values.number(effect->half_life)));
      if (effect->decay_rate.empty() || !values.has(effect->decay_rate)) return nullptr;
      return make_rate(spec, values.text(effect->decay_rate));
    };
    if (auto decay = decay_of()) decays.push_back(std::move(decay));
    scene.effect_fields.push_back({values.name, decay_of(), field_of(effect->carried),
                                   coefficient_of(*effect, values, spec),
                                   fmt::format("effects.{}.{}", values.name, effect->carried)});
  }
  if (decays.size() == 1) scene.decay_rate = std::move(decays.front());
  if (decays.size() > 1) scene.decay_rate = std::make_unique<SumOfScalars>(std::move(decays));
}

}  // namespace

Cutoff blob_of(const Scene& scene, const Particles& particles, double part) {
  const double spread = particles.spread * part;
  if (!(spread > 0)) return scene.cutoff;
  if (!scene.spreading_shape) return spread_cutoff(scene.cutoff, particles.dimension, spread);
  return spread_cutoff(scene.cutoff, particles.dimension, spread, *scene.spreading_shape);
}

Lattice evaluation_lattice(const Case& spec) {
  const Domain& domain = spec.domain;
  Lattice lattice = spec.evaluate.spacing > 0
                        ? make_lattice_with_spacing(domain.dimension, domain.min, domain.max, spec.evaluate.spacing)
                        : make_lattice(domain.dimension, domain.min, domain.max, spec.evaluate.per_axis);
  lattice.sphere = domain.sphere;
  return lattice;
}

void set_blob(const ParticleSpec& particles, Scene& scene) {
  const Lattice& lattice = scene.seeding;
  scene.core_radius = particles.overlap * lattice.spacing * lattice.unit();
  scene.cutoff = on_sphere(
      make_cutoff(particles.cutoff, lattice.dimension, scene.core_radius, particles.cutoff_arguments), lattice.sphere);
}

Cutoff other_cutoff(const Scene& scene, std::string_view name) {
  return on_sphere(make_cutoff(name, scene.seeding.dimension, scene.core_radius), scene.seeding.sphere);
}

Scene make_scene(const Case& spec, int threads) {
  Scene scene;
  const Domain& domain = spec.domain;
  scene.starts_empty = spec.density.empty();
  scene.velocity = make_velocity(spec, threads, &scene.misfits);
  scene.density = make_density(spec);
  for (const TracerSpec& tracer : spec.tracers) scene.tracers.push_back(make_density(spec, tracer));
  if (auto coast = std::make_unique<Coast>(spec); coast->exists()) scene.coast = std::move(coast);
  make_effect_fields(spec, scene);
  scene.threshold = spec.particles.threshold;
  scene.seeding = seeding_lattice(domain, spec.particles.per_axis);
  scene.evaluation = evaluation_lattice(spec);
  set_blob(spec.particles, scene);
  scene.spreading_shape = spreading_shape(spec.effects, domain.dimension);
  scene.spreading_of_tracers = spreading_of_tracers(spec);
  return scene;
}

bool has_smooth_paths(const Scene& scene) {
  return scene.velocity->is_smooth() && (!scene.decay_rate || scene.decay_rate->is_smooth());
}

Particles seed_lattice(const Scene& scene, const Lattice& lattice, int threads, SeedReport* report) {
  base::Communicator alone;
  return seed_lattice(scene, lattice, threads, report, alone);
}

Particles seed_lattice(const Scene& scene, const Lattice& lattice, int threads, SeedReport* report,
                       base::Communicator& ranks) {
  std::vector<Carried> carried{
      {"the initial density", [&](const PointsView& x, double* values) { scene.density->add(x, values); }}};
  for (const auto& tracer : scene.tracers)
    carried.push_back({"a named density",
                       [&density = *tracer](const PointsView& x, double* values) { density.add(x, values); }, true});
  for (const EffectFields& fields : scene.effect_fields)
    if (fields.carried)
      carried.push_back(
          {fields.carried_key, [&](const PointsView& x, double* values) { fields.carried->add(0, x, values); }});
  return seed(lattice, carried, scene.threshold, threads, report, ranks);
}

Particles seed_scene(const Scene& scene, int threads, SeedReport* report) {
  base::Communicator alone;
  return seed_scene(scene, threads, report, alone);
}

Particles seed_scene(const Scene& scene, int threads, SeedReport* report, base::Communicator& ranks) {
  Particles particles = seed_lattice(scene, scene.seeding, threads, report, ranks);
  std::int64_t some =
      std::any_of(particles.alpha.begin(), particles.alpha.end(), [](double alpha) { return alpha != 0; });
  ranks.max(std::span(&some, 1));
  if (!some && !scene.starts_empty)
    throw InputError(
        "the initial density is 0 on every point of the particle lattice, so there is nothing to carry; move or "
        "enlarge "
        "the density, or raise particles.per_axis");
  return particles;
}

double density_left_out(const Scene& scene, const SeedReport& report) {
  return report.carried.front().left_out * peak(scene.cutoff);
}

}  // namespace gaussdrift

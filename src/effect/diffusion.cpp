// [effects.diffusion]: its keys, and its two methods, core_spreading.hpp and particle_exchange.hpp.
#include <fmt/format.h>

#include <cmath>

#include "effect/catalogue.hpp"
#include "effect/core_spreading.hpp"
#include "effect/particle_exchange.hpp"

namespace gaussdrift::named {

namespace {

constexpr std::string_view particle_exchange = "particle-exchange";
constexpr std::string_view by_spreading = "`method = \"core-spreading\"`",
                           spreading_instead = "method = \"core-spreading\"";

constexpr std::string_view asked_for = "[effects.diffusion] with the coefficient D";

bool exchanges(const EffectSpec& effect, int /*dimension*/) { return effect.text("method") == particle_exchange; }

std::vector<NamedChoice> methods() {
  return {{"core-spreading",
           "widens the blobs: eps(t)^2 = eps^2 + 4 D t. It is exact where the flow does not strain, and a warning says "
           "how much it does"},
          {particle_exchange,
           "moves weight between neighbours. Its error is of order eps^2 in any flow, and its steps are at most about "
           "eps^2 / (2 D)"}};
}

std::vector<Complaint> problems(const EffectSpec& effect, const Case& spec) {
  if (!exchanges(effect, spec.domain.dimension) || spec.particles.overlap >= 1) return {};
  return {{.key = "method",
           .message = fmt::format("{} needs particles.overlap of at least 1, found {}", particle_exchange,
                                  spec.particles.overlap),
           .remedy = "below, the sum over neighbours is no Laplacian; 2 is usual"}};
}

double spreading(const EffectSpec& effect) { return 4 * effect.number("D"); }

/// Nodes of the halo that are looked at around a particle at the rim, and three sums over the particles.
double work(const EffectSpec& effect, const Case& spec) {
  if (!exchanges(effect, spec.domain.dimension)) return 0;
  const double halo = 2 * spec.particles.overlap * std::sqrt(std::log(1 / effect.number("tolerance"))) + 1;
  return 0.2 * std::pow(halo, spec.domain.dimension) + 60;
}

/// The volumes, the table of nodes with particles, and what three sums hold.
EffectMemory memory(const EffectSpec& effect, int dimension) {
  if (!exchanges(effect, dimension)) return {};
  return {.integrals = 1, .columns = 1, .kept = 60, .step = 26 * sizeof(double)};
}

/// D / eps^2 stays.
void coarsen(EffectSpec& effect, double times) { effect.set("D", effect.number("D") * times * times); }

/// Another effect of the case puts what has spread into the weights of new blobs.
bool blobs_are_renewed(const Case& spec) {
  for (const auto& [effect, written] : effects_of(spec.effects))
    if (effect->traits.restores_overlap) return true;
  return false;
}

std::unique_ptr<Effect> make(const EffectSpec& effect, const EffectScene& scene) {
  const double coefficient = effect.number("D");
  if (!exchanges(effect, scene.spec.domain.dimension))
    return std::make_unique<CoreSpreading>(coefficient, scene.velocity, scene.spec.time.end, scene.distance,
                                           blobs_are_renewed(scene.spec));
  ParticleExchange::Options options{
      .coefficient = coefficient, .tolerance = effect.number("tolerance"), .threads = scene.threads};
  options.tiles.particles = scene.spec.evaluate.tile_particles > 0
                                ? static_cast<std::int64_t>(scene.spec.evaluate.tile_particles)
                                : usual_tiles(scene.spec.domain.dimension).particles;
  return std::make_unique<ParticleExchange>(scene.seeding, scene.core_radius, scene.velocity, scene.follow, options,
                                            scene.ranks);
}

}  // namespace

NamedEffect diffusion() {
  return {
      .about =
          NamedFormula{
              .name = "diffusion",
              .meaning =
                  "the density diffuses: d_t rho + div(rho u) = D Laplacian rho. `reference.kind` is then `none`, "
                  "unless it is `exact`",
              .parameters = {{.name = "D",
                              .range = positive,
                              .unit = "length^2 / time",
                              .symbol = "D",
                              .meaning = "coefficient of diffusion, constant in space and time"},
                             {.name = "method",
                              .kind = NamedParameter::Kind::choice,
                              .fallback = "core-spreading",
                              .meaning = "how the density diffuses",
                              .choices = methods},
                             {.name = "tolerance",
                              .fallback = "1e-06",
                              .range = {1e-10, 0.1},
                              .meaning =
                                  "for `method = \"particle-exchange\"`: a particle with more than this part of the "
                                  "largest density is surrounded with others, which receive what diffuses",
                              .with = "method",
                              .value = particle_exchange}}},
      .traits = {.adds_particles = {.words = "particle-exchange adds particles during the run",
                                    .unless = by_spreading,
                                    .remedy = spreading_instead,
                                    .holds = exchanges},
                 .moves_weight = {.words = "diffusion moves weight between particles"},
                 .needs_fixed_steps = {.words = "method = \"particle-exchange\"",
                                       .remedy = "a step of at most about eps^2 / (2 D)",
                                       .holds = exchanges},
                 .diffuses = true,
                 .irreversible = {.words = "diffusion cannot be undone: what was there before is lost in it, and small "
                                           "errors would grow without bound"}},
      .elsewhere = {{"diffusivity", asked_for}, {"viscosity", asked_for}, {"nu", asked_for}, {"kappa", asked_for}},
      .problems = problems,
      .spreading = spreading,
      .work = work,
      .memory = memory,
      .coarsen = coarsen,
      .make = make};
}

}  // namespace gaussdrift::named

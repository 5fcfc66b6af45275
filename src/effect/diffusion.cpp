// [effects.diffusion]: its keys, and its three methods, core_spreading.hpp, particle_exchange.hpp and random_walk.hpp.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "effect/catalogue.hpp"
#include "effect/core_spreading.hpp"
#include "effect/diffusivity.hpp"
#include "effect/particle_exchange.hpp"
#include "effect/random_walk.hpp"

namespace gaussdrift::named {

namespace {

constexpr std::string_view core_spreading = "core-spreading", particle_exchange = "particle-exchange",
                           random_walk = "random-walk";
constexpr std::string_view no_exchange = "`method = \"core-spreading\"` or `\"random-walk\"`",
                           no_exchange_instead = "method = \"core-spreading\" or \"random-walk\"",
                           walk_instead = "method = \"random-walk\"", a_walk = "`method = \"random-walk\"`";

constexpr std::string_view asked_for = "[effects.diffusion] with the coefficient D";

/// Keys that say what D is, and those that go with a matrix.
constexpr std::array<std::string_view, 4> coefficients{"D", "D_axes", "D_field", "file"};
constexpr std::array<std::string_view, 3> mixed{"D_xy", "D_xz", "D_yz"};

bool exchanges(const EffectSpec& effect, int /*dimension*/) { return effect.text("method") == particle_exchange; }
bool spreads(const EffectSpec& effect, int /*dimension*/) { return effect.text("method") == core_spreading; }
bool walks(const EffectSpec& effect, int /*dimension*/) { return effect.text("method") == random_walk; }
bool steps_are_known(const EffectSpec& effect, int /*dimension*/) { return effect.text("method") != core_spreading; }

bool has_mixed(const EffectSpec& effect) {
  return std::any_of(mixed.begin(), mixed.end(),
                     [&](std::string_view key) { return effect.has(key) && effect.number(key) != 0; });
}

/// The constant coefficient, whose keys say how many axes there are.
Tensor constant_of(const EffectSpec& effect) {
  const int dimension = effect.has("D_axes") ? static_cast<int>(effect.point("D_axes").size()) : max_dimension;
  return constant_diffusivity(effect, dimension).value_or(Tensor{});
}

bool is_even(const EffectSpec& effect, int dimension) {
  if (!effect.has("D_axes")) return true;
  const PrincipalValues values = principal_values(constant_of(effect), dimension);
  return values.least == values.largest && !has_mixed(effect);
}

bool makes_ellipses(const EffectSpec& effect, int dimension) {
  return spreads(effect, dimension) && !is_even(effect, dimension);
}

std::vector<NamedChoice> methods() {
  return {
      {core_spreading,
       "widens the blobs: eps(t)^2 = eps^2 + 4 D t. It is exact where the flow does not strain, and a warning says "
       "how much it does. D is constant, and may differ along the axes"},
      {particle_exchange,
       "moves weight between neighbours. Its error is of order eps^2 in any flow, and its steps are at most about "
       "eps^2 / (2 D). D may be a field"},
      {random_walk,
       "moves every particle by chance. It goes with any D, flow, edge and coast, and its error falls with the root "
       "of the number of particles that share a blob"}};
}

/// What is wrong with the keys that say what D is.
void check_coefficient(const EffectSpec& effect, int dimension, std::vector<Complaint>& found) {
  std::vector<std::string_view> given;
  for (const std::string_view key : coefficients)
    if (effect.has(key)) given.push_back(key);
  const std::string known = fmt::format("\"{}\"", fmt::join(coefficients, "\", \""));
  if (given.empty())
    found.push_back({"D", fmt::format("has none of {}", known), "give one of them: D = 0.01 is the same everywhere"});
  if (given.size() > 1)
    found.push_back({given[1], fmt::format("has both \"{}\" and \"{}\"", given[0], given[1]),
                     fmt::format("give one of {}", known)});
  for (const std::string_view key : mixed) {
    if (!effect.has(key)) continue;
    if (!effect.has("D_axes"))
      found.push_back({key, fmt::format("{} goes with D_axes, the other numbers of the matrix", key),
                       "D_axes = [D_xx, D_yy] in the plane"});
    else if (dimension == 2 && key.ends_with('z'))
      found.push_back({key, fmt::format("{} is for three dimensions, the domain has two", key), ""});
  }
  if (!found.empty() || !effect.has("D_axes")) return;
  const PrincipalValues values = principal_values(constant_of(effect), dimension);
  if (!(values.largest > 0) || values.least < -1e-12 * values.largest)
    found.push_back(
        {"D_axes",
         fmt::format("the matrix {} has the eigenvalue {:.6g}: along that direction the density would gather",
                     words_of_tensor(constant_of(effect)), values.least),
         "no eigenvalue of a matrix of diffusion is negative, and one is positive"});
}

bool has_own_diffusion(const Case& spec) {
  return std::any_of(spec.tracers.begin(), spec.tracers.end(),
                     [](const TracerSpec& tracer) { return tracer.diffusion.has_value(); });
}

/// Which part of D each named density has.
std::vector<double> parts_of_tracers(const EffectSpec& effect, const Case& spec) {
  std::vector<double> parts;
  for (const TracerSpec& tracer : spec.tracers)
    parts.push_back(tracer.diffusion ? *tracer.diffusion / effect.number("D") : 1);
  return parts;
}

std::vector<double> spreading_of_tracers(const EffectSpec& effect, const Case& spec) {
  return spreads(effect, 0) && has_own_diffusion(spec) ? parts_of_tracers(effect, spec) : std::vector<double>();
}

/// What does not go with coefficients that named densities have of their own.
void check_tracers(const EffectSpec& effect, const Case& spec, std::vector<Complaint>& found) {
  if (!has_own_diffusion(spec)) return;
  if (!effect.has("D")) {
    found.push_back({"D", "has no D, and named densities have a diffusion of their own",
                     "D = 0.01 is the largest coefficient; those of densities are parts of it"});
    return;
  }
  const int dimension = spec.domain.dimension;
  for (const TracerSpec& tracer : spec.tracers) {
    if (tracer.diffusion && *tracer.diffusion > effect.number("D"))
      found.push_back({"D",
                       fmt::format("D = {:g} is less than the diffusion of {}, {:g}", effect.number("D"), tracer.name,
                                   *tracer.diffusion),
                       "D is the largest of all; a density that spreads less has its own"});
    if (walks(effect, dimension) && tracer.diffusion && *tracer.diffusion != effect.number("D"))
      found.push_back({"method",
                       fmt::format("a particle that walks carries all named densities along, and {} has a diffusion "
                                   "of its own",
                                   tracer.name),
                       "method = \"particle-exchange\" or \"core-spreading\""});
    if (spreads(effect, dimension) && !tracer.gain.empty())
      found.push_back({"method",
                       fmt::format("blobs of each named density have a width of their own, and what {} gains from "
                                   "others has been spread as they are",
                                   tracer.name),
                       "method = \"particle-exchange\"; half_life goes with core spreading too"});
  }
}

/// What does not go with the method.
void check_method(const EffectSpec& effect, const Case& spec, std::vector<Complaint>& found) {
  const int dimension = spec.domain.dimension;
  const auto add = [&](std::string_view key, std::string message, std::string_view remedy) {
    found.push_back({key, std::move(message), std::string(remedy)});
  };
  for (const std::string_view key : {"D_field", "file"})
    if (effect.has(key) && spreads(effect, dimension))
      add(key, fmt::format("{} needs a constant D: all blobs have the same width", core_spreading),
          "method = \"particle-exchange\" or \"random-walk\"");
  if (effect.has("D_axes") && exchanges(effect, dimension))
    add("D_axes",
        fmt::format("{} needs a D that is the same along all axes: its neighbours are those of a round blob",
                    particle_exchange),
        no_exchange_instead);
  if (has_mixed(effect) && spec.domain.has(Edge::closed))
    add("D_axes",
        "a matrix with mixed numbers does not go with closed edges: images in mirrors would not keep what flows "
        "across them at 0",
        "axes of the domain along those of the matrix, with D_axes alone");
  if (exchanges(effect, dimension) && spec.domain.has(Edge::open))
    add("method",
        fmt::format("{} does not go with open edges: what diffuses through them has no particles there to take it",
                    particle_exchange),
        "method = \"core-spreading\" or \"random-walk\"");
  if (exchanges(effect, dimension) && spec.particles.overlap < 1)
    add("method",
        fmt::format("{} needs particles.overlap of at least 1, found {}", particle_exchange, spec.particles.overlap),
        "below, the sum over neighbours is no Laplacian; 2 is usual");
}

std::vector<Complaint> problems(const EffectSpec& effect, const Case& spec) {
  std::vector<Complaint> found;
  check_coefficient(effect, spec.domain.dimension, found);
  if (found.empty()) check_method(effect, spec, found);
  if (found.empty()) check_tracers(effect, spec, found);
  return found;
}

double spreading(const EffectSpec& effect) {
  if (!spreads(effect, 0)) return 0;
  if (effect.has("D")) return 4 * effect.number("D");
  const int dimension = effect.has("D_axes") ? static_cast<int>(effect.point("D_axes").size()) : 2;
  return 4 * principal_values(constant_of(effect), dimension).largest;
}

std::optional<Tensor> spreading_shape(const EffectSpec& effect, int dimension) {
  if (!makes_ellipses(effect, dimension)) return std::nullopt;
  Tensor shape = constant_of(effect);
  const double largest = principal_values(shape, dimension).largest;
  for (auto& row : shape)
    for (double& entry : row) entry /= largest;
  return shape;
}

/// Nodes of the halo that are looked at around a particle at the rim, and three sums over the particles. Two draws for
/// each axis, and two looks at a field, twice.
double work(const EffectSpec& effect, const Case& spec) {
  if (walks(effect, spec.domain.dimension)) return effect.has("D_field") || effect.has("file") ? 10 : 4;
  if (!exchanges(effect, spec.domain.dimension)) return 0;
  const double halo = 2 * spec.particles.overlap * std::sqrt(std::log(1 / effect.number("tolerance"))) + 1;
  const auto columns = static_cast<double>(std::max<std::size_t>(1, spec.tracers.size()));
  return 0.2 * std::pow(halo, spec.domain.dimension) + 20 * (1 + 2 * columns);
}

/// The volumes, the table of nodes with particles, and what three sums hold.
EffectMemory memory(const EffectSpec& effect, int dimension) {
  if (!exchanges(effect, dimension)) return {};
  return {.integrals = 1, .columns = 1, .kept = 60, .step = 28 * sizeof(double)};
}

/// D / eps^2 stays. Data on a grid do not: what they spread is too little for the coarse lattice.
void coarsen(EffectSpec& effect, double times) {
  const double factor = times * times;
  for (auto& [key, values] : effect.numbers)
    if (key == "D" || key == "D_axes" || std::find(mixed.begin(), mixed.end(), key) != mixed.end())
      for (double& value : values) value *= factor;
  for (auto& [key, text] : effect.texts)
    if (key == "D_field") text = fmt::format("({})*{:.17g}", text, factor);
}

/// Another effect of the case puts what has spread into the weights of new blobs.
bool blobs_are_renewed(const Case& spec) {
  for (const auto& [effect, written] : effects_of(spec.effects))
    if (effect->traits.restores_overlap) return true;
  return false;
}

/// 1 / (h^d int zeta_eps^2), by the Fourier transform of the blob.
double particles_a_blob(const EffectScene& scene) {
  const int dimension = scene.spec.domain.dimension;
  const ParticleSpec& particles = scene.spec.particles;
  const Cutoff cutoff = make_cutoff(particles.cutoff, dimension, scene.core_radius, particles.cutoff_arguments);
  const double step = 0.01 / scene.core_radius;
  double integral = 0;
  for (int i = 1; i < 4000; ++i) {
    const double k = i * step;
    integral += std::pow(k, dimension - 1) * std::pow(fourier(cutoff, dimension, k), 2) * step;
  }
  const double pi = std::numbers::pi, sphere = dimension == 2 ? 2 * pi : 4 * pi;
  return std::pow(2 * pi, dimension) / (sphere * integral * scene.cell());
}

std::unique_ptr<Effect> make_walk(const EffectSpec& effect, const EffectScene& scene) {
  RandomWalk::Options options{.field = scene.field,
                              .seed = static_cast<std::uint64_t>(effect.number("seed")),
                              .particles_a_blob = particles_a_blob(scene),
                              .threads = scene.threads};
  const int dimension = scene.spec.domain.dimension;
  for (std::size_t k = 0; k < static_cast<std::size_t>(dimension); ++k) options.diffusion[k][k] = 1;
  if (const auto constant = constant_diffusivity(effect, dimension)) options.diffusion = *constant;
  return std::make_unique<RandomWalk>(options);
}

std::unique_ptr<Effect> make_exchange(const EffectSpec& effect, const EffectScene& scene) {
  ParticleExchange::Options options{.coefficient = scene.field ? 1 : effect.number("D"),
                                    .of_tracers = {},
                                    .field = scene.field,
                                    .end = scene.spec.time.end,
                                    .tolerance = effect.number("tolerance"),
                                    .threads = scene.threads};
  if (has_own_diffusion(scene.spec))
    options.of_tracers = parts_of_tracers(effect, scene.spec);
  else
    options.of_tracers.assign(scene.spec.tracers.size(), 1);
  options.ends = LatticeEnds(scene.spec.domain, scene.seeding);
  options.folding = scene.folding;
  options.tiles.particles = scene.spec.evaluate.tile_particles > 0
                                ? static_cast<std::int64_t>(scene.spec.evaluate.tile_particles)
                                : usual_tiles(scene.spec.domain.dimension).particles;
  return std::make_unique<ParticleExchange>(scene.seeding, scene.core_radius, scene.velocity, scene.follow, options,
                                            scene.ranks);
}

std::unique_ptr<Effect> make(const EffectSpec& effect, const EffectScene& scene) {
  const int dimension = scene.spec.domain.dimension;
  if (walks(effect, dimension)) return make_walk(effect, scene);
  if (exchanges(effect, dimension)) return make_exchange(effect, scene);
  return std::make_unique<CoreSpreading>(constant_diffusivity(effect, dimension).value(), dimension, scene.velocity,
                                         scene.spec.time.end, scene.distance, blobs_are_renewed(scene.spec));
}

using Kind = NamedParameter::Kind;
constexpr std::string_view unit = "length^2 / time";

NamedParameter mixed_number(std::string_view name, std::string_view meaning) {
  return {.name = name, .unit = unit, .meaning = meaning, .optional = true};
}

bool needs_lengths(const EffectSpec& effect, int dimension) {
  return !spreads(effect, dimension) || makes_ellipses(effect, dimension);
}

std::vector<NamedParameter> keys() {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  return {
      {.name = "D",
       .range = positive,
       .unit = unit,
       .symbol = "D",
       .meaning = "coefficient of diffusion, constant in space and time. One of `D`, `D_axes`, `D_field` and `file` "
                  "says it",
       .optional = true},
      {.name = "D_axes",
       .kind = Kind::point,
       .range = {0, infinity},
       .unit = unit,
       .symbol = "D_kk",
       .meaning = "in place of `D`, a constant matrix: the density spreads differently along the axes. "
                  "`core-spreading` and `random-walk` know it",
       .optional = true},
      mixed_number("D_xy", "of the matrix of `D_axes`, whose axes then lie aslant: D_xy = D_yx"),
      mixed_number("D_xz", "the same of x and z"),
      mixed_number("D_yz", "the same of y and z"),
      {.name = "D_field",
       .kind = Kind::expression_in_time,
       .unit = unit,
       .symbol = "D(x, t)",
       .meaning = "in place of `D`, a coefficient that depends on place and time: an expression in x, y, z, t and "
                  "params that is nowhere negative. `particle-exchange` and `random-walk` know it",
       .optional = true},
      {.name = "method",
       .kind = Kind::choice,
       .fallback = core_spreading,
       .meaning = "how the density diffuses",
       .choices = methods},
      {.name = "tolerance",
       .fallback = "1e-06",
       .range = {1e-10, 0.1},
       .meaning = "for `method = \"particle-exchange\"`: a particle with more than this part of the largest density "
                  "is surrounded with others, which receive what diffuses",
       .with = "method",
       .value = particle_exchange},
      {.name = "seed",
       .kind = Kind::whole,
       .fallback = "1",
       .range = {0, 9007199254740992},
       .meaning = "for `method = \"random-walk\"`: another number gives another course of chance. One number always "
                  "gives the same bits, on any number of threads and ranks",
       .with = "method",
       .value = random_walk}};
}

}  // namespace

NamedEffect diffusion() {
  return {.about = NamedFormula{.name = "diffusion",
                                .meaning =
                                    "the density diffuses: d_t rho + div(rho u) = div(D grad rho). `reference.kind` is "
                                    "then `none`, unless it is `exact`",
                                .parameters = keys()},
          .traits = {.adds_particles = {.words = "particle-exchange adds particles during the run",
                                        .unless = no_exchange,
                                        .remedy = no_exchange_instead,
                                        .holds = exchanges},
                     .moves_weight = {.words = "diffusion moves weight between particles"},
                     .needs_fixed_steps = {.words = "method = \"particle-exchange\" or \"random-walk\"",
                                           .remedy = "a step that is short enough",
                                           .holds = steps_are_known},
                     .widens_blobs = {.words = "core spreading widens the blobs",
                                      .unless = a_walk,
                                      .remedy = walk_instead,
                                      .holds = spreads},
                     .makes_ellipses = {.words = "with different D along the axes blobs become ellipses",
                                        .unless = "D is the same along all axes",
                                        .remedy = walk_instead,
                                        .holds = makes_ellipses},
                     .scatters = {.words = "a random walk parts particles that started side by side",
                                  .unless = "`method = \"core-spreading\"` or `\"particle-exchange\"`",
                                  .remedy = "method = \"particle-exchange\"",
                                  .holds = walks},
                     .needs_lengths = {.words = "of diffusion on a sphere only core spreading with one D is known",
                                       .remedy = "method = \"core-spreading\" with D",
                                       .holds = needs_lengths},
                     .diffuses = true,
                     .knows_edges = true,
                     .irreversible = {.words = "diffusion cannot be undone: what was there before is lost in it, and "
                                               "small errors would grow without bound"}},
          .field = "D_field",
          .field_name = "the coefficient of diffusion",
          .elsewhere = {{"diffusivity", asked_for},
                        {"viscosity", asked_for},
                        {"nu", asked_for},
                        {"kappa", asked_for},
                        {"wiener", "[effects.diffusion] with method = \"random-walk\""}},
          .problems = problems,
          .spreading = spreading,
          .spreading_shape = spreading_shape,
          .spreading_of_tracers = spreading_of_tracers,
          .work = work,
          .memory = memory,
          .coarsen = coarsen,
          .make = make};
}

}  // namespace gaussdrift::named

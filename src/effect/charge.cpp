#include "effect/charge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "base/exact_sum.hpp"
#include "effect/catalogue.hpp"
#include "effect/nodes.hpp"
#include "effect/pair_images.hpp"

namespace gaussdrift {

std::string Charge::describe() const {
  return fmt::format("charges drift, X_j' += {:g} sum_k q_k (X_j - X_k)/r^{}{}{}, q = {}, to {:g} of sum |q|/r^{}",
                     options_.mobility, options_.dimension, options_.dimension == 2 ? " (1 - exp(-r^2/eps^2))" : "",
                     images_text(options_.domain, false),
                     options_.own ? "h^d (" + options_.written + ") at the start" : "alpha", options_.tolerance,
                     options_.dimension - 1);
}

std::string Charge::conserves() const {
  return images_text(options_.domain, false).empty() ? "charge and, without a flow, its centroid" : "charge";
}

void Charge::begin(Particles& particles, double /*time*/) {
  placed(particles);
  total_ = largest_rate_ = 0;
  base::ExactSum total;
  // div E = 2 pi rho_q (2D), 4 pi rho_q (3D)
  const double rate = 2 * std::numbers::pi * (options_.dimension - 1) * std::abs(options_.mobility) / options_.cell;
  for (const double charge : charges_of(particles)) {
    total.add(charge);
    largest_rate_ = std::max(largest_rate_, rate * std::abs(charge));
  }
  if (options_.ranks) {
    base::sum_over_ranks(*options_.ranks, std::span(&total, 1));
    options_.ranks->max(std::span(&largest_rate_, 1));
  }
  total_ = total.value();
}

void Charge::placed(const Particles& particles) {
  const auto charges_of_nodes = [&] {
    if (options_.own) own_ = options_.own(particles);
  };
  if (options_.ranks)
    options_.ranks->agree_on(charges_of_nodes);
  else
    charges_of_nodes();
}

double Charge::stable_step() const {
  return largest_rate_ > 0 ? 1 / largest_rate_ : std::numeric_limits<double>::infinity();
}

std::string Charge::warning() const {
  if (options_.mobility >= 0 || largest_rate_ == 0) return "";
  return fmt::format(
      "equal charges attract each other, because effects.charge.mobility is negative. Their density grows like 1/(1 - "
      "t/tau), and from t = tau = {:.3g} on there is no solution.",
      1 / largest_rate_);
}

void Charge::add(double t, const Particles& particles, const PointsView& x, const VectorsView& u) const {
  const std::vector<double>& charges = charges_of(particles);
  if (options_.dimension == 2) {
    // The field of a Gaussian charge is the velocity of a vortex blob turned by a quarter, times 2 pi.
    const double core = std::sqrt(options_.core_radius * options_.core_radius + options_.spreading * t);
    const farfield::Points<2> turned = pairs_.vortices(x, particles.id, charges, core, farfield::MirrorImages::equal);
    const double factor = 2 * std::numbers::pi * options_.mobility;
    for (std::size_t j = 0; j < x.count; ++j) {
      u.axis[0][j] += factor * turned(1, static_cast<Eigen::Index>(j));
      u.axis[1][j] -= factor * turned(0, static_cast<Eigen::Index>(j));
    }
  } else {
    const farfield::Points<3> field = pairs_.charges(x, particles.id, charges);
    for (std::size_t j = 0; j < x.count; ++j)
      for (int k = 0; k < 3; ++k) u.axis[k][j] += options_.mobility * field(k, static_cast<Eigen::Index>(j));
  }
}

Numbers Charge::numbers() const {
  Numbers numbers{{"evaluations", static_cast<double>(pairs_.evaluations())},
                  {"tolerance", options_.tolerance},
                  {"clusters", static_cast<double>(pairs_.last_choice().clusters)},
                  {"charge", total_},
                  {"largest_rate", largest_rate_}};
  if (has_background(options_.domain, false)) numbers.emplace_back("background", background(options_.domain, total_));
  return numbers;
}

namespace {

bool has_density(const EffectSpec& effect, int /*dimension*/) { return effect.has("density"); }

std::unique_ptr<Effect> make_charge(const EffectSpec& effect, const EffectScene& scene) {
  Charge::Options options{.mobility = effect.number("mobility"),
                          .core_radius = scene.core_radius,
                          .spreading = scene.spreading,
                          .cell = scene.cell(),
                          .tolerance = effect.number("tolerance"),
                          .dimension = scene.spec.domain.dimension,
                          .threads = scene.threads,
                          .ranks = &scene.ranks,
                          .domain = scene.spec.domain};
  if (scene.carried) {
    // The density of charge times the volume of a particle. Particles of other ranks may have come, so places are those
    // of the nodes that they started on.
    options.own = [&density = *scene.carried, nodes = Nodes(scene.seeding),
                   cell = options.cell](const Particles& particles) {
      Particles at_start;
      at_start.dimension = particles.dimension;
      at_start.alpha = particles.alpha;
      for (const std::int64_t id : particles.id) {
        const Vector place = nodes.position(nodes.index(id));
        for (int k = 0; k < particles.dimension; ++k) at_start.position[k].push_back(place[k]);
      }
      std::vector<double> charges(particles.size(), 0.0);
      density.add(0, at_start.view(), charges.data());
      for (double& charge : charges) charge *= cell;
      return charges;
    };
    options.written = effect.text("density");
  }
  return std::make_unique<Charge>(std::move(options));
}

}  // namespace

namespace named {

NamedEffect charge() {
  return {
      .about =
          NamedFormula{
              .name = "charge",
              .meaning = "the particles are charged and repel each other: X' = u + mobility E(X) with E = sum_k q_k "
                         "(X - X_k) / r^d. `reference.kind` is then `none`, unless it is `exact`",
              .parameters = {{.name = "mobility",
                              .unit = "length^d / (charge time)",
                              .symbol = "mu",
                              .meaning = "velocity of a particle in a field of size 1. Equal charges attract each "
                                         "other where it is negative"},
                             {.name = "density",
                              .kind = NamedParameter::Kind::expression,
                              .unit = "charge / length^d",
                              .symbol = "rho_q",
                              .meaning = "density of charge at the start, an expression in x, y, z and params. Every "
                                         "particle keeps its charge. Without this key the charge of a particle is "
                                         "its weight",
                              .optional = true},
                             {.name = "tolerance",
                              .fallback = "1e-06",
                              .range = {1e-14, 0.1},
                              .meaning = "error allowed in E, relative to the sum of the sizes of all single fields "
                                         "at that place. The library farfield promises it"}}},
      .traits = {.particles_interact = true,
                 .moved_by_weights = {.words = "these are the charges that move the particles",
                                      .unless = "the charge has a density of its own",
                                      .remedy = "give the charge a density of its own: effects.charge.density",
                                      .holds = [](const EffectSpec& effect, int d) { return !has_density(effect, d); }},
                 .blind_to_widths = {.words = "charges are points in three dimensions, so their field would not spread "
                                              "with the density",
                                     .unless = "the scene has two dimensions",
                                     .holds = [](const EffectSpec&, int dimension) { return dimension == 3; }},
                 .carries_more = {.words = "charge of their own",
                                  .unless = "the charge is the weight",
                                  .remedy = "leave out one of them, or effects.charge.density",
                                  .holds = has_density},
                 .needs_lengths = {.words = "the forces are those of the plane and of space"}},
      .carried = "density",
      .carried_name = "charge",
      .problems = [](const EffectSpec& effect,
                     const Case& spec) { return tolerance_of_images(effect.number("tolerance"), spec.domain); },
      .memory = [](const EffectSpec&,
                   int dimension) { return EffectMemory{.step = PairVelocity::bytes_of_particle(dimension)}; },
      .memory_of_images = bytes_of_images,
      .make = make_charge};
}

}  // namespace named

}  // namespace gaussdrift

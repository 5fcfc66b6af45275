#include "effect/vortex.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "base/exact_sum.hpp"
#include "effect/catalogue.hpp"
#include "effect/pair_images.hpp"
#include "particle/cutoff.hpp"

namespace gaussdrift {

std::string Vortex::describe() const {
  return fmt::format(
      "vortex blobs, X_j' += sum_k alpha_k (1 - exp(-r^2/eps^2)) / (2 pi r^2) (-dy, dx){}, to {:g} of sum "
      "|alpha|/(2 pi r)",
      images_text(options_.domain, true), options_.tolerance);
}

std::string Vortex::conserves() const {
  return images_text(options_.domain, true).empty() ? "circulation and, without a flow, its centroid" : "circulation";
}

void Vortex::begin(Particles& particles, double /*time*/) {
  largest_vorticity_ = 0;
  base::ExactSum total;
  for (const double alpha : particles.alpha) {
    total.add(alpha);
    largest_vorticity_ = std::max(largest_vorticity_, std::abs(alpha) / options_.cell);
  }
  if (options_.ranks) {
    base::sum_over_ranks(*options_.ranks, std::span(&total, 1));
    options_.ranks->max(std::span(&largest_vorticity_, 1));
  }
  circulation_ = total.value();
}

double Vortex::stable_step() const {
  return largest_vorticity_ > 0 ? 1 / largest_vorticity_ : std::numeric_limits<double>::infinity();
}

void Vortex::add(double t, const Particles& particles, const PointsView& x, const VectorsView& u) const {
  const double core = std::sqrt(options_.core_radius * options_.core_radius + options_.spreading * t);
  const farfield::Points<2> velocity = pairs_.vortices(x, particles.id, particles.alpha, core);
  for (std::size_t j = 0; j < x.count; ++j)
    for (int k = 0; k < 2; ++k) u.axis[k][j] += velocity(k, static_cast<Eigen::Index>(j));
}

Numbers Vortex::numbers() const {
  Numbers numbers{{"evaluations", static_cast<double>(pairs_.evaluations())},
                  {"tolerance", options_.tolerance},
                  {"clusters", static_cast<double>(pairs_.last_choice().clusters)},
                  {"largest_vorticity", largest_vorticity_}};
  if (has_background(options_.domain, true))
    numbers.emplace_back("background", background(options_.domain, circulation_));
  return numbers;
}

namespace {

std::vector<Complaint> problems_of(const EffectSpec& effect, const Case& spec) {
  std::vector<Complaint> problems = tolerance_of_images(effect.number("tolerance"), spec.domain);
  std::string gaussian;
  for (const NamedCutoff& cutoff : cutoffs()) {
    if (!cutoff.is_gaussian) continue;
    if (cutoff.name == spec.particles.cutoff) return problems;
    gaussian = cutoff.name;
  }
  problems.push_back(
      {.key = "",
       .message = fmt::format("needs particles.cutoff = \"{}\", found \"{}\"", gaussian, spec.particles.cutoff),
       .remedy = "the velocity of a blob is known for the Gaussian alone"});
  return problems;
}

std::unique_ptr<Effect> make_vortex(const EffectSpec& effect, const EffectScene& scene) {
  return std::make_unique<Vortex>(Vortex::Options{.core_radius = scene.core_radius,
                                                  .spreading = scene.spreading,
                                                  .cell = scene.cell(),
                                                  .tolerance = effect.number("tolerance"),
                                                  .threads = scene.threads,
                                                  .ranks = &scene.ranks,
                                                  .domain = scene.spec.domain});
}

}  // namespace

namespace named {

NamedEffect vortex() {
  return {.about =
              NamedFormula{
                  .name = "vortex",
                  .meaning = "the density is a vorticity, and its blobs move each other as vortices do. It needs two "
                             "dimensions and `cutoff = \"gauss2\"`. `reference.kind` is then `none`, unless it is "
                             "`exact`",
                  .most_dimension = 2,
                  .parameters = {{.name = "tolerance",
                                  .fallback = "1e-06",
                                  .range = {1e-14, 0.1},
                                  .meaning = "error allowed in the velocity, relative to the sum of the sizes of all "
                                             "single velocities at that place. The library farfield promises it"}}},
          .traits = {.particles_interact = true,
                     .moved_by_weights = {.words = "these are the circulations that move the particles"},
                     .needs_lengths = {.words = "the velocity of vortices is that of the plane"},
                     .flat_patches_ripple = true},
          .problems = problems_of,
          .memory = [](const EffectSpec&,
                       int dimension) { return EffectMemory{.step = PairVelocity::bytes_of_particle(dimension)}; },
          .memory_of_images = bytes_of_images,
          .make = make_vortex};
}

}  // namespace named

}  // namespace gaussdrift

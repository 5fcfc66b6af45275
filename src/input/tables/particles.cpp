// [particles]: the lattice on which particles start, and the blob each carries.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/longest_side.hpp"
#include "effect/catalogue.hpp"
#include "input/tables/tables.hpp"
#include "particle/cutoff.hpp"
#include "sim/borders/edges.hpp"

namespace gaussdrift::input {

namespace {

std::string tables_that_grow_weights() {
  std::vector<std::string> names;
  for (const NamedEffect& effect : effects())
    if (!effect.traits.grows_weights.words.empty()) names.push_back(fmt::format("`[{}]`", table_of(effect)));
  return fmt::format("{}", fmt::join(names, " or "));
}

}  // namespace

Section particles_section() {
  std::vector<Key> keys{
      {.name = "per_axis",
       .type = Type::whole,
       .required = true,
       .range = {2, infinity},
       .symbol = "n_g",
       .meaning = "number of lattice points along the longest axis. The spacing h is the same on all axes"},
      {.name = "overlap",
       .type = Type::number,
       .fallback = "2",
       .range = {0.01, 100},
       .symbol = "c",
       .meaning =
           "core radius of a blob in units of the spacing: eps = c h. It says how far neighbouring blobs overlap"},
      {.name = "cutoff",
       .type = Type::choice,
       .fallback = cutoffs().front().name,
       .choices = base::names_of(cutoffs()),
       .symbol = "zeta",
       .meaning = with_choices("shape of the blob. A higher order blurs less", cutoffs())}};
  for (const NamedCutoff& cutoff : cutoffs())
    for (const NamedParameter& parameter : cutoff.parameters) keys.push_back(key_of(parameter));
  keys.push_back({.name = "threshold",
                  .type = Type::number,
                  .fallback = "1e-12",
                  .range = {0, 0.01},
                  .meaning = fmt::format(
                      "lattice points that carry less than this part of the largest weight{}, get no particle. The run "
                      "says how many they are and how much they would carry. With {}, which can raise small "
                      "weights, the default is 0: every point that carries anything gets a particle",
                      largest_of_carried(), tables_that_grow_weights())});
  return {Table{.name = "particles",
                .required = true,
                .meaning =
                    "the lattice on which particles start, and the blob that each of them carries. A blob is a smooth "
                    "bump that spreads the weight of its particle"},
          keys};
}

namespace {

/// The density of equal blobs on a lattice ripples by 2 d zeta^(2 pi c), zeta^ the Fourier transform of the cutoff
/// (Poisson's sum).
void warn_small_overlap(Reader& in, const ParticleSpec& particles, const Number& overlap) {
  const Cutoff cutoff = make_cutoff(particles.cutoff, 1, 1, particles.cutoff_arguments);
  if (narrowest_width(cutoff) * particles.overlap >= 1) return;
  const double ripple = 2 * (in.facts.dimension ? in.facts.dimension : 2) *
                        std::abs(fourier(cutoff, 1, 2 * std::numbers::pi * particles.overlap));
  in.diagnostics.warning(overlap.written->place,
                         fmt::format("overlap = {} leaves gaps between the blobs: a constant density ripples by {:.1g}",
                                     particles.overlap, ripple),
                         "2 is usual; 1 ripples by about 2e-4");
}

void warn_thin(Reader& in, const Lattice& lattice, const Number& count) {
  for (std::size_t k = 0; k < static_cast<std::size_t>(lattice.dimension); ++k)
    if ((in.facts.one_particle_across[k] = lattice.points[k] == 1))
      in.diagnostics.warning(count.written->place,
                             fmt::format("the domain is narrower along {} than the spacing {:.3g}: one particle across",
                                         "xyz"[k], lattice.spacing),
                             "raise per_axis or widen the domain");
}

/// Images of the particles beyond an edge have to go on with their lattice.
void refuse_broken_cells(Reader& in, const Domain& domain, const Number& count) {
  const int per_axis = to_int(count);
  const auto broken = axis_without_whole_cells(domain, per_axis);
  if (!broken) return;
  const auto k = static_cast<std::size_t>(*broken);
  const double longest = longest_side(domain.dimension, domain.min, domain.max);
  std::vector<int> good = per_axis_with_whole_cells(domain, per_axis, 2);
  std::sort(good.begin(), good.end());
  in.diagnostics.error(
      count.written ? count.written->place : in.source.end(),
      fmt::format("the spacing {:.6g} of the particle lattice does not divide the length {:g} of {}, whose ends are "
                  "periodic or closed",
                  longest / (per_axis - 1), domain.max[k] - domain.min[k], "xyz"[k]),
      good.empty() ? "make the lengths of the domain small multiples of one length"
                   : fmt::format("per_axis = {} does it", fmt::join(good, " or ")));
}

/// False if the cutoff cannot be made from them.
bool read_cutoff_arguments(Reader& in, ParticleSpec& particles) {
  const NamedCutoff& chosen = find_cutoff(particles.cutoff);
  for (const NamedCutoff& other : cutoffs())
    for (const NamedParameter& parameter : other.parameters)
      if (const Entry* entry = in.find("particles", parameter.name); entry && &other != &chosen)
        in.diagnostics.error(entry->place, fmt::format("\"{}\" goes with cutoff = \"{}\", not with \"{}\"",
                                                       parameter.name, other.name, particles.cutoff));
  for (const NamedParameter& parameter : chosen.parameters)
    if (const auto value = in.number("particles", parameter.name))
      particles.cutoff_arguments.emplace_back(parameter.name, std::vector{value->number});
  if (!chosen.problems) return true;
  const auto problems = chosen.problems(complete(chosen.name, chosen.parameters, particles.cutoff_arguments, {}));
  for (const Complaint& problem : problems)
    in.diagnostics.error(in.find("particles", problem.key)->value.place, problem.message, problem.remedy);
  return problems.empty();
}

}  // namespace

void read_particles(Reader& in, ParticleSpec& particles, const Domain& domain) {
  if (const auto count = per_axis(in, "particles", "one particle an axis has no spacing")) {
    if (const auto lattice = make_checked_lattice(in, "particle lattice", domain, *count)) {
      warn_thin(in, *lattice, *count);
      refuse_broken_cells(in, domain, *count);
    }
    particles.per_axis = to_int(*count);
  }
  particles.cutoff = in.choice("particles", "cutoff");
  // Where weights can grow, those that are next to nothing at the start count.
  const bool grow = std::any_of(effects().begin(), effects().end(), [&](const NamedEffect& effect) {
    return !effect.traits.grows_weights.words.empty() && in.table(table_of(effect));
  });
  if (const auto threshold = in.number("particles", "threshold"))
    particles.threshold = threshold->written || !grow ? threshold->number : 0;
  const bool valid = read_cutoff_arguments(in, particles);
  if (const auto overlap = in.number("particles", "overlap")) {
    particles.overlap = overlap->number;
    if (overlap->written && valid) warn_small_overlap(in, particles, *overlap);
  }
}

void write_particles(Writer& out, const ParticleSpec& particles) {
  out.table("particles");
  out.entry("per_axis", fmt::format("{}", particles.per_axis));
  out.entry("overlap", written(particles.overlap));
  out.entry("cutoff", written(particles.cutoff));
  const Arguments cutoff_arguments =
      complete(particles.cutoff, find_cutoff(particles.cutoff).parameters, particles.cutoff_arguments, {});
  for (const auto& [name, values] : cutoff_arguments) out.entry(name, written(values.at(0)));
  out.entry("threshold", written(particles.threshold));
}

}  // namespace gaussdrift::input

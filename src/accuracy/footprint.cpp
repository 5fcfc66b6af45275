#include "accuracy/footprint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "accuracy/budget.hpp"
#include "accuracy/memory_limits.hpp"
#include "accuracy/trial.hpp"
#include "accuracy/trial_times.hpp"
#include "base/has_one.hpp"
#include "base/size_text.hpp"
#include "effect/catalogue.hpp"
#include "effect/tracer_reactions.hpp"
#include "gaussdrift/accuracy.hpp"
#include "gaussdrift/error.hpp"
#include "gaussdrift/simulation.hpp"
#include "particle/cutoff.hpp"
#include "render/film_cost.hpp"
#include "render/picture_series.hpp"
#include "render/styles.hpp"
#include "sim/borders/edges.hpp"
#include "sim/carrier.hpp"
#include "sim/comparison.hpp"
#include "sim/fields_on_grid.hpp"
#include "sim/follow/particle_fields.hpp"
#include "sim/grid_pieces.hpp"
#include "sim/moments.hpp"
#include "sim/releases.hpp"
#include "sim/scene.hpp"
#include "write/checkpoint.hpp"

namespace gaussdrift::accuracy {

namespace {

constexpr double number = 8;  // bytes
constexpr std::size_t trial_particles = 100'000;
// Measured with cases/doswell.toml of 57 000 to 910 000 particles, in bytes.
constexpr double budget_of_particle = 550, most_of_budget = 5e7;

bool in_space(const Case& spec) { return spec.domain.dimension == 3; }

/// What a kind of file takes while it is made: its share that grows with the particles, and the other.
RunMemory memory_of_file(const write::FileKind& kind, const Extent& extent) {
  Extent without = extent;
  without.particles = 0;
  const double all = kind.memory(extent), grid = kind.memory(without);
  return {.particles = all - grid, .grid = grid};
}

bool changes_particles(const Case& spec) {
  const auto all = effects_of(spec.effects);
  return std::any_of(all.begin(), all.end(), [&](const auto& one) {
    const EffectTraits& traits = one.first->traits;
    return traits.adds_particles.of(one.second, spec.domain.dimension) ||
           traits.replaces_particles.of(one.second, spec.domain.dimension);
  });
}

double most_pieces(const Case& spec, double particles) {
  return std::max(1.0, std::ceil(particles / spec.output.piece_particles));
}

/// What files hold: pieces of a density show layers that others have, too, and of exact densities formulas alone.
Extent in_files(const Case& spec, Extent extent) {
  extent.particle_pieces = most_pieces(spec, extent.particles);
  extent.particle_numbers = particle_field_numbers(spec.output) + static_cast<double>(spec.tracers.size());
  extent.field_numbers = field_numbers(spec.output, spec.domain.dimension);
  const LatticePieces pieces = pieces_of_grid(spec);
  if (pieces.count() == 1) return extent;
  const Lattice lattice = evaluation_lattice(spec);
  extent.pieces = static_cast<double>(pieces.count());
  extent.grid_points = 1;
  for (std::size_t k = 0; k < max_dimension; ++k)
    extent.grid_points *= static_cast<double>(lattice.points[k]) + std::ldexp(1.0, pieces.halvings()[k]) - 1;
  extent.compared_everywhere = extent.compared_everywhere && spec.reference.kind == ReferenceSpec::Kind::exact;
  return extent;
}

/// Of all effects, a particle.
EffectMemory memory_of_effects(const Case& spec) {
  EffectMemory effects;
  for (const auto& [effect, written] : effects_of(spec.effects)) {
    if (!effect->memory) continue;
    const EffectMemory one = effect->memory(written, spec.domain.dimension);
    effects.integrals += one.integrals, effects.columns += one.columns;
    effects.kept += one.kept, effects.step += one.step;
    if (effect->memory_of_images) effects.step += effect->memory_of_images(spec);
    if (effect->traits.adds_particles.of(written, spec.domain.dimension))  // it exchanges each named density
      effects.step += 6 * number * static_cast<double>(spec.tracers.size());
  }
  effects.columns += static_cast<double>(spec.tracers.size());
  if (tracers_react(spec)) effects.integrals += static_cast<double>(spec.tracers.size());
  return effects;
}

double bytes_of_particle(const Case& spec, const EffectMemory& effects) {
  return number * (spec.domain.dimension + 2 + effects.integrals + effects.columns +
                   (remembers(spec.output) ? static_cast<double>(kept_numbers) : 0));
}

/// What is summed, of what is carried: with the images of particles beyond periodic and closed edges.
double summed_with_images(const Case& spec) {
  Domain domain = spec.domain;
  for (const SourceSpec& source : spec.sources)  // some time all that let something in
    if (const auto* face = std::get_if<FaceSourceSpec>(&source.what)) {
      const auto axis = static_cast<std::size_t>(face->axis);
      domain.edges[axis][face->upper ? 1 : 0] = domain_of_sum(spec, source.from).edges[axis][face->upper ? 1 : 0];
    }
  const Folding folding = folding_of(domain);
  if (!folding.folds() || domain.on_sphere()) return 1;
  const double eps = spec.particles.overlap * seeding_lattice(domain, spec.particles.per_axis).spacing;
  const double felt =
      reach(make_cutoff(spec.particles.cutoff, domain.dimension, eps, spec.particles.cutoff_arguments), 1e-14);
  double times = 1;
  for (int k = 0; k < domain.dimension; ++k) {
    const FoldedAxis& axis = folding.axis(k);
    const double ends = axis.periodic ? 2 : (axis.mirror_low ? 1.0 : 0.0) + (axis.mirror_high ? 1.0 : 0.0);
    times *= 1 + ends * felt / (axis.high - axis.low);
  }
  return times;
}

/// Of an output, to draw it again: single precision, thinned in space.
double kept_for_pictures(const Case& spec, double grid_points) {
  return 4 * (in_space(spec) ? std::min(grid_points, 2.1e6) : grid_points);
}

}  // namespace

double bytes_of_particle(const Case& spec) { return bytes_of_particle(spec, memory_of_effects(spec)); }

RunMemory operator+(const RunMemory& a, const RunMemory& b) {
  return {a.particles + b.particles, a.grid + b.grid, a.pictures + b.pictures};
}

std::optional<std::size_t> pieces_of_particles(const Case& spec, std::size_t particles) {
  if (changes_particles(spec) || !spec.sources.empty()) return std::nullopt;
  return static_cast<std::size_t>(most_pieces(spec, static_cast<double>(particles)));
}

double particles_at_most(const Case& spec, Trial& trial) {
  if (!changes_particles(spec)) return (spec.density.empty() ? 0 : trial.carried) + particles_released(spec, 1);
  const double seeded = static_cast<double>(trial.particles.size()), each = trial.carried / seeded;
  Particles particles = trial.particles;
  Carrier carrier(trial.spec, trial.scene, 1);
  carrier.begin(particles);
  const double at_start =
      with_halo(trial.carried, static_cast<double>(particles.size()) - seeded, each, spec.domain.dimension);
  return carrier.replaces_particles() && spec.time.end > 0 ? at_start * grow(spec, trial).most : at_start;
}

namespace {

render::FilmCost film_of(const Case& spec) {
  return spec.output.animation ? render::film_cost(spec, lattice_of_moments(evaluation_lattice(spec)).size())
                               : render::FilmCost{};
}

bool keeps_checkpoints(const Case& spec, double seconds) {
  return spec.output.checkpoint ? *spec.output.checkpoint > 0 : seconds >= write::long_run;
}

/// Of the drawing libraries, which stay once they have drawn.
double memory_of_drawing(const Case& spec) {
  double most = spec.output.animation ? render::Cost{}.memory : 0;
  const double pixels = static_cast<double>(spec.output.pictures.size[0]) * spec.output.pictures.size[1];
  for (const PictureStyle& style : spec.output.images) {
    const render::Cost& cost = render::find_style(style.name).cost;
    most = std::max(most, cost.memory + cost.memory_of_pixel * pixels);
  }
  return most;
}

// Densities of a run without density files, for pictures that are drawn again.
double densities_for_pictures(const Case& spec, const Extent& extent) {
  if (spec.output.images.empty() || base::has_one(spec.output.files, &OutputFile::shows_density)) return 0;
  return static_cast<double>(spec.output.times.size()) * kept_for_pictures(spec, extent.grid_points) *
         (extent.compared_everywhere ? 2 : 1);
}

/// Bytes of the frames that the page of a run plays: a density and its error take some 0.3 bytes a point each, if they are
/// smooth, and so do some of the particles.
double frames_of_page(const Case& spec, double grid_points) {
  if (!spec.output.report || !spec.output.page.plays) return 0;
  const double frames = static_cast<double>(spec.output.times.size());
  const double points = std::min(grid_points, spec.domain.dimension == 3 ? 64. * 64 * 64 : 512. * 512);
  return std::min(frames * (0.6 * points + 8e3), 0.75e6 * spec.output.page.megabytes);
}

}  // namespace

double most_disk_of_run(const Case& spec, const Extent& all, double seconds) {
  const double for_pictures = keeps_checkpoints(spec, seconds) ? 0 : densities_for_pictures(spec, in_files(spec, all));
  return disk_of_run(spec, all, seconds) + for_pictures;
}

double disk_of_run(const Case& spec, const Extent& all, double seconds) {
  const Extent extent = in_files(spec, all);
  const auto frames = static_cast<double>(spec.output.times.size());
  double bytes = 1e4 + 250 * frames;
  for (const PictureStyle& style : spec.output.images) bytes += frames * render::find_style(style.name).cost.bytes;
  const render::FilmCost film = film_of(spec);
  bytes += film.bytes + film.kept;
  for (const OutputFile& file : spec.output.files) bytes += frames * write::find_output_file(file.name).bytes(extent);
  bytes += (1 + 4. / 3) * frames_of_page(spec, extent.grid_points);               // beside the page, and in it as text
  if (spec.output.report) bytes += 5e4 + (spec.output.images.empty() ? 0 : 5e5);  // the page and its picture
  if (keeps_checkpoints(spec, seconds))
    bytes +=
        2 * extent.particles * bytes_of_particle(spec, memory_of_effects(spec)) + densities_for_pictures(spec, extent);
  return bytes;
}

RunMemory memory_of_run(const Case& spec, const Extent& extent) {
  const LatticePieces pieces = pieces_of_grid(spec);
  const bool in_pieces = pieces.count() > 1;
  // What is kept and drawn of an output, and what is summed and written at once.
  const double m = in_pieces ? static_cast<double>(shown_grid(spec).size()) : extent.grid_points,
               at_once = in_pieces ? static_cast<double>(pieces.shown(0).size()) : extent.grid_points;
  const double n = extent.particles, d = spec.domain.dimension, frames = static_cast<double>(spec.output.times.size());
  const EffectMemory effects = memory_of_effects(spec);
  const bool pictures = !spec.output.images.empty() || spec.output.animation;

  // What stays: positions, weights, ids, integrals, volumes; a halo's and a remeshing's tables of nodes.
  const double particle = bytes_of_particle(spec, effects);
  RunMemory stays{.particles = n * particle + n * effects.kept};
  // The last output is kept for the error budget and the page.
  const bool explained =
      spec.reference.kind != ReferenceSpec::Kind::none && spec.accuracy.budget != AccuracySpec::Budget::none;
  const bool kept = !in_pieces && (spec.output.report || explained);
  const RunMemory copy =
      kept ? RunMemory{.particles = n * particle, .grid = m * number * (extent.compared_everywhere ? 2 : 1)}
           : RunMemory{};
  if (pictures)
    stays.pictures = std::min(frames * kept_for_pictures(spec, m), static_cast<double>(render::most_kept_bytes));

  stays.pictures += frames_of_page(spec, m);

  // Lines of the lattice are seeded one by one and joined.
  const double lines = extent.lattice_points / std::max(1.0, std::pow(extent.lattice_points, 1 / d));
  const RunMemory seed{.particles = 2 * n * particle + 450 * lines};
  // Effects between steps: as it was before the step, if that is abandoned.
  const double before =
      effects.kept > 0 || spec.domain.has(Edge::open) || spec.domain.coast != AtCoast::refuse ? n * particle : 0;
  const RunMemory step =
      stays + RunMemory{.particles = 2 * n * number * (d + effects.integrals) + n * effects.step + before};

  // The transform holds the points sorted, with its boxes; in space boxes have more neighbours.
  // Of pieces two layers each are held from the beginning to the end of an output, beside the thinned grid.
  const Extent files = in_files(spec, extent);
  const double layers = in_pieces ? 2 * (files.grid_points - extent.grid_points) + m : 0;
  const auto derivatives = static_cast<double>(derivatives_of(spec.output, spec.domain.dimension).size());
  const double summed = summed_with_images(spec), images = summed > 1 ? summed * n * number * (d + 2) : 0;
  const RunMemory density = stays + RunMemory{.particles = summed * n * number * (in_space(spec) ? 20 : 11) + images,
                                              .grid = number * (at_once * (in_space(spec) ? 4.5 : 3) +
                                                                (at_once + layers) * derivatives * 3 + layers)};
  // An output: density, velocity at the particles, exact density with the feet of its paths.
  const bool traced = spec.reference.kind == ReferenceSpec::Kind::characteristics && extent.compared_everywhere;
  const RunMemory shown =
      stays + RunMemory{.particles = n * number * d,
                        .grid = m * number + at_once * number * (derivatives + files.field_numbers) +
                                (extent.compared_everywhere ? m * number * (2 + (traced ? d + 1 : 0)) : 0)};
  const auto larger = [](const RunMemory& a, const RunMemory& b) { return a.all() < b.all() ? b : a; };
  RunMemory output = shown + RunMemory{.particles = n * number * d};
  const RunMemory piece{.grid = in_pieces ? number * (at_once + layers) : 0};
  for (const OutputFile& file : spec.output.files)
    output = larger(output, shown + piece + memory_of_file(write::find_output_file(file.name), files));
  if (pictures) output = output + RunMemory{.grid = m * number};
  // The error budget carries particles near a few probes once more, within a share of the run's work.
  const RunMemory budget =
      stays + copy + RunMemory{.particles = explained ? std::min(most_of_budget, budget_of_particle * n) : 0};
  const RunMemory drawing{.pictures = memory_of_drawing(spec)};
  return drawing + larger(larger(larger(seed, step), budget), larger(density + copy, output + copy));
}

std::string what_memory_is_for(const RunMemory& run, double program, const Extent& extent) {
  std::vector<std::pair<double, std::string>> parts{
      {run.particles, fmt::format("for {:.3g} particles", extent.particles)},
      {run.grid, fmt::format("for {:.3g} grid points", extent.grid_points)},
      {run.pictures, "for pictures"},
      {program, "for the program"}};
  std::sort(parts.begin(), parts.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::string text;
  for (const auto& [bytes, what] : parts)
    if (bytes > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", base::size_text(bytes), what);
  return text;
}

std::string how_to_lower(const RunMemory& run, double program) {
  if (run.all() < 0.1 * program) return "allow more memory: the program itself needs nearly all of it";
  std::vector<std::pair<double, std::string_view>> keys{{run.particles, "lower particles.per_axis"},
                                                        {run.grid, "lower evaluate.per_axis or evaluate.piece_points"},
                                                        {run.pictures, "set output.images = []"}};
  std::sort(keys.begin(), keys.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::string text;
  for (const auto& [bytes, key] : keys)
    if (bytes > 0.1 * run.all()) text += fmt::format("{}{}", text.empty() ? "" : ", or ", key);
  return text;
}

}  // namespace gaussdrift::accuracy

namespace gaussdrift {

using namespace accuracy;  // this is the public face of that module

void refuse_what_does_not_fit(const Case& spec, int threads, double most_memory) {
  const Domain& domain = spec.domain;
  const auto lattice = static_cast<double>(seeding_lattice(domain, spec.particles.per_axis).size());
  Extent extent{.lattice_points = lattice,
                .particles = lattice * (changes_particles(spec) ? 2 : 1) + particles_released(spec, threads),
                .grid_points = static_cast<double>(evaluation_lattice(spec).size()),
                .compared_everywhere = spec.reference.kind != ReferenceSpec::Kind::none};
  const auto fits = [&](const MemoryLimit& limit) { return memory_of_run(spec, extent).all() < limit.left(); };
  if (fits(tightest_limit(most_memory))) return;
  try {
    Trial trial = make_trial(spec, trial_particles, threads);
    extent.compared_everywhere =
        plan_comparison(spec, trial.scene, static_cast<std::size_t>(trial.carried), threads).points >=
        trial.scene.evaluation.size();
    extent.particles = particles_at_most(spec, trial);
  } catch (const InputError&) {
    extent.particles = 0;  // a density that a sample does not meet has few; the grid may be large all the same
  }
  const MemoryLimit limit = tightest_limit(most_memory);
  if (fits(limit)) return;
  const RunMemory run = memory_of_run(spec, extent);
  const double program = memory_of_this_process();
  throw InputError(fmt::format("the run would take about {} of memory, and {} {}: {}; {}",
                               base::size_text(run.all() + program), limit.who, base::size_text(limit.bytes),
                               what_memory_is_for(run, program, extent), how_to_lower(run, program)));
}

}  // namespace gaussdrift

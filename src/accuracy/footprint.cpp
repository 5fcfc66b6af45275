#include "accuracy/footprint.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/sysinfo.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

#include "accuracy/budget.hpp"
#include "accuracy/trial.hpp"
#include "effect/catalogue.hpp"
#include "gaussdrift/accuracy.hpp"
#include "gaussdrift/error.hpp"
#include "gaussdrift/simulation.hpp"
#include "render/picture_series.hpp"
#include "render/styles.hpp"
#include "sim/scene.hpp"

namespace gaussdrift::accuracy {

namespace {

constexpr double number = 8;  // bytes
constexpr std::size_t trial_particles = 100'000;

bool in_space(const Case& spec) { return spec.domain.dimension == 3; }

double limit_of(int resource) {
  rlimit limit{};
  if (getrlimit(static_cast<__rlimit_resource_t>(resource), &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
    return std::numeric_limits<double>::infinity();
  return static_cast<double>(limit.rlim_cur);
}

/// Of the group of processes that this one is put into (a container); nothing is limited where it says "max".
double limit_of_group() {
  double bytes = 0;
  for (const char* file : {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"})
    if (std::ifstream(file) >> bytes && bytes > 0) return bytes;
  return std::numeric_limits<double>::infinity();
}

}  // namespace

double disk_of_run(const Case& spec, const Extent& extent) {
  const auto frames = static_cast<double>(spec.output.times.size());
  double bytes = 1e4 + 250 * frames;
  for (const PictureStyle& style : spec.output.images) bytes += frames * render::find_style(style.name).cost.bytes;
  for (const OutputFile& file : spec.output.files) bytes += frames * write::find_output_file(file.name).bytes(extent);
  if (spec.output.report) bytes += 5e4 + (spec.output.images.empty() ? 0 : 5e5);  // the page and its picture
  return bytes;
}

double memory_of_run(const Case& spec, const Extent& extent) {
  const double n = extent.particles, m = extent.grid_points, d = spec.domain.dimension,
               frames = static_cast<double>(spec.output.times.size());
  EffectMemory effects;  // of all, a particle
  for (const auto& [effect, written] : effects_of(spec.effects)) {
    if (!effect->memory) continue;
    const EffectMemory one = effect->memory(written, spec.domain.dimension);
    effects.integrals += one.integrals, effects.columns += one.columns;
    effects.kept += one.kept, effects.step += one.step;
  }
  const bool pictures = !spec.output.images.empty();

  // What stays: positions, weights, ids, integrals, volumes; a halo's and a remeshing's tables of nodes.
  double particle = number * (d + 2 + effects.integrals + effects.columns);
  double stays = n * particle + n * effects.kept;
  // The last output is kept for the error budget and the page.
  const bool kept = spec.output.report || (spec.reference.kind != ReferenceSpec::Kind::none &&
                                           spec.accuracy.budget != AccuracySpec::Budget::none);
  const double copy = kept ? n * particle + m * number * (extent.compared_everywhere ? 2 : 1) : 0;
  if (pictures)
    stays +=
        std::min(frames * std::min(m, in_space(spec) ? 2.1e6 : m) * 4, static_cast<double>(render::most_kept_bytes));

  // Lines of the lattice are seeded one by one and joined.
  const double lines = extent.lattice_points / std::max(1.0, std::pow(extent.lattice_points, 1 / d));
  const double seed = 2 * n * particle + 450 * lines;
  double step = stays + 2 * n * number * (d + effects.integrals) + n * effects.step;

  // The transform holds the points sorted, with its boxes; in space boxes have more neighbours.
  const double density = stays + n * number * (in_space(spec) ? 20 : 11) + m * number * (in_space(spec) ? 4.5 : 3);
  // An output: density, velocity at the particles, exact density with the feet of its paths.
  const bool traced = spec.reference.kind == ReferenceSpec::Kind::characteristics && extent.compared_everywhere;
  const double shown =
      stays + m * number + n * number * d + (extent.compared_everywhere ? m * number * (2 + (traced ? d + 1 : 0)) : 0);
  double output = shown + n * number * d;
  for (const OutputFile& file : spec.output.files)
    output = std::max(output, shown + write::find_output_file(file.name).memory(extent));
  if (pictures) output = std::max(output, shown) + m * number;
  // The drawing library stays once it has drawn.
  const double drawing = pictures ? 1.4e8 : 0;
  return drawing + std::max({seed, step, density + copy, output + copy});
}

double memory_of_this_process() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

double memory_of_this_machine() {
  struct sysinfo machine {};
  double bytes = std::numeric_limits<double>::infinity();
  if (sysinfo(&machine) == 0)
    bytes = (static_cast<double>(machine.totalram) + static_cast<double>(machine.totalswap)) * machine.mem_unit;
  return std::min({bytes, limit_of(RLIMIT_AS), limit_of(RLIMIT_DATA), limit_of_group()});
}

}  // namespace gaussdrift::accuracy

namespace gaussdrift {

using namespace accuracy;  // this is the public face of that module

void refuse_what_does_not_fit(const Case& spec, int threads) {
  const Domain& domain = spec.domain;
  const auto lattice =
      static_cast<double>(make_lattice(domain.dimension, domain.min, domain.max, spec.particles.per_axis).size());
  Extent extent{.lattice_points = lattice,
                .particles = lattice,
                .grid_points = static_cast<double>(evaluation_lattice(spec).size()),
                .compared_everywhere = spec.reference.kind != ReferenceSpec::Kind::none};
  const double there = memory_of_this_machine(), before = memory_of_this_process();
  if (before + memory_of_run(spec, extent) < there) return;
  try {
    extent.particles = make_trial(spec, trial_particles, threads).carried;
  } catch (const InputError&) {
    extent.particles = 0;  // a density that a sample does not meet has few; the grid may be large all the same
  }
  const double needed = before + memory_of_run(spec, extent);
  if (needed < there) return;
  throw InputError(fmt::format(
      "the run would take about {:.3g} GB of memory for {:.3g} particles and {:.3g} grid points, and there are {:.3g} "
      "GB; lower {}",
      needed / 1e9, extent.particles, extent.grid_points, there / 1e9,
      extent.particles > extent.grid_points ? "particles.per_axis" : "evaluate.per_axis"));
}

}  // namespace gaussdrift

// The frames of an animation: the density between outputs, for observers alone.
#include <algorithm>
#include <iterator>
#include <utility>

#include "base/has_one.hpp"
#include "base/seam.hpp"
#include "gaussdrift/error.hpp"
#include "sim/fields_on_grid.hpp"
#include "sim/landings.hpp"
#include "sim/moments.hpp"
#include "sim/run_parts.hpp"

namespace gaussdrift {

namespace {

/// Every k-th point of each axis.
std::vector<double> thinned(const std::vector<double>& values, std::size_t components, const Lattice& full,
                            const Lattice& thin, std::size_t every) {
  std::vector<double> kept;
  kept.reserve(thin.size() * components);
  for (std::size_t k = 0; k < thin.points[2]; ++k)
    for (std::size_t j = 0; j < thin.points[1]; ++j)
      for (std::size_t i = 0; i < thin.points[0]; ++i) {
        const std::size_t point = every * (i + full.points[0] * (j + full.points[1] * k));
        for (std::size_t c = 0; c < components; ++c) kept.push_back(values[components * point + c]);
      }
  return kept;
}

}  // namespace

bool Simulation::Parts::is_moment(double time) const {
  return std::binary_search(moments_.begin(), moments_.end(), time);
}

// Whether something happens at a landing beside a frame.
bool Simulation::Parts::is_landing_of_case(double time) const {
  return moments_.empty() || std::binary_search(of_case_.begin(), of_case_.end(), time);
}

void Simulation::Parts::plan_moments() {
  of_case_ = landings_without_moments(case_);
  moments_ = moments(case_, of_case_);
  if (!moments_.empty() && in_pieces())
    throw InputError(
        "an animation shows the whole grid, and evaluate.piece_points divides it into pieces; raise "
        "evaluate.piece_points, take a coarser grid, or leave output.animation out");
}

// On rank 0, with tolerance and derivatives as density_options() tells.
DensityGrid Simulation::Parts::sum_moment(DensityReport& report) {
  if (!place_.one_tile()) return sum_tiles(report);
  DensityGrid density;
  on_first([&] {
    Particles images;
    density =
        evaluate_at_once(summed(images), blob(), lattice_of_moments(scene_.evaluation), density_options(), &report);
  });
  return density;
}

void Simulation::Parts::show_moment(double time) {
  place(time);
  Frame frame;
  frame.index = static_cast<int>(moments_shown_);
  frame.time = case_.time.at(time);
  frame.elapsed = time;
  showing_moment_ = true;
  DensityReport report;
  DensityGrid density = sum_moment(report);
  add_tracers_of_moment(density);
  showing_moment_ = false;
  on_first([&] {
    if (moment_has_fields()) {
      std::vector<FieldOnGrid> fields =
          fields_on_grid(case_.output, density.lattice, {{}, density.lattice.points}, report.derivatives,
                         scene_.velocity->shown(), frame.time, threads_);
      std::move(fields.begin(), fields.end(), std::back_inserter(density.fields));
    }
    const Lattice thin = lattice_of_moments(scene_.evaluation);
    if (density.lattice.points != thin.points) {
      const std::size_t every = thinning_of_moments(scene_.evaluation);
      density.rho = thinned(density.rho, 1, density.lattice, thin, every);
      for (FieldOnGrid& field : density.fields)
        field.values = thinned(field.values, static_cast<std::size_t>(field.components), density.lattice, thin, every);
      density.lattice = thin;
    }
    frame.density = &density;
    frame.particles = &particles_;
    for (const auto& observer : observers) {
      base::seam();
      observer->moment(frame);
    }
  });
  ++moments_shown_;
  last_moment_ = time;
}

// False if it was abandoned: then it is not counted.
bool Simulation::Parts::show_moment_or_abandon(double time) {
  try {
    const base::AbandonableTogether while_it_lasts(ranks_, abandon_wanted());
    summary_.stages.run("animation", [&] { show_moment(time); });
    return true;
  } catch (const base::Abandoned&) {
    showing_moment_ = false;
    return false;
  }
}

// Pictures of fields, or with the velocity over them.
bool Simulation::Parts::moment_has_fields() const {
  const PicturesSpec& pictures = case_.output.pictures;
  return !pictures.field.empty() || !pictures.velocity.empty() ||
         std::any_of(case_.output.images.begin(), case_.output.images.end(),
                     [](const PictureStyle& style) { return !style.needs_field.empty(); });
}

}  // namespace gaussdrift

// What an output of a run shows of each named density.
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "effect/tracer_reactions.hpp"
#include "reference/formula.hpp"
#include "reference/norms.hpp"
#include "sim/run_parts.hpp"

namespace gaussdrift {

namespace {

/// Weights of a tracer in the place of the others, as long as it lives.
class InPlaceOfWeights {
 public:
  InPlaceOfWeights(Particles& particles, std::size_t tracer)
      : weights_(particles.alpha), tracer_(particles.tracers[tracer]) {
    weights_.swap(tracer_);
  }
  ~InPlaceOfWeights() { weights_.swap(tracer_); }
  InPlaceOfWeights(const InPlaceOfWeights&) = delete;
  InPlaceOfWeights& operator=(const InPlaceOfWeights&) = delete;

 private:
  std::vector<double>&weights_, &tracer_;
};

}  // namespace

void pass_tracers(base::StateBytes& bytes, std::vector<TracerNumbers>& tracers) {
  std::uint64_t count = tracers.size();
  bytes(count);
  if (count > most_tracers) throw std::out_of_range("there are too many named densities");
  tracers.resize(count);
  for (TracerNumbers& one : tracers)
    bytes(one.name, one.mass, one.minimum, one.maximum, one.released, one.reacted, one.left, one.error);
}

// Their numbers that follow from the particles. All ranks call it together.
std::vector<TracerNumbers> Simulation::Parts::count_tracers() const {
  std::vector<TracerNumbers> all;
  if (case_.tracers.empty()) return all;
  const std::vector<double> masses =
      place_.sums(particles_, case_.tracers.size(), threads_, [&](std::size_t j, double* of_particle) {
        for (std::size_t k = 0; k < particles_.tracers.size(); ++k) of_particle[k] = particles_.tracers[k][j];
      });
  for (std::size_t k = 0; k < case_.tracers.size(); ++k) {
    TracerNumbers& one = all.emplace_back(TracerNumbers{.name = case_.tracers[k].name, .mass = masses[k]});
    if (releases_.possible()) one.released = releases_.released(k);
    one.reacted = carrier_.reacted(k);
    if (carrier_.departures().possible()) one.left = carrier_.departures().left_of_tracer(k);
  }
  return all;
}

// Where each named density has blobs of its own width, there is no transform of all: what each has is added up.
DensityGrid Simulation::Parts::sum_unless_tracers_do(DensityReport& report) {
  if (scene_.spreading_of_tracers.empty()) return sum_density(report);
  DensityGrid density;
  on_first([&] { density = {scene_.evaluation, std::vector<double>(scene_.evaluation.size(), 0.0)}; });
  return density;
}

// Their densities, as further fields of the grid: one Gauss transform each, over the same points. `whole`: of the sum.
void Simulation::Parts::sum_tracers(double time, DensityGrid& density, std::vector<TracerNumbers>& numbers,
                                    DensityReport& whole) {
  const bool adds_up = !scene_.spreading_of_tracers.empty();
  double error = 0;
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    DensityReport report;
    DensityGrid own;
    {
      const InPlaceOfWeights weights(particles_, k);
      tracer_alone_ = true;
      if (adds_up) part_of_spread_ = scene_.spreading_of_tracers[k];
      own = sum_density(report);
      tracer_alone_ = false;
      part_of_spread_ = 1;
    }
    summary_.stages.add("density", report.evaluate_seconds);
    summary_.stages.add("measure transform error", report.measure_seconds);
    summary_.transform_achievable = std::max(summary_.transform_achievable, report.achievable);
    on_first([&] {
      const auto [low, high] = std::minmax_element(own.rho.begin(), own.rho.end());
      numbers[k].minimum = *low, numbers[k].maximum = *high;
      if (const std::string& exact = case_.tracers[k].exact; !exact.empty()) {
        std::vector<double> rho;
        const auto clock = [clock = case_.time](double elapsed) { return clock.at(elapsed); };
        if (formula(exact, case_.params, scene_.evaluation, clock)->evaluate(time, rho).untraced == 0)
          numbers[k].error = compare(own.lattice, own.rho, rho);
      }
      if (adds_up) {
        for (std::size_t i = 0; i < own.rho.size(); ++i) density.rho[i] += own.rho[i];
        error += report.measured_error * std::max(std::abs(*low), std::abs(*high));
        whole.requested_tolerance =
            k == 0 ? report.requested_tolerance : std::min(whole.requested_tolerance, report.requested_tolerance);
        whole.evaluate_seconds += report.evaluate_seconds;
      }
      density.fields.push_back({numbers[k].name, 1, std::move(own.rho)});
    });
    if (adds_up) summary_.transform_choice = report.choice;
  }
  if (!adds_up) return;
  on_first([&] {
    double largest = 0;
    for (const double rho : density.rho) largest = std::max(largest, std::abs(rho));
    whole.measured_error = largest > 0 ? error / largest : error;
  });
}

void Simulation::Parts::add_tracers_of_moment(DensityGrid& density) {
  for (std::size_t k = 0; k < case_.tracers.size(); ++k) {
    DensityReport report;
    const InPlaceOfWeights weights(particles_, k);
    tracer_alone_ = true;
    DensityGrid own = sum_moment(report);
    tracer_alone_ = false;
    on_first([&] { density.fields.push_back({case_.tracers[k].name, 1, std::move(own.rho)}); });
  }
}

}  // namespace gaussdrift

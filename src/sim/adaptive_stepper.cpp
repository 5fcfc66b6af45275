#include "sim/adaptive_stepper.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>

#include "base/parallel.hpp"
#include "field/velocity/value_seconds.hpp"
#include "gaussdrift/error.hpp"
#include "reference/lost_velocity.hpp"
#include "sim/stepper.hpp"
#include "time/runge_kutta.hpp"

namespace gaussdrift {

namespace {

constexpr std::size_t usual_block = 256;  // as in stepper.cpp

// The usual controller. The error of a step goes like its length to the power of the order. The aim is 0.9 of what is
// allowed. Lengths change by bounded factors, so that one lucky or unlucky estimate does no harm.
constexpr double safety = 0.9, shrink_most = 0.2, grow_most = 5;

double factor_for(double error, int order) {
  if (!std::isfinite(error)) return shrink_most;
  return std::clamp(safety * std::pow(error, -1.0 / order), shrink_most, grow_most);
}

}  // namespace

AdaptiveStepper::Largest AdaptiveStepper::attempt(const Particles& particles, double time, double step,
                                                  std::vector<std::vector<double>>& results) {
  const auto dimension = static_cast<std::size_t>(particles.dimension), rows = dimension + rows_of(integrals_);
  const std::size_t blocks = results.size(), block_length = drifts_.empty() ? usual_block : particles.size();
  base::Communicator* const together = drifts_.empty() ? nullptr : &ranks_;  // who talks within a step
  std::vector<Largest> largest(blocks);
  const base::Pieces pieces(
      blocks, static_cast<double>(particles.size()) * static_cast<double>(tableau_.stages) * value_seconds(velocity_));
  const auto attempt_block = [&](std::size_t b) {
    const std::size_t begin = b * block_length, length = std::min(block_length, particles.size() - begin);
    std::vector<double>& state = results[b];
    state.resize(length * rows);
    for (std::size_t k = 0; k < rows; ++k)
      std::copy_n((k < dimension ? particles.position[k] : particles.path[k - dimension]).data() + begin, length,
                  state.data() + k * length);
    time::Stages work(tableau_, state.size());
    const auto rate = [&](double t, const double* x, double* u) {
      PointsView points{particles.dimension, length, {}};
      VectorsView vectors{particles.dimension, length, {}};
      for (std::size_t k = 0; k < dimension; ++k) points.axis[k] = x + k * length, vectors.axis[k] = u + k * length;
      std::fill_n(u, length * rows, 0.0);
      if (drifts_.empty())
        velocity_.add(t, points, vectors);
      else
        drift_seconds_ +=
            add_flow_and_drifts(velocity_, drifts_, t, particles, points, vectors, options_.threads, &ranks_);
      agree_on(together, [&] {
        std::size_t row = dimension;
        for (const PathIntegral* integral : integrals_) {
          integral->add_rates(t, particles, begin, points, x + row * length, u + row * length);
          row += integral->rows();
        }
      });
    };
    time::step(tableau_, time, step, rate, state.data(), work);
    for (std::size_t i = 0; i < state.size(); ++i) {
      double error = 0;
      for (std::size_t s = 0; s < work.rates.size(); ++s) error += tableau_.error_weights[s] * work.rates[s][i];
      const double unit = i < dimension * length ? options_.length : 1;
      const double relative = std::abs(step * error) / (options_.tolerance * unit);
      if (std::isfinite(state[i]) && relative <= largest[b].error) continue;
      largest[b] = {
          std::isfinite(relative) && std::isfinite(state[i]) ? relative : std::numeric_limits<double>::infinity(),
          begin + i % length};
      if (!std::isfinite(largest[b].error)) return;
    }
  };
  if (drifts_.empty())
    base::parallel_for(pieces, options_.threads, attempt_block);
  else
    attempt_block(0);
  Largest worst;
  for (const Largest& block : largest)
    if (block.error > worst.error) worst = block;
  return worst;
}

double AdaptiveStepper::advance(Particles& particles, double time, double end, std::size_t steps_before) {
  const auto dimension = static_cast<std::size_t>(particles.dimension), rows = dimension + rows_of(integrals_);
  const double most = options_.largest_step > 0 ? options_.largest_step : end - time;
  if (proposal_ <= 0) proposal_ = std::min(most, end - time);
  // Particles that move each other are one block.
  const std::size_t block_length = drifts_.empty() ? usual_block : std::max<std::size_t>(1, particles.size());
  std::vector<std::vector<double>> results(drifts_.empty() ? (particles.size() + block_length - 1) / block_length : 1);
  for (;;) {
    const double left = end - time;
    double step = std::min(proposal_, most);
    const bool lands = step >= left * (1 - 1e-9);
    if (lands)
      step = left;
    else if (step > left / 2)
      step = left / 2;  // two equal steps rather than a long one and a crumb
    Largest worst;
    agree_on(drifts_.empty() ? &ranks_ : nullptr, [&] { worst = attempt(particles, time, step, results); });
    double error = worst.error;  // of any particle
    ranks_.max(std::span(&error, 1));
    const double factor = factor_for(error, tableau_.time_order);
    if (error <= 1) {
      for (std::size_t b = 0; b < results.size(); ++b) {
        const std::size_t begin = b * block_length, length = std::min(block_length, particles.size() - begin);
        for (std::size_t k = 0; k < rows; ++k)
          std::copy_n(results[b].data() + k * length, length,
                      (k < dimension ? particles.position[k] : particles.path[k - dimension]).data() + begin);
      }
      // A step that was shortened to land says nothing against the longer one.
      proposal_ = step < proposal_ ? std::max(proposal_, step * factor) : step * factor;
      return lands ? end : time + step;
    }
    ++rejected_;
    proposal_ = step * std::min(factor, 0.9);
    if (time + proposal_ / 16 != time && proposal_ >= 1e-13 * left) continue;
    ranks_.agree_on([&] {
      if (worst.error == error && particles.size() > 0)
        throw NumericalError(why_no_step(particles, worst.particle, time, steps_before + 1));
    });
  }
}

std::string AdaptiveStepper::why_no_step(const Particles& particles, std::size_t worst, double time,
                                         std::size_t step) const {
  const Vector x = particles.view().at(worst);
  std::string place;
  for (int k = 0; k < particles.dimension; ++k) place += fmt::format("{}{:.6g}", k ? ", " : "", x[k]);
  const std::string reason = why_path_ends(velocity_, time, particles.dimension, x, 1e-6 * options_.length);
  const double shown = velocity_.shown_time(time);
  if (!reason.empty())
    return fmt::format("in step {} at t = {:.10g} particle {} at ({}) comes to a place without a velocity: {}", step,
                       shown, particles.id[worst], place, reason);
  return fmt::format(
      "no step is short enough for time.tolerance = {:g} in step {} at t = {:.10g}: particle {} at ({}) moves too "
      "fast, or the velocity is not finite there; guard the expression, raise the tolerance or shorten time.end",
      options_.tolerance, step, shown, particles.id[worst], place);
}

}  // namespace gaussdrift

#include "effect/tracer_reactions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "gaussdrift/error.hpp"

namespace gaussdrift {

namespace {

/// Tracers, then place and time.
std::vector<std::string> variables_of(const Case& spec) {
  std::vector<std::string> names;
  for (const TracerSpec& tracer : spec.tracers) names.push_back(tracer.name);
  names.insert(names.end(), {"x", "y"});
  if (spec.domain.dimension == 3) names.emplace_back("z");
  names.emplace_back("t");
  return names;
}

/// A few numbers between 0 and 1 that look like chance and are always the same.
double scattered(int i) { return std::fmod(0.5 + i * std::numbers::phi, 1.0); }

bool close(double a, double b) { return a == b || std::abs(a - b) <= 1e-9 * std::max(std::abs(a), std::abs(b)); }

bool is_linear(const Expression& gain, const Case& spec) {
  const std::size_t tracers = spec.tracers.size();
  const auto dimension = static_cast<std::size_t>(spec.domain.dimension);
  for (int sample = 0; sample < 8; ++sample) {
    std::vector<double> at(tracers + dimension + 1);
    for (std::size_t k = 0; k < dimension; ++k)
      at[tracers + k] = spec.domain.min[k] + (spec.domain.max[k] - spec.domain.min[k]) * scattered(7 * sample + int(k));
    at.back() = spec.time.at(spec.time.end * scattered(7 * sample + 3));
    const auto value = [&](const std::vector<double>& c) {
      std::copy(c.begin(), c.end(), at.begin());
      return gain.evaluate(at);
    };
    std::vector<double> one(tracers), two(tracers), both(tracers), scaled(tracers);
    for (std::size_t k = 0; k < tracers; ++k) {
      one[k] = 0.1 + scattered(11 * sample + 2 * int(k)), two[k] = 0.1 + scattered(13 * sample + 3 * int(k));
      both[k] = one[k] + two[k];
    }
    const double of_one = value(one), of_two = value(two);
    if (std::abs(value(both) - of_one - of_two) > 1e-9 * (std::abs(of_one) + std::abs(of_two))) return false;
    for (const double times : {0.0, 1e-9, 1e-4, 1e-2, 1e2, 1e4, 1e9, -1.0}) {
      for (std::size_t k = 0; k < tracers; ++k) scaled[k] = times * one[k];
      if (!close(value(scaled), times * of_one)) return false;
    }
  }
  return true;
}

}  // namespace

bool tracers_react(const Case& spec) {
  return std::any_of(spec.tracers.begin(), spec.tracers.end(),
                     [](const TracerSpec& tracer) { return !tracer.gain.empty() || tracer.half_life; });
}

bool tracers_react_linearly(const Case& spec) {
  return std::all_of(spec.tracers.begin(), spec.tracers.end(), [&](const TracerSpec& tracer) {
    return tracer.gain.empty() || is_linear(Expression(tracer.gain, variables_of(spec), spec.params), spec);
  });
}

TracerReactions::TracerReactions(const Case& spec, const VelocityField& velocity, double cell, bool volumes_are_kept)
    : velocity_(velocity),
      clock_(spec.time),
      dimension_(spec.domain.dimension),
      cell_(cell),
      unit_(cell),
      follows_volume_(!velocity.is_solenoidal() && !tracers_react_linearly(spec)),
      volumes_are_kept_(volumes_are_kept),
      stable_step_(std::numeric_limits<double>::infinity()) {
  for (const TracerSpec& tracer : spec.tracers) {
    names_.push_back(tracer.name);
    texts_.push_back(tracer.gain);
    gains_.emplace_back();
    if (!tracer.gain.empty()) gains_.back().emplace_back(tracer.gain, variables_of(spec), spec.params);
    decay_.push_back(tracer.half_life ? std::numbers::ln2 / *tracer.half_life : 0);
  }
}

std::string TracerReactions::describe() const {
  std::string text;
  for (std::size_t k = 0; k < names_.size(); ++k) {
    std::string right = texts_[k];
    if (decay_[k] > 0) right += fmt::format("{}{:g} {}", right.empty() ? "-" : " - ", decay_[k], names_[k]);
    text += fmt::format("{}{}' = {}", text.empty() ? "" : ", ", names_[k], right.empty() ? "0" : right);
  }
  return "along the paths " + text;
}

void TracerReactions::look_at(const Particles& sample) {
  double largest = 0;
  for (const double alpha : sample.alpha) largest = std::max(largest, std::abs(alpha));
  if (largest > 0) unit_ = largest;
}

// Steps of every method here are stable where its length times the largest rate is below 2, on the negative axis.
void TracerReactions::begin(Particles& particles, double time) {
  if (follows_volume_ && !volumes_are_kept_) particles.volume.assign(particles.size(), cell_);
  constexpr std::size_t most = 1000;
  const std::size_t stride = (particles.size() + most - 1) / most, tracers = names_.size();
  double fastest = 0;
  for (std::size_t j = 0; j < particles.size(); j += std::max<std::size_t>(1, stride)) {
    std::vector<double> at(tracers + static_cast<std::size_t>(dimension_) + 1);
    for (std::size_t k = 0; k < particles.tracers.size(); ++k) at[k] = particles.tracers[k][j] / cell_;
    for (std::size_t k = 0; k < static_cast<std::size_t>(dimension_); ++k) at[tracers + k] = particles.position[k][j];
    at.back() = clock_.at(time);
    std::vector<const double*> arguments;
    for (const double& value : at) arguments.push_back(&value);
    for (std::size_t k = 0; k < tracers; ++k) {
      double sum = decay_[k];
      for (const Expression& gain : gains_[k]) {
        std::vector<std::size_t> of(tracers);
        std::vector<double> slopes(tracers);
        std::vector<double*> to;
        for (std::size_t l = 0; l < tracers; ++l) of[l] = l, to.push_back(&slopes[l]);
        gain.differentiate(arguments.data(), 1, of, nullptr, to.data());
        for (const double slope : slopes)
          if (std::isfinite(slope)) sum += std::abs(slope);
      }
      fastest = std::max(fastest, sum);
    }
  }
  if (fastest > 0) stable_step_ = 2 / fastest;
}

void TracerReactions::add_rates(double t, const Particles& particles, std::size_t first, const PointsView& x,
                                const double* gathered, double* rates) const {
  if (particles.tracers.empty()) return;
  const std::size_t count = x.count, tracers = names_.size();
  std::vector<double> concentrations(count * tracers), volumes(count, cell_), gain(count), times(count, clock_.at(t));
  const double direction = clock_.backwards ? -1 : 1;
  if (follows_volume_) {
    for (std::size_t i = 0; i < count; ++i)
      volumes[i] = particles.volume[first + i] * std::exp(gathered[tracers * count + i]);
    velocity_.add_divergence(t, x, rates + tracers * count);
  }
  std::vector<const double*> arguments;
  for (std::size_t k = 0; k < tracers; ++k) {
    double* const c = concentrations.data() + k * count;
    for (std::size_t i = 0; i < count; ++i)
      c[i] = (particles.tracers[k][first + i] + unit_ * gathered[k * count + i]) / volumes[i];
    arguments.push_back(c);
  }
  for (int k = 0; k < dimension_; ++k) arguments.push_back(x.axis[static_cast<std::size_t>(k)]);
  arguments.push_back(times.data());
  for (std::size_t k = 0; k < tracers; ++k) {
    std::fill(gain.begin(), gain.end(), 0.0);
    for (const Expression& expression : gains_[k]) expression.evaluate(arguments.data(), count, gain.data());
    const double* const c = concentrations.data() + k * count;
    for (std::size_t i = 0; i < count; ++i)
      rates[k * count + i] += direction * (gain[i] - decay_[k] * c[i]) * volumes[i] / unit_;
  }
}

void TracerReactions::settle(Particles& particles, const double* /*integral*/, double time) {
  if (particles.tracers.empty()) return;  // carried without weight, to where new particles stand
  const std::size_t first = particles.path.size() - rows(), tracers = names_.size();
  for (std::size_t k = 0; k < tracers; ++k) {
    const std::vector<double>& change = particles.path[first + k];
    for (std::size_t j = 0; j < particles.size(); ++j) {
      double& weight = particles.tracers[k][j];
      weight += unit_ * change[j];
      if (!std::isfinite(weight))
        throw NumericalError(
            fmt::format("the weight of {} of particle {} is too large for a number by t = {:.6g}. Shorten time.step or "
                        "time.end, or bring the rates nearer to 0.",
                        names_[k], particles.id[j], clock_.at(time)));
    }
  }
  if (follows_volume_ && !volumes_are_kept_)
    for (std::size_t j = 0; j < particles.size(); ++j)
      particles.volume[j] *= std::exp(particles.path[first + tracers][j]);
  add_up_tracers(particles);
}

}  // namespace gaussdrift

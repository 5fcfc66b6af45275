#include "effect/particle_exchange.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fgtd/fgtd.hpp>
#include <numbers>

#include "base/error.hpp"

namespace gaussdrift {

namespace {

constexpr double tolerance = 1e-10;       // of each Gaussian of the exchange
constexpr double significant = 1e-10;     // of the largest weight: less needs no halo of its own
constexpr double allowed_at_edge = 1e-6;  // of the weight
constexpr double most_particles = 1e8;

template <int d>
Eigen::MatrixXd sums_at_particles(const Particles& particles, const Eigen::MatrixXd& weights, double radius,
                                  int threads) {
  fgtd::Points<d> points(d, static_cast<Eigen::Index>(particles.size()));
  for (int k = 0; k < d; ++k)
    points.row(k) = Eigen::Map<const Eigen::RowVectorXd>(particles.position[k].data(), points.cols());
  fgtd::Options options;
  options.tolerance = tolerance;
  options.threads = threads;
  options.expected_targets = particles.size();
  const double peak = std::pow(std::sqrt(std::numbers::pi) * radius, -d);
  return peak * fgtd::Plan<d>(points, weights, 1 / (radius * radius), options).evaluate(points);
}

// Column by column, sum_k w_k G_eps(X_j - X_k).
Eigen::MatrixXd sums(const Particles& particles, const Eigen::MatrixXd& weights, double radius, int threads) {
  try {
    return particles.dimension == 2 ? sums_at_particles<2>(particles, weights, radius, threads)
                                    : sums_at_particles<3>(particles, weights, radius, threads);
  } catch (const fgtd::Error& error) {
    throw NumericalError(std::string("the exchange of [effects.diffusion] cannot be summed: ") + error.what());
  }
}

Eigen::Map<const Eigen::VectorXd> column(const std::vector<double>& values) {
  return {values.data(), static_cast<Eigen::Index>(values.size())};
}

// Grows the marked points of a lattice by `reach` points along every axis.
void dilate(std::vector<char>& marked, const Lattice& lattice, std::size_t reach) {
  std::size_t stride = 1;
  for (int k = 0; k < lattice.dimension; ++k) {
    const std::size_t length = lattice.points[static_cast<std::size_t>(k)];
    for (std::size_t start = 0; start < marked.size(); ++start) {
      if ((start / stride) % length != 0) continue;
      std::vector<std::size_t> before(length + 1, 0);  // marked points before each
      for (std::size_t i = 0; i < length; ++i) before[i + 1] = before[i] + (marked[start + i * stride] ? 1 : 0);
      for (std::size_t i = 0; i < length; ++i) {
        const std::size_t low = i < reach ? 0 : i - reach, high = std::min(length, i + reach + 1);
        marked[start + i * stride] = before[high] > before[low] ? 1 : 0;
      }
    }
    stride *= length;
  }
}

}  // namespace

std::string ParticleExchange::describe() const {
  return fmt::format("diffusion by particle exchange, D = {:g}", options_.coefficient);
}

void ParticleExchange::begin(Particles& particles, double time) {
  if (time > 0)
    throw InputError(
        "effects.diffusion.method = \"particle-exchange\" does not know the volumes of particles that another effect "
        "has "
        "replaced; use \"core-spreading\"");
  const Lattice& start = options_.lattice;
  const double spread =
      options_.halo > 0
          ? options_.halo
          : 7 * std::sqrt(2 * options_.coefficient * options_.end + options_.core_radius * options_.core_radius / 2);
  // Two points more are the edge, which nothing but the tail reaches.
  constexpr double edge_points = 2;
  const double margin = std::ceil(spread / start.spacing) + edge_points;
  Lattice around = start;
  double total = 1;
  for (int k = 0; k < start.dimension; ++k) {
    total *= static_cast<double>(start.points[static_cast<std::size_t>(k)]) + 2 * margin;
    around.origin[k] -= margin * start.spacing;
  }
  if (!(total <= most_particles))
    throw InputError(
        fmt::format("the halo of [effects.diffusion], {:.3g} wide, would have up to {:.2g} particles; lower "
                    "effects.diffusion.halo or particles.per_axis, or use method = \"core-spreading\"",
                    spread, total));
  const auto reach = static_cast<std::size_t>(margin);
  for (int k = 0; k < start.dimension; ++k) around.points[static_cast<std::size_t>(k)] += 2 * reach;

  const auto index_around = [&](std::int64_t id) {
    std::size_t rest = static_cast<std::size_t>(id), index = 0, stride = 1;
    for (int k = 0; k < start.dimension; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      index += (rest % start.points[axis] + reach) * stride;
      rest /= start.points[axis];
      stride *= around.points[axis];
    }
    return index;
  };
  double largest = 0;
  for (const double alpha : particles.alpha) largest = std::max(largest, std::abs(alpha));
  std::vector<char> inside(around.size(), 0), carried(around.size(), 0);
  for (std::size_t j = 0; j < particles.size(); ++j) {
    carried[index_around(particles.id[j])] = 1;
    if (std::abs(particles.alpha[j]) >= significant * largest) inside[index_around(particles.id[j])] = 1;
  }
  dilate(inside, around, reach - static_cast<std::size_t>(edge_points));
  std::vector<char> wanted = inside;
  dilate(wanted, around, static_cast<std::size_t>(edge_points));

  for (std::size_t j = 0; j < particles.size(); ++j)
    if (!inside[index_around(particles.id[j])]) edge_.push_back(j);
  for (std::size_t index = 0; index < around.size(); ++index) {
    if (!wanted[index] || carried[index]) continue;
    if (!inside[index]) edge_.push_back(particles.size());
    std::size_t rest = index;
    for (int k = 0; k < start.dimension; ++k) {
      const std::size_t length = around.points[static_cast<std::size_t>(k)];
      particles.position[k].push_back(around.coordinate(k, rest % length));
      rest /= length;
    }
    particles.alpha.push_back(0);
    particles.id.push_back(static_cast<std::int64_t>(start.size() + added_++));
  }
  particles.volume.assign(particles.size(), std::pow(start.spacing, start.dimension));
  const double densest = sums(particles, column(particles.volume), options_.core_radius, options_.threads).maxCoeff();
  stable_step_ = options_.core_radius * options_.core_radius / (2 * options_.coefficient * densest);
}

void ParticleExchange::settle(Particles& particles, const double* integral, double time) {
  for (std::size_t j = 0; j < particles.size(); ++j) {
    particles.volume[j] *= std::exp(integral[j]);
    if (!std::isfinite(particles.volume[j]))
      throw NumericalError(
          fmt::format("the volume of particle {} is too large for a number at t = {:.6g}; shorten time.end",
                      particles.id[j], time));
  }
}

void ParticleExchange::exchange(Particles& particles, double time, double length) {
  const double rate = 4 * options_.coefficient / (options_.core_radius * options_.core_radius);
  const Eigen::VectorXd alpha = column(particles.alpha), volume = column(particles.volume);
  const auto flow = [&](const Eigen::VectorXd& weight, const Eigen::VectorXd& summed, const Eigen::VectorXd& crowd) {
    return Eigen::VectorXd(rate * (volume.array() * summed.array() - weight.array() * crowd.array()));
  };
  Eigen::MatrixXd both(alpha.size(), 2);
  both << alpha, volume;
  const Eigen::MatrixXd first = sums(particles, both, options_.core_radius, options_.threads);
  const Eigen::VectorXd k1 = flow(alpha, first.col(0), first.col(1)), ahead = alpha + length * k1;
  const Eigen::VectorXd second = sums(particles, ahead, options_.core_radius, options_.threads);
  const Eigen::VectorXd after = alpha + length / 2 * (k1 + flow(ahead, second, first.col(1)));
  if (!after.allFinite())
    throw NumericalError(fmt::format("the exchange of [effects.diffusion] is not finite at t = {:.6g}", time));
  std::copy_n(after.data(), after.size(), particles.alpha.begin());

  double edge = 0;
  for (const std::size_t j : edge_) edge += std::abs(particles.alpha[j]);
  at_edge_ = std::max(at_edge_, edge / after.cwiseAbs().sum());
  if (at_edge_ > allowed_at_edge)
    throw NumericalError(fmt::format(
        "diffusion has carried {:.2g} of the weight to the edge of the particles at t = {:.6g}, where nothing "
        "can receive it; raise effects.diffusion.halo or shorten time.end",
        at_edge_, time));
}

Numbers ParticleExchange::numbers() const {
  return {{"D", options_.coefficient},
          {"halo_particles", static_cast<double>(added_)},
          {"largest_share_at_edge", at_edge_},
          {"stable_step", stable_step_}};
}

}  // namespace gaussdrift

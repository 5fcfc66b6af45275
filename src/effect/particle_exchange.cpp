#include "effect/particle_exchange.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fgtd/fgtd.hpp>
#include <numbers>
#include <set>

#include "base/users_words.hpp"
#include "effect/catalogue.hpp"
#include "gaussdrift/error.hpp"
#include "particle/fgtd_points.hpp"

namespace gaussdrift {

namespace {

// eta_eps(x) = eps^-d 4 pi^{-d/2} exp(-|x|^2/eps^2): second moments 2 delta_ij, so that
// eps^-2 int (f(y) - f(x)) eta_eps(x - y) dy = Laplacian f + O(eps^2).
double peak_of_eta(int dimension, double eps) { return 4 * std::pow(std::sqrt(std::numbers::pi) * eps, -dimension); }

Eigen::Map<const Eigen::VectorXd> column(const std::vector<double>& values) {
  return {values.data(), static_cast<Eigen::Index>(values.size())};
}

fgtd::Options sum_options(double tolerance, int threads) {
  fgtd::Options options;
  options.tolerance = tolerance;
  options.threads = threads;
  return options;
}

}  // namespace

ParticleExchange::ParticleExchange(const Lattice& lattice, double core_radius, const VelocityField& velocity,
                                   Follow follow, const Options& options)
    : nodes_(lattice),
      core_radius_(core_radius),
      velocity_(velocity),
      follow_(std::move(follow)),
      options_(options),
      solenoidal_(velocity.is_solenoidal()),
      // Beyond it eta is below the tolerance of its peak.
      halo_(static_cast<std::int64_t>(
          std::ceil(core_radius / lattice.spacing * std::sqrt(std::log(1 / options.tolerance))))) {
  // Already that of one particle.
  const double around = std::pow(2 * static_cast<double>(halo_) + 1, nodes_.dimension());
  if (around > static_cast<double>(options_.most_particles))
    throw InputError(fmt::format(
        "diffusion by particle exchange would surround each particle by {:.2g} others, {} lattice steps deep, and at "
        "most {:.2g} particles are possible. Lower particles.overlap, or raise [effects.diffusion] tolerance.",
        around, halo_, static_cast<double>(options_.most_particles)));
}

void ParticleExchange::refuse_so_many() const {
  throw NumericalError(
      fmt::format("diffusion by particle exchange needs more than {} particles. Lower particles.per_axis, raise "
                  "[effects.diffusion] tolerance, or shorten time.end.",
                  options_.most_particles));
}

std::string ParticleExchange::describe() const {
  return fmt::format("diffusion D Laplacian rho, D = {:g}, by particle exchange", options_.coefficient);
}

void ParticleExchange::find_nodes(const Particles& particles) {
  at_.clear();
  at_.reserve(particles.size());
  for (std::size_t j = 0; j < particles.size(); ++j) at_.emplace(particles.id[j], j);
}

void ParticleExchange::pass_state(base::StateBytes& bytes, const Particles& particles) {
  bytes(surrounded_, started_, most_, stable_step_);
  if (!bytes.reading()) return;
  if (surrounded_.size() != particles.size()) throw std::out_of_range("a halo belongs to other particles");
  find_nodes(particles);
}

void ParticleExchange::begin(Particles& particles, double /*time*/) {
  particles.volume.assign(particles.size(), nodes_.cell());
  find_nodes(particles);
  surrounded_.assign(particles.size(), 0);
  if (started_ == 0) started_ = particles.size();
  grow_halo(particles);
  const double rate = nodes_.dimension() == 2 ? largest_rate<2>(particles) : largest_rate<3>(particles);
  stable_step_ = 2 / rate;
}

void ParticleExchange::settle(Particles& particles, const double* integral, double time) {
  for (std::size_t j = 0; j < particles.size(); ++j) {
    particles.volume[j] *= std::exp(integral[j]);
    if (!std::isfinite(particles.volume[j]))
      throw NumericalError(
          fmt::format("the volume of particle {} is too large for a number at t = {:.6g}, because the velocity has "
                      "diverged for so long. Shorten time.end, or let {} renew the particles often.",
                      particles.id[j], time, restorers_table()));
  }
}

// Every particle above the tolerance gets particles on all nodes around it, up to the width of the halo. It is enough
// to look at particles with a neighbour below the tolerance: on the way from any other particle to a node around it
// lies one of these, and it is nearer to that node.
void ParticleExchange::grow_halo(Particles& particles) {
  double largest = 0;
  for (std::size_t j = 0; j < particles.size(); ++j)
    largest = std::max(largest, std::abs(particles.alpha[j]) / particles.volume[j]);
  const auto counts = [&](std::size_t j) {
    return std::abs(particles.alpha[j]) > options_.tolerance * largest * particles.volume[j];
  };
  const int dimension = particles.dimension;
  std::set<std::int64_t> missing;  // in ascending order, so that the new particles' order is always the same
  const std::size_t count = particles.size();
  for (std::size_t j = 0; j < count; ++j) {
    if (surrounded_[j] || !counts(j)) continue;
    surrounded_[j] = 1;
    const NodeIndex centre = nodes_.index(particles.id[j]);
    bool inside = true;
    for (int k = 0; k < dimension && inside; ++k)
      for (const int side : {-1, 1}) {
        NodeIndex next = centre;
        next[k] += side;
        const auto found = at_.find(nodes_.id(next));
        inside = inside && found != at_.end() && counts(found->second);
      }
    if (inside) continue;
    const std::int64_t depth = dimension > 2 ? halo_ : 0;
    for (std::int64_t z = -depth; z <= depth; ++z)
      for (std::int64_t y = -halo_; y <= halo_; ++y) {
        for (std::int64_t x = -halo_; x <= halo_; ++x) {
          if (x * x + y * y + z * z > halo_ * halo_) continue;
          const std::int64_t id = nodes_.id({centre[0] + x, centre[1] + y, centre[2] + z});
          if (at_.find(id) == at_.end()) missing.insert(id);
        }
        if (count + missing.size() > options_.most_particles) refuse_so_many();
      }
  }
  most_ = std::max(most_, count + missing.size());
  if (missing.empty()) return;

  // New particles come from their nodes by the flow, as if they had been carried without weight from the beginning.
  Particles fresh;
  fresh.dimension = dimension;
  for (const std::int64_t id : missing) {
    const Vector x = nodes_.position(nodes_.index(id));
    for (int k = 0; k < dimension; ++k) fresh.position[k].push_back(x[k]);
    fresh.id.push_back(id);
  }
  fresh.alpha.assign(fresh.id.size(), 0.0);
  fresh.volume.assign(fresh.id.size(), nodes_.cell());
  follow_(fresh);
  const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  for (int k = 0; k < dimension; ++k) append(particles.position[k], fresh.position[k]);
  append(particles.alpha, fresh.alpha);
  append(particles.id, fresh.id);
  append(particles.volume, fresh.volume);
  for (auto& integral : particles.path) integral.resize(particles.size(), 0.0);
  surrounded_.resize(particles.size(), 0);
  for (std::size_t j = count; j < particles.size(); ++j) at_.emplace(particles.id[j], j);
}

// (K f)_i = sum_j eta_eps(X_i - X_j) f_j. The exchange alpha' = L alpha, L = D/eps^2 (diag(V) K - diag(K V)), is
// similar to D/eps^2 (V^1/2 K V^1/2 - diag(K V)) with K positive definite, so its eigenvalues are at least -D/eps^2
// max_i (K V)_i; they are at most 0 because its columns add up to 0 and only its diagonal is negative.
template <int d>
double ParticleExchange::largest_rate(const Particles& particles) const {
  const fgtd::Points<d> points = points_of<d>(particles);
  const fgtd::Plan<d> plan(points, column(particles.volume), 1 / (core_radius_ * core_radius_),
                           sum_options(1e-6, options_.threads));
  const double most = plan.evaluate(points).maxCoeff() * peak_of_eta(d, core_radius_);
  return options_.coefficient / (core_radius_ * core_radius_) * most;
}

void ParticleExchange::exchange(Particles& particles, double time, double length) {
  if (length <= 0 || particles.size() == 0) return;
  try {
    if (particles.dimension == 2)
      exchange_in_dimension<2>(particles, time, length);
    else
      exchange_in_dimension<3>(particles, time, length);
  } catch (const fgtd::Error& error) {
    throw NumericalError(
        fmt::format("diffusion by particle exchange cannot be summed at t = {:.6g}: {}", time,
                    base::in_users_words(error.what(), {{"Options::tolerance = ", "a tolerance of "}})));
  }
  grow_halo(particles);
}

template <int d>
void ParticleExchange::exchange_in_dimension(Particles& particles, double time, double length) {
  const double eps = core_radius_, factor = options_.coefficient / (eps * eps) * peak_of_eta(d, eps);
  const fgtd::Points<d> points = points_of<d>(particles);
  const auto volume = column(particles.volume);
  Eigen::VectorXd alpha = column(particles.alpha);
  Eigen::MatrixXd weights(alpha.size(), 2);
  weights << volume, alpha;
  // The error of the sums is far below that of the halo.
  fgtd::Plan<d> plan(points, weights, 1 / (eps * eps), sum_options(1e-3 * options_.tolerance, options_.threads));
  const Eigen::MatrixXd sums = plan.evaluate(points);
  const Eigen::ArrayXd kv = sums.col(0).array();
  const double rate = factor * kv.maxCoeff();
  if (length * rate > 2 * (1 + 1e-6))  // 1e-6: the tolerance of largest_rate()
    throw NumericalError(
        fmt::format("diffusion by particle exchange is unstable at t = {:.6g}, because particles have come close "
                    "together. Use time.step <= {:.3g}, or let {} renew the particles often.",
                    time, 2 / rate, restorers_table()));
  // L applied to weights w whose sum K w is known. What one particle gives another receives; the tolerance of the sums
  // breaks that, and what is too much or too little is spread over all exchanges, so that the mass stays.
  const auto exchanged = [&](const Eigen::VectorXd& w, const Eigen::ArrayXd& kw) {
    const Eigen::ArrayXd gained = volume.array() * kw, given = w.array() * kv;
    Eigen::ArrayXd change = gained - given;
    const Eigen::ArrayXd size = gained.abs() + given.abs();
    if (const double all = size.sum(); all > 0) change -= change.sum() / all * size;
    return Eigen::VectorXd((factor * change).matrix());
  };
  // Heun's method; L does not change as long as positions stand: alpha + t L alpha + t^2/2 L^2 alpha.
  const Eigen::VectorXd first = exchanged(alpha, sums.col(1).array());
  plan.set_weights(first);
  const Eigen::VectorXd second = exchanged(first, plan.evaluate(points).col(0).array());
  alpha += length * first + length * length / 2 * second;
  Eigen::Map<Eigen::VectorXd>(particles.alpha.data(), alpha.size()) = alpha;
}

Numbers ParticleExchange::numbers() const {
  return {{"particles_at_start", static_cast<double>(started_)},
          {"particles_at_most", static_cast<double>(most_)},
          {"stable_step", stable_step_}};
}

}  // namespace gaussdrift

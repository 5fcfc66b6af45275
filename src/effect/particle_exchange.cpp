#include "effect/particle_exchange.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fgtd/fgtd.hpp>
#include <limits>
#include <numbers>
#include <span>
#include <unordered_set>
#include <utility>

#include "base/exact_sum.hpp"
#include "effect/catalogue.hpp"
#include "effect/diffusivity.hpp"
#include "effect/meeting_rank.hpp"
#include "effect/scattered_sums.hpp"
#include "gaussdrift/error.hpp"
#include "particle/placing.hpp"

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
    : ParticleExchange(lattice, core_radius, velocity, std::move(follow), options, alone_) {}

ParticleExchange::ParticleExchange(const Lattice& lattice, double core_radius, const VelocityField& velocity,
                                   Follow follow, const Options& options, base::Communicator& ranks)
    : ranks_(ranks),
      nodes_(lattice, options.ends.any()),
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
  if (options_.field)
    return fmt::format("diffusion div(D grad rho), D = {}, by particle exchange", options_.field->describe());
  return fmt::format("diffusion D Laplacian rho, D = {:g}, by particle exchange", options_.coefficient);
}

// All ranks: who has which node. Only halos that have been made are forgotten, and nothing is made twice.
void ParticleExchange::find_nodes(const Particles& particles) {
  const auto ranks = static_cast<std::size_t>(ranks_.size());
  std::vector<std::vector<std::int64_t>> ids(ranks);
  ranks_.agree_on([&] {
    index_nodes(particles);
    surrounded_.assign(particles.size(), 0);
    if (ranks == 1) return;
    for (const std::int64_t id : particles.id) ids[meeting(id)].push_back(id);
  });
  known_ = true;
  if (ranks == 1) return;
  there_are_.clear();
  for (const auto& of_rank : exchanged(std::move(ids))) there_are_.insert(of_rank.begin(), of_rank.end());
}

void ParticleExchange::index_nodes(const Particles& particles) {
  at_.clear();
  at_.reserve(particles.size());
  for (std::size_t j = 0; j < particles.size(); ++j) at_.emplace(particles.id[j], j);
}

std::size_t ParticleExchange::meeting(std::int64_t id) const {
  return meeting_rank(nodes_.index(id), nodes_.dimension(), static_cast<std::size_t>(ranks_.size()));
}

std::vector<std::vector<std::int64_t>> ParticleExchange::exchanged(
    std::vector<std::vector<std::int64_t>> numbers) const {
  std::vector<base::Bytes> out;
  for (std::vector<std::int64_t>& of_rank : numbers) out.push_back(base::to_bytes(std::exchange(of_rank, {})));
  std::vector<std::vector<std::int64_t>> in;
  for (const base::Bytes& bytes : ranks_.exchange(std::move(out))) in.push_back(base::from_bytes<std::int64_t>(bytes));
  return in;
}

void ParticleExchange::pass_state(base::StateBytes& bytes, const Particles& /*particles*/) {
  std::vector<char> surrounded;  // earlier versions kept it; it is found again
  bytes(surrounded, started_, most_, stable_step_);
  if (bytes.reading()) known_ = false;
}

std::size_t ParticleExchange::count_of_all(const Particles& particles) const {
  auto count = static_cast<std::int64_t>(particles.size());
  ranks_.sum(std::span(&count, 1));
  return static_cast<std::size_t>(count);
}

void ParticleExchange::begin(Particles& particles, double time) {
  ranks_.agree_on([&] { particles.volume.assign(particles.size(), nodes_.cell()); });
  find_nodes(particles);
  if (started_ == 0) started_ = count_of_all(particles);
  grow_halo(particles);
  double rate = 0;
  const auto look_at = [&](double when) {
    rate =
        std::max(rate, nodes_.dimension() == 2 ? largest_rate<2>(particles, when) : largest_rate<3>(particles, when));
  };
  look_at(time);
  if (options_.field && !options_.field->is_steady()) look_at((time + options_.end) / 2), look_at(options_.end);
  stable_step_ = rate > 0 ? 2 / rate : std::numeric_limits<double>::infinity();
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
// lies one of these, and it is nearer to that node. So a halo that is there is complete, whoever looks at it again.
void ParticleExchange::grow_halo(Particles& particles) {
  if (!known_) find_nodes(particles);
  const std::vector<char> counts = that_count(particles);
  const std::vector<std::size_t> at_edge = edge(particles, counts);
  const std::size_t count = count_of_all(particles);
  std::set<std::int64_t> missing;  // in ascending order, so that the new particles' order is always the same
  ranks_.agree_on([&] { missing = missing_around(particles, at_edge, count); });
  if (ranks_.size() > 1) missing = made_here(missing);
  auto made = static_cast<std::int64_t>(missing.size());
  ranks_.sum(std::span(&made, 1));
  ranks_.agree_on([&] {
    if (count + static_cast<std::size_t>(made) > options_.most_particles) refuse_so_many();
  });
  most_ = std::max(most_, count + static_cast<std::size_t>(made));
  if (made > 0) ranks_.agree_on([&] { add(missing, particles); });
}

// Those with more than the tolerance of the largest density, of one tracer at least.
std::vector<char> ParticleExchange::that_count(const Particles& particles) const {
  std::vector<const std::vector<double>*> weights{&particles.alpha};
  if (!options_.of_tracers.empty()) {
    weights.clear();
    for (const std::vector<double>& tracer : particles.tracers) weights.push_back(&tracer);
  }
  std::vector<double> largest(std::max<std::size_t>(1, options_.of_tracers.size()), 0.0);
  for (std::size_t k = 0; k < weights.size(); ++k)
    for (std::size_t j = 0; j < particles.size(); ++j)
      largest[k] = std::max(largest[k], std::abs((*weights[k])[j]) / particles.volume[j]);
  ranks_.max(std::span(largest));
  std::vector<char> counts(particles.size(), 0);
  for (std::size_t k = 0; k < weights.size(); ++k)
    for (std::size_t j = 0; j < particles.size(); ++j)
      counts[j] = counts[j] || std::abs((*weights[k])[j]) > options_.tolerance * largest[k] * particles.volume[j];
  return counts;
}

// What is exchanged: the weights, or those of each tracer.
std::vector<std::vector<double>*> ParticleExchange::weights_of(Particles& particles) const {
  if (options_.of_tracers.empty()) return {&particles.alpha};
  particles.tracers.resize(options_.of_tracers.size());  // a rank without particles may have none
  std::vector<std::vector<double>*> weights;
  for (std::vector<double>& tracer : particles.tracers) weights.push_back(&tracer);
  return weights;
}

template <class Use>
void ParticleExchange::for_each_neighbour(std::int64_t id, const Use& use) const {
  const NodeIndex centre = nodes_.index(id);
  for (int k = 0; k < nodes_.dimension(); ++k)
    for (const int side : {-1, 1}) {
      NodeIndex next = centre;
      next[k] = options_.ends.fold(k, next[k] + side);
      use(nodes_.id(next));
    }
}

// The particles that count, are not surrounded yet, and have a neighbour that does not count. All that count are
// surrounded afterwards.
std::vector<std::size_t> ParticleExchange::edge(const Particles& particles, const std::vector<char>& counts) {
  std::vector<std::size_t> at_edge;
  std::vector<std::pair<std::int64_t, std::size_t>> open;  // a neighbour that is perhaps elsewhere, and whose it is
  ranks_.agree_on([&] {
    std::vector<std::int64_t> elsewhere;
    for (std::size_t j = 0; j < particles.size(); ++j) {
      if (surrounded_[j] || !counts[j]) continue;
      surrounded_[j] = 1;
      elsewhere.clear();
      bool inside = true;
      for_each_neighbour(particles.id[j], [&](std::int64_t id) {
        if (const auto found = at_.find(id); found != at_.end())
          inside = inside && counts[found->second];
        else
          elsewhere.push_back(id);
      });
      if (inside && (ranks_.size() > 1 || elsewhere.empty()))
        for (const std::int64_t id : elsewhere) open.emplace_back(id, j);
      else
        at_edge.push_back(j);
    }
  });
  auto asks = static_cast<std::int64_t>(open.size());  // of any rank
  ranks_.max(std::span(&asks, 1));
  if (asks == 0) return at_edge;
  const std::vector<char> count_there = count_elsewhere(particles, counts, open);
  for (std::size_t i = 0; i < open.size(); ++i)
    if (!count_there[i]) at_edge.push_back(open[i].second);
  std::sort(at_edge.begin(), at_edge.end());
  at_edge.erase(std::unique(at_edge.begin(), at_edge.end()), at_edge.end());
  return at_edge;
}

// Whether particles count that are not here. Those that have a neighbour elsewhere are told to the rank where they meet,
// and it is asked.
std::vector<char> ParticleExchange::count_elsewhere(
    const Particles& particles, const std::vector<char>& counts,
    const std::vector<std::pair<std::int64_t, std::size_t>>& asked) const {
  const auto ranks = static_cast<std::size_t>(ranks_.size());
  std::vector<std::vector<std::int64_t>> told(ranks), asks(ranks);
  std::vector<std::size_t> at(asked.size());  // the rank that is asked
  ranks_.agree_on([&] {
    for (std::size_t j = 0; j < particles.size(); ++j) {
      if (!counts[j]) continue;
      bool all_here = true;
      for_each_neighbour(particles.id[j], [&](std::int64_t id) { all_here = all_here && at_.count(id) > 0; });
      if (!all_here) told[meeting(particles.id[j])].push_back(particles.id[j]);
    }
    for (std::size_t i = 0; i < asked.size(); ++i) asks[at[i] = meeting(asked[i].first)].push_back(asked[i].first);
  });
  std::unordered_set<std::int64_t> count;
  for (const auto& of_rank : exchanged(std::move(told))) count.insert(of_rank.begin(), of_rank.end());
  std::vector<std::vector<std::int64_t>> answers = exchanged(std::move(asks));
  for (auto& of_rank : answers)
    for (std::int64_t& answer : of_rank) answer = static_cast<std::int64_t>(count.count(answer));
  answers = exchanged(std::move(answers));
  std::vector<std::size_t> read(ranks, 0);
  std::vector<char> result;
  for (const std::size_t r : at) result.push_back(static_cast<char>(answers[r][read[r]++]));
  return result;
}

std::set<std::int64_t> ParticleExchange::missing_around(const Particles& particles,
                                                        const std::vector<std::size_t>& at_edge,
                                                        std::size_t count) const {
  std::set<std::int64_t> missing;
  const std::int64_t depth = nodes_.dimension() > 2 ? halo_ : 0;
  for (const std::size_t j : at_edge) {
    const NodeIndex centre = nodes_.index(particles.id[j]);
    for (std::int64_t z = -depth; z <= depth; ++z)
      for (std::int64_t y = -halo_; y <= halo_; ++y) {
        for (std::int64_t x = -halo_; x <= halo_; ++x) {
          if (x * x + y * y + z * z > halo_ * halo_) continue;
          const std::int64_t id = nodes_.id({options_.ends.fold(0, centre[0] + x), options_.ends.fold(1, centre[1] + y),
                                             options_.ends.fold(2, centre[2] + z)});
          if (at_.find(id) == at_.end()) missing.insert(id);
        }
        // Other ranks may have some of them, but not so many.
        if (count + missing.size() > (ranks_.size() > 1 ? 2 : 1) * options_.most_particles) refuse_so_many();
      }
  }
  return missing;
}

// Of the nodes without a particle here, those that have none elsewhere: the lowest rank that asks makes it.
std::set<std::int64_t> ParticleExchange::made_here(const std::set<std::int64_t>& missing) {
  std::vector<std::vector<std::int64_t>> ids(static_cast<std::size_t>(ranks_.size()));
  for (const std::int64_t id : missing) ids[meeting(id)].push_back(id);
  std::vector<std::vector<std::int64_t>> asked = exchanged(std::move(ids));
  for (auto& of_rank : asked) std::erase_if(of_rank, [&](std::int64_t id) { return !there_are_.insert(id).second; });
  std::set<std::int64_t> made;
  for (const auto& of_rank : exchanged(std::move(asked))) made.insert(of_rank.begin(), of_rank.end());
  return made;
}

// New particles come from their nodes by the flow, as if they had been carried without weight from the beginning.
void ParticleExchange::add(const std::set<std::int64_t>& missing, Particles& particles) {
  if (missing.empty()) return;
  Particles fresh;
  fresh.dimension = particles.dimension;
  for (const std::int64_t id : missing) {
    const Vector x = nodes_.position(nodes_.index(id));
    for (int k = 0; k < fresh.dimension; ++k) fresh.position[k].push_back(x[k]);
    fresh.id.push_back(id);
  }
  fresh.alpha.assign(fresh.id.size(), 0.0);
  fresh.volume.assign(fresh.id.size(), nodes_.cell());
  follow_(fresh);
  const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  for (int k = 0; k < fresh.dimension; ++k) append(particles.position[k], fresh.position[k]);
  append(particles.alpha, fresh.alpha);
  for (std::size_t k = 0; k < options_.of_tracers.size(); ++k) append(*weights_of(particles)[k], fresh.alpha);
  append(particles.id, fresh.id);
  append(particles.volume, fresh.volume);
  for (auto& integral : particles.path) integral.resize(particles.size(), 0.0);
  std::unordered_set<std::int64_t> surrounded;
  for (std::size_t j = 0; j < surrounded_.size(); ++j)
    if (surrounded_[j]) surrounded.insert(particles.id[j]);
  sort_by_id(particles);
  index_nodes(particles);
  surrounded_.resize(particles.size());
  for (std::size_t j = 0; j < particles.size(); ++j) surrounded_[j] = surrounded.count(particles.id[j]) > 0;
}

// (K f)_i = sum_j eta_eps(X_i - X_j) f_j, and g is the diagonal matrix of the roots of D. The exchange alpha' = L alpha,
// L = 1/eps^2 (g V K g - diag(g K g V)), is similar to 1/eps^2 (g V^1/2 K V^1/2 g - diag(g K g V)) with K positive
// definite, so its eigenvalues are at least -1/eps^2 max_i g_i (K g V)_i; they are at most 0 because its
// columns add up to 0 and only its diagonal is negative.
template <int d>
double ParticleExchange::largest_rate(const Particles& particles, double time) const {
  ScatteredSums<d> sums("diffusion by particle exchange", particles, nodes_.lattice(), core_radius_, options_.tiles,
                        sum_options(1e-6, options_.threads), ranks_, options_.folding);
  const Eigen::ArrayXd g = roots(particles, time);
  return options_.coefficient / (core_radius_ * core_radius_) * peak_of_eta(d, core_radius_) *
         largest(g * sums.of((g * column(particles.volume).array()).matrix()).col(0).array());
}

// The roots of D at the particles: what two of them exchange goes with the root of the product of both. A constant D is
// a factor of its own.
Eigen::ArrayXd ParticleExchange::roots(const Particles& particles, double time) const {
  Eigen::ArrayXd values = Eigen::ArrayXd::Ones(static_cast<Eigen::Index>(particles.size()));
  if (!options_.field) return values;
  values.setZero();
  ranks_.agree_on([&] {
    options_.field->add(time, particles.view(), values.data());
    check_diffusivity(particles.view(), values.data(), particles.id.data(), time);
  });
  return values.sqrt();
}

double ParticleExchange::largest(const Eigen::ArrayXd& numbers) const {
  double most = numbers.size() > 0 ? numbers.maxCoeff() : -std::numeric_limits<double>::infinity();
  ranks_.max(std::span(&most, 1));
  return most;
}

void ParticleExchange::exchange(Particles& particles, double time, double length) {
  if (length <= 0 || count_of_all(particles) == 0) return;
  if (particles.dimension == 2)
    exchange_in_dimension<2>(particles, time, length);
  else
    exchange_in_dimension<3>(particles, time, length);
  grow_halo(particles);
}

template <int d>
void ParticleExchange::exchange_in_dimension(Particles& particles, double time, double length) {
  const double eps = core_radius_, factor = options_.coefficient / (eps * eps) * peak_of_eta(d, eps);
  // The error of the sums is far below that of the halo.
  ScatteredSums<d> sums(fmt::format("diffusion by particle exchange at t = {:.6g}", time), particles, nodes_.lattice(),
                        eps, options_.tiles, sum_options(1e-3 * options_.tolerance, options_.threads), ranks_,
                        options_.folding);
  const Eigen::ArrayXd g = roots(particles, time), volume = g * column(particles.volume).array();
  const std::vector<std::vector<double>*> exchanging = weights_of(particles);
  const auto columns = static_cast<Eigen::Index>(exchanging.size());
  Eigen::MatrixXd alpha(volume.size(), columns), weights(volume.size(), 1 + columns);
  weights.col(0) = volume;
  for (Eigen::Index k = 0; k < columns; ++k) {
    alpha.col(k) = column(*exchanging[static_cast<std::size_t>(k)]);
    weights.col(1 + k) = g * alpha.col(k).array();
  }
  const Eigen::MatrixXd sum = sums.of(weights);
  const Eigen::ArrayXd kv = g * sum.col(0).array();
  const double rate = factor * largest(kv);
  ranks_.agree_on([&] {
    if (length * rate > 2 * (1 + 1e-6))  // 1e-6: the tolerance of largest_rate()
      throw NumericalError(
          fmt::format("diffusion by particle exchange is unstable at t = {:.6g}, because particles have come close "
                      "together{}. Use time.step <= {:.3g}, or let {} renew the particles often.",
                      time, options_.field ? " or where the coefficient is larger" : "", 2 / rate, restorers_table()));
  });
  // L applied to weights w whose sum K g w is known. What one particle gives another receives; the tolerance of the sums
  // breaks that, and what is too much or too little is spread over all exchanges, so that the mass stays.
  const auto exchanged = [&](const Eigen::VectorXd& w, const Eigen::ArrayXd& kw, Eigen::Index k) {
    const Eigen::ArrayXd gained = volume * kw, given = w.array() * kv;
    Eigen::ArrayXd change = gained - given;
    const Eigen::ArrayXd size = gained.abs() + given.abs();
    const auto [too_much, all] = sums_of(change, size);
    if (all > 0) change -= too_much / all * size;
    const double part = options_.of_tracers.empty() ? 1 : options_.of_tracers[static_cast<std::size_t>(k)];
    return Eigen::VectorXd((part * factor * change).matrix());
  };
  // Heun's method; L does not change as long as positions stand: alpha + t L alpha + t^2/2 L^2 alpha.
  Eigen::MatrixXd first(alpha.rows(), columns), of_first(alpha.rows(), columns);
  for (Eigen::Index k = 0; k < columns; ++k) {
    first.col(k) = exchanged(alpha.col(k), sum.col(1 + k).array(), k);
    of_first.col(k) = g * first.col(k).array();
  }
  const Eigen::MatrixXd sum_of_first = sums.of(of_first);
  for (Eigen::Index k = 0; k < columns; ++k) {
    const Eigen::VectorXd second = exchanged(first.col(k), sum_of_first.col(k).array(), k);
    const Eigen::VectorXd after = alpha.col(k) + length * first.col(k) + length * length / 2 * second;
    Eigen::Map<Eigen::VectorXd>(exchanging[static_cast<std::size_t>(k)]->data(), after.size()) = after;
  }
  add_up_tracers(particles);
}

// Over all ranks, exactly: bits do not depend on who has what.
std::pair<double, double> ParticleExchange::sums_of(const Eigen::ArrayXd& a, const Eigen::ArrayXd& b) const {
  std::array<base::ExactSum, 2> exact;
  exact[0].add(std::span(a.data(), static_cast<std::size_t>(a.size())));
  exact[1].add(std::span(b.data(), static_cast<std::size_t>(b.size())));
  sum_over_ranks(ranks_, exact);
  return {exact[0].value(), exact[1].value()};
}

Numbers ParticleExchange::numbers() const {
  return {{"particles_at_start", static_cast<double>(started_)},
          {"particles_at_most", static_cast<double>(most_)},
          {"stable_step", stable_step_}};
}

}  // namespace gaussdrift

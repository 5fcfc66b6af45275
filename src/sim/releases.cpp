#include "sim/releases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <stdexcept>
#include <variant>

#include "expression/expression.hpp"
#include "gaussdrift/error.hpp"
#include "particle/columns.hpp"
#include "particle/seeding.hpp"
#include "sim/borders/edges.hpp"
#include "sim/landings.hpp"
#include "sim/make_fields.hpp"

namespace gaussdrift {

namespace {

constexpr double most_released = 5e11;  // images of particles have larger ids (summed_particles())

/// The rate of a source, and its integral.
class Rate {
 public:
  Rate(const std::string& text, const Case& spec, std::size_t source)
      : rate_(text, {"t"}, spec.params), clock_(clock_of(spec.time)), source_(source) {}

  double integral(double from, double to) const {
    const Sum whole = sum(from, to);
    return refined(from, to, whole.value, 1e-15 * whole.size, deepest);
  }

 private:
  static constexpr int deepest = 20;  // bisections: a jump of the rate is found to a millionth of a puff

  struct Sum {
    double value = 0, size = 0;  // of |rate|
  };

  double at(double elapsed) const {
    const double t = clock_.at(elapsed), value = rate_.evaluate({t});
    if (std::isfinite(value)) return value;
    throw NumericalError(fmt::format(
        "the rate \"{}\" of source {} is {} at t = {:.10g}; it must be finite from \"from\" to \"to\": guard "
        "the expression, or shorten the interval",
        rate_.text(), source_ + 1, std::isnan(value) ? "nan" : fmt::format("{}", value), t));
  }

  // Gauss's rule of five points, exact for polynomials of degree 9.
  Sum sum(double from, double to) const {
    static constexpr std::array<double, 5> node{-0.906179845938663993, -0.538469310105683091, 0, 0.538469310105683091,
                                                0.906179845938663993},
        weight{0.236926885056189088, 0.478628670499366468, 0.568888888888888889, 0.478628670499366468,
               0.236926885056189088};
    const double half = (to - from) / 2, middle = from + half;
    Sum all;
    for (std::size_t i = 0; i < node.size(); ++i) {
      const double part = half * weight[i] * at(middle + half * node[i]);
      all.value += part;
      all.size += std::abs(part);
    }
    return all;
  }

  double refined(double from, double to, double whole, double tolerance, int depth) const {
    const double middle = from + (to - from) / 2;
    const Sum left = sum(from, middle), right = sum(middle, to);
    const double both = left.value + right.value;
    if (depth == 0 || std::abs(both - whole) <= std::max(tolerance, 4e-16 * (left.size + right.size))) return both;
    return refined(from, middle, left.value, tolerance, depth - 1) +
           refined(middle, to, right.value, tolerance, depth - 1);
  }

  Expression rate_;
  Clock clock_;
  std::size_t source_;
};

double boundary(const SourceSpec& source, int puff) {
  return puff == source.puffs ? source.to : source.from + (source.to - source.from) * puff / source.puffs;
}

double middle(const SourceSpec& source, int puff) {
  return source.from + (source.to - source.from) * (puff + 0.5) / source.puffs;
}

std::size_t columns_of_table(const Case& spec) { return static_cast<std::size_t>(spec.domain.dimension) + 2; }

std::size_t rows_of(const PointsSourceSpec& table, const Case& spec) {
  return table.rows->size() / columns_of_table(spec);
}

double time_of_row(const PointsSourceSpec& table, const Case& spec, std::size_t row) {
  return (*table.rows)[(row + 1) * columns_of_table(spec) - 2];
}

Particles particles_of(const ShapeDensitySpec& shape, const Case& spec, const Lattice& lattice, double threshold,
                       int threads) {
  const auto density = make_density(spec, shape);
  return seed(lattice,
              {{"the density of a source", [&](const PointsView& x, double* values) { density->add(x, values); }}},
              threshold, threads);
}

Particles particles_of(const PointSourceSpec& point, const Case& spec) {
  Particles one;
  one.dimension = spec.domain.dimension;
  for (std::size_t k = 0; k < point.place.size(); ++k) one.position[k].push_back(point.place[k]);
  one.alpha.push_back(1);
  return one;
}

Particles particles_of(const PointsSourceSpec& table, const Case& spec) {
  Particles all;
  all.dimension = spec.domain.dimension;
  const std::size_t dimension = columns_of_table(spec) - 2, rows = rows_of(table, spec);
  for (std::size_t row = 0; row < rows; ++row) {
    const double* const numbers = table.rows->data() + row * columns_of_table(spec);
    for (std::size_t k = 0; k < dimension; ++k) all.position[k].push_back(numbers[k]);
    all.alpha.push_back(numbers[dimension + 1]);
  }
  return all;
}

}  // namespace

std::vector<double> release_times(const Case& spec) {
  std::vector<double> times;
  for (const SourceSpec& source : spec.sources) {
    if (const auto* table = std::get_if<PointsSourceSpec>(&source.what))
      for (std::size_t row = 0; row < rows_of(*table, spec); ++row) times.push_back(time_of_row(*table, spec, row));
    else if (source.at)
      times.push_back(*source.at);
    else
      for (int puff = 0; puff < source.puffs; ++puff) times.push_back(middle(source, puff));
  }
  std::sort(times.begin(), times.end());
  return times;
}

double particles_released(const Case& spec, int threads) {
  if (spec.sources.empty()) return 0;
  constexpr double most_points = 1e5;
  const Lattice whole = seeding_lattice(spec.domain, spec.particles.per_axis);
  Lattice coarse = whole;
  const double stride =
      std::ceil(std::pow(std::max(1.0, static_cast<double>(whole.size()) / most_points), 1.0 / whole.dimension));
  coarse.spacing *= stride;
  for (int k = 0; k < whole.dimension; ++k) {
    auto& points = coarse.points[static_cast<std::size_t>(k)];
    points = static_cast<std::size_t>(std::ceil(static_cast<double>(points) / stride));
  }
  double count = 0;
  for (const SourceSpec& source : spec.sources) {
    double each = 1;
    if (const auto* table = std::get_if<PointsSourceSpec>(&source.what)) {
      count += static_cast<double>(rows_of(*table, spec));
      continue;
    }
    if (const auto* face = std::get_if<FaceSourceSpec>(&source.what))
      each = static_cast<double>(Inflow::cells_of(spec, *face));
    if (const auto* shape = std::get_if<ShapeDensitySpec>(&source.what)) {
      const auto met = particles_of(*shape, spec, coarse, spec.particles.threshold, threads).size();
      each = std::max(1.0, static_cast<double>(met)) * std::pow(stride, whole.dimension);
    }
    count += each * (source.at ? 1 : source.puffs);
  }
  return count;
}

Releases::Releases(const Case& spec, const Scene& scene, int threads)
    : rounding_(rounding_of_times(spec)), of_tracers_(spec.tracers.size()) {
  for (std::size_t number = 0; number < spec.sources.size(); ++number) add_source(spec, scene, number, threads);
  std::stable_sort(puffs_.begin(), puffs_.end(), [](const Puff& a, const Puff& b) { return a.time < b.time; });
  double all = 0;
  for (const Puff& puff : puffs_) all += static_cast<double>(puff.count);
  if (all > most_released)
    throw InputError(
        fmt::format("the sources release {:.3g} particles, and at most {:.3g} can be told apart; lower "
                    "source.puffs",
                    all, most_released));
  // In the order of time, so that particles stay in the order of ids when they come.
  std::int64_t next = static_cast<std::int64_t>(scene.seeding.size());
  for (Puff& puff : puffs_) {
    puff.id = next;
    next += static_cast<std::int64_t>(puff.count);
  }
  ids_end_ = next;
}

double Releases::began(std::int64_t id) const {
  const auto after = std::upper_bound(puffs_.begin(), puffs_.end(), id,
                                      [](std::int64_t wanted, const Puff& puff) { return wanted < puff.id; });
  return after == puffs_.begin() ? 0 : std::prev(after)->time;
}

void Releases::add_source(const Case& spec, const Scene& scene, std::size_t number, int threads) {
  const SourceSpec& source = spec.sources[number];
  faces_.emplace_back();
  tracer_.push_back(source.tracer);
  if (const auto* face = std::get_if<FaceSourceSpec>(&source.what)) {
    faces_.back() = std::make_unique<Inflow>(spec, *face, scene, source.from, source.to);
    of_sources_.push_back(faces_.back()->places());
    look_at_face(scene, *faces_.back(), source);
  } else if (const auto* shape = std::get_if<ShapeDensitySpec>(&source.what)) {
    of_sources_.push_back(particles_of(*shape, spec, scene.seeding, scene.threshold, threads));
  } else if (const auto* point = std::get_if<PointSourceSpec>(&source.what)) {
    of_sources_.push_back(particles_of(*point, spec));
  } else {
    of_sources_.push_back(particles_of(std::get<PointsSourceSpec>(source.what), spec));
  }
  const std::size_t count = of_sources_.back().size();
  if (count == 0)
    throw InputError(
        fmt::format("the shape of source {} is 0 on every point of the particle lattice, so it releases "
                    "nothing; move or enlarge it, or raise particles.per_axis",
                    number + 1));
  add_puffs(spec, number, count);
}

void Releases::look_at_face(const Scene& scene, const Inflow& face, const SourceSpec& source) {
  const double apart = face.fastest() * (source.to - source.from) / source.puffs;
  if (apart <= scene.core_radius) return;
  const double enough = std::ceil(source.puffs * apart / (0.5 * scene.core_radius));
  warnings_.push_back(fmt::format(
      "what comes in through {} goes {:.2g} from one puff to the next, farther than a blob reaches ({:.2g}), so that "
      "the density has gaps there. Use source.puffs = {:.0f}.",
      face.name(), apart, scene.core_radius, enough));
}

void Releases::add_puffs(const Case& spec, std::size_t number, std::size_t count) {
  const SourceSpec& source = spec.sources[number];
  if (const auto* table = std::get_if<PointsSourceSpec>(&source.what)) {
    for (std::size_t row = 0; row < count; ++row)
      puffs_.push_back({.time = time_of_row(*table, spec, row), .source = number, .first = row, .count = 1});
    return;
  }
  const auto* point = std::get_if<PointSourceSpec>(&source.what);
  if (source.at)
    return puffs_.push_back({.time = *source.at, .times = point ? point->amount : 1, .source = number, .count = count});
  std::optional<Rate> rate;  // of a face the concentration says how much
  if (!faces_[number]) rate.emplace(source.rate, spec, number);
  for (int puff = 0; puff < source.puffs; ++puff) {
    const double from = boundary(source, puff), to = boundary(source, puff + 1);
    puffs_.push_back({.time = middle(source, puff),
                      .times = rate ? rate->integral(from, to) : 1,
                      .source = number,
                      .count = count,
                      .from = from,
                      .to = to});
  }
}

std::vector<double> Releases::weights_of(const Puff& puff) const {
  if (faces_[puff.source]) return faces_[puff.source]->carried_in(puff.from, puff.to);
  const auto begin = of_sources_[puff.source].alpha.begin() + static_cast<std::ptrdiff_t>(puff.first);
  std::vector<double> weights(begin, begin + static_cast<std::ptrdiff_t>(puff.count));
  for (double& weight : weights) weight *= puff.times;
  return weights;
}

bool Releases::release(Particles& particles, double time, const std::function<bool(const Vector& place)>& is_here) {
  const std::uint64_t before = done_;
  for (; done_ < puffs_.size() && puffs_[done_].time <= time + rounding_; ++done_) {
    const Puff& puff = puffs_[done_];
    const Particles& source = of_sources_[puff.source];
    const std::vector<double> weights = weights_of(puff);
    for (std::size_t i = 0; i < puff.count; ++i) {
      const std::size_t from = puff.first + i;
      const double weight = weights[i];
      sum_.add(weight);
      if (!of_tracers_.empty()) of_tracers_[tracer_[puff.source]].add(weight);
      if (weight == 0) continue;
      Vector place{};
      for (int k = 0; k < source.dimension; ++k) place[k] = source.position[k][from];
      if (!is_here(place)) continue;
      for (int k = 0; k < source.dimension; ++k) particles.position[k].push_back(place[k]);
      particles.alpha.push_back(weight);
      for (std::size_t k = 0; k < particles.tracers.size(); ++k)
        particles.tracers[k].push_back(k == tracer_[puff.source] ? weight : 0);
      particles.id.push_back(puff.id + static_cast<std::int64_t>(i));
    }
  }
  // Integrals along their paths begin now.
  for_each_column(particles, [&](std::string_view, std::size_t, auto& column) { column.resize(particles.size()); });
  return done_ > before;
}

void Releases::add_places(Particles& sample, std::size_t most) const {
  std::size_t all = 0;
  for (const Particles& source : of_sources_) all += source.size();
  if (all == 0 || most == 0) return;
  const std::size_t stride = (all + most - 1) / most;
  std::size_t number = 0;
  for (const Particles& source : of_sources_)
    for (std::size_t j = 0; j < source.size(); ++j, ++number) {
      if (number % stride != 0) continue;
      for (int k = 0; k < source.dimension; ++k) sample.position[k].push_back(source.position[k][j]);
      sample.alpha.push_back(source.alpha[j]);
      sample.id.push_back(std::numeric_limits<std::int64_t>::max());
    }
}

void Releases::pass_state(base::StateBytes& bytes) {
  bytes(done_, sum_);
  for (base::ExactSum& tracer : of_tracers_) bytes(tracer);
  if (done_ > puffs_.size()) throw std::out_of_range("it has released more than its sources have");
}

}  // namespace gaussdrift

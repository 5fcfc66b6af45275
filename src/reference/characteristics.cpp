#include "reference/characteristics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "base/nan.hpp"
#include "base/parallel.hpp"
#include "field/velocity/value_seconds.hpp"
#include "reference/coordinates.hpp"
#include "reference/lost_velocity.hpp"
#include "time/adaptive.hpp"
#include "time/runge_kutta.hpp"
#include "time/schedule.hpp"

namespace gaussdrift {

namespace {

using base::nan;
// Points that take the same steps; 13 rates of them fit the second-level cache.
constexpr std::size_t most_together = 256;

// At a jump of a derivative of u a point needs some twenty short steps. Points that share steps would all take them.
constexpr std::size_t together_over_kinks = 1;

double longest_side(const Lattice& lattice) {
  const auto& points = lattice.points;
  return lattice.spacing * static_cast<double>(std::max({points[0], points[1], points[2]}) - 1);
}

PointsView view_of(int dimension, std::size_t count, const double* axis) {
  PointsView view{dimension, count, {}};
  for (int k = 0; k < dimension; ++k) view.axis[k] = axis + static_cast<std::size_t>(k) * count;
  return view;
}

class Characteristics : public Reference {
 public:
  Characteristics(const VelocityField& velocity, const InitialDensity& density, ScalarRate growth,
                  const Lattice& lattice, const CharacteristicsOptions& options)
      : velocity_(velocity),
        density_(density),
        growth_(std::move(growth)),
        lattice_(lattice),
        options_(options),
        components_(static_cast<std::size_t>(lattice.dimension) + (growth_ ? 1 : 0)),
        block_length_(options.smooth || options.steps_by ? most_together : together_over_kinks) {
    const double longest = longest_side(lattice);
    // Far from the origin coordinates are rounded by more than the tolerance. A step crosses at most a quarter of the
    // domain, so that nothing is stepped over; far outside it goes at most half of the way back.
    for (int k = 0; k < lattice.dimension; ++k) {
      const double first = lattice.coordinate(k, 0), last = lattice.coordinate(k, lattice.points[k] - 1);
      bounds_.components.push_back({options.tolerance * longest, 4 * std::numeric_limits<double>::epsilon(),
                                    longest / 4, 0.5, (first + last) / 2});
    }
    if (growth_) bounds_.components.push_back({options.tolerance, options.tolerance, 0});
    bounds_.most_steps = options.most_steps;
    if (!options.steady) bounds_.longest_step = options.end / 32;
  }

  ReferenceReport evaluate(double time, std::vector<double>& rho) override {
    const std::size_t points = lattice_.size(), blocks = (points + block_length_ - 1) / block_length_;
    rho.assign(points, 0.0);
    if (options_.steady && kept_.empty()) kept_.resize(blocks);
    const std::size_t own = blocks > options_.rank ? (blocks - options_.rank - 1) / options_.ranks + 1 : 0;
    std::vector<ReferenceReport> reports(own);
    base::parallel_for({own, seconds_of(own * block_length_)}, options_.threads, [&](std::size_t i) {
      const std::size_t b = options_.rank + i * options_.ranks;
      const std::size_t first = b * block_length_, count = std::min(block_length_, points - first);
      Block block = start(b, first, count, time);
      // In a steady flow X(0) of x at t is that of X(t_before - t) at t_before.
      const double from = options_.steady ? time - kept_until_ : time;
      trace(block, count, from, reports[i]);
      values(block, count, rho.data() + first);
      if (reports[i].untraced > 0) {
        std::size_t lost = 0;
        while (!std::isnan(block.state[lost])) ++lost;
        reports[i].first_untraced = place(first + lost);
      }
      if (options_.steady) kept_[b] = std::move(block);
    });
    if (options_.steady) kept_until_ = time;
    return sum_of(reports);
  }

  std::size_t together() const override { return block_length_; }

  // In a steady flow each output goes on from the feet of the one before.
  void pass(const std::vector<double>& times) override {
    std::vector<double> ignored;
    for (const double time : times)
      if (options_.steady) evaluate(time, ignored);
  }

  ReferenceReport evaluate_at(double time, const std::vector<std::size_t>& points,
                              std::vector<double>& rho) const override {
    const std::size_t blocks = (points.size() + block_length_ - 1) / block_length_;
    rho.assign(points.size(), 0.0);
    std::vector<ReferenceReport> reports(blocks);
    base::parallel_for({blocks, seconds_of(points.size())}, options_.threads, [&](std::size_t b) {
      const std::size_t first = b * block_length_, count = std::min(block_length_, points.size() - first);
      Block block = empty_block(count);
      fill_coordinates(lattice_, points.data() + first, count, block.state.data());
      mark_points_on_land(time, block, count);
      trace(block, count, time, reports[b]);
      values(block, count, rho.data() + first);
      for (std::size_t i = first; i < first + count && reports[b].untraced > 0; ++i)
        if (std::isnan(block.state[i - first])) {
          reports[b].first_untraced = place(points[i]);
          break;
        }
    });
    return sum_of(reports);
  }

 private:
  // Where a path has ended, followed backwards: nowhere yet, beyond an outflow, on land, or it is a point on land itself.
  enum End : char { not_yet, came_in, met_land, on_land };

  struct Block {
    std::vector<double> state;  // [component][point]: the foot so far, and the exponent
    std::vector<char> beyond;   // an End of each path; empty: paths do not end
  };

  Block empty_block(std::size_t count) const {
    return {std::vector<double>(components_ * count, 0.0), std::vector<char>(paths_end() ? count : 0, not_yet)};
  }

  bool paths_end() const { return !options_.outflows.empty() || options_.no_fluid; }

  // The point i of some at which paths begin.
  Vector point_of(const double* state, std::size_t count, std::size_t i) const {
    Vector x{};
    for (int k = 0; k < lattice_.dimension; ++k) x[k] = state[static_cast<std::size_t>(k) * count + i];
    return x;
  }

  void mark_points_on_land(double time, Block& block, std::size_t count) const {
    for (std::size_t i = 0; i < count && options_.no_fluid; ++i)
      if (options_.no_fluid->at(time, point_of(block.state.data(), count, i))) block.beyond[i] = on_land;
  }

  double seconds_of(std::size_t points) const {
    const double steps = 30, stages = 12;  // roughly, of one block
    return static_cast<double>(points) * steps * stages * value_seconds(velocity_);
  }

  static ReferenceReport sum_of(const std::vector<ReferenceReport>& reports) {
    ReferenceReport all;
    for (const ReferenceReport& report : reports) {
      if (all.untraced == 0 && report.untraced > 0) {
        all.first_untraced = report.first_untraced;
        all.trouble = report.trouble;
      }
      all.untraced += report.untraced;
      all.exhausted += report.exhausted;
      all.rates += report.rates;
    }
    return all;
  }

  Block start(std::size_t b, std::size_t first, std::size_t count, double time) {
    if (options_.steady && !kept_[b].state.empty()) return std::move(kept_[b]);
    Block block = empty_block(count);
    fill_coordinates(lattice_, first, count, block.state.data());
    mark_points_on_land(time, block, count);
    return block;
  }

  // Carries the points from `from` back to 0. Those that do not arrive become NaN; where one of many does not, the
  // others are found by halves. Points whose path has ended stay where they are.
  void trace(Block& block, std::size_t count, double from, ReferenceReport& report) const {
    const Block begun = block;
    const std::vector<char>& resting = begun.beyond;
    const auto rate = [&](double t, const double* y, double* k) {
      std::fill_n(k, components_ * count, 0.0);
      const PointsView x = view_of(lattice_.dimension, count, y);
      VectorsView u{lattice_.dimension, count, {}};
      for (int axis = 0; axis < lattice_.dimension; ++axis) u.axis[axis] = k + static_cast<std::size_t>(axis) * count;
      velocity_.add(t, x, u);
      if (growth_) growth_(t, x, k + static_cast<std::size_t>(lattice_.dimension) * count);
      for (std::size_t i = 0; i < resting.size(); ++i)
        if (resting[i])
          for (std::size_t c = 0; c < components_; ++c) k[c * count + i] = 0;
    };
    if (options_.steps_by) return walk(rate, block, count, from, report);
    if (count > 1 &&
        std::any_of(begun.state.begin(), begun.state.end(), [](double value) { return std::isnan(value); }))
      return trace_halves(block, begun, count, from, report);  // lost at an earlier output
    time::AdaptiveOptions bounds = bounds_;
    if (paths_end()) bounds.after_step = [&](const time::StepTaken& step) { look_beyond(step, count, block.beyond); };
    const time::AdaptiveResult result = time::integrate_adaptively(rate, from, 0, count, bounds, block.state.data());
    constexpr std::size_t stages = 12;
    report.rates += stages * count * (result.steps + result.rejected);
    if (result.reached) return;
    // One bad point may have stopped the block, so its halves are tried. Too many steps concern all points.
    if (count > 1 && !result.exhausted) return trace_halves(block, begun, count, from, report);
    if (count == 1 && !block.beyond.empty() && block.beyond[0]) {
      block.state = begun.state;  // what it would meet beyond does not matter
      return;
    }
    if (report.untraced == 0) report.trouble = why_lost(block.state, count, result);
    if (result.exhausted) report.exhausted += count;
    block.state.assign(block.state.size(), nan);
    report.untraced += count;
  }

  // Between its ends a path is looked at as the cubic through both places and velocities.
  void look_beyond(const time::StepTaken& step, std::size_t count, std::vector<char>& beyond) const {
    look_for_land(step.from, step.before, step.to, step.after, count, beyond);
    const double length = step.to - step.from;
    for (const Outflow& outflow : options_.outflows)
      for (std::size_t i = 0; i < count; ++i) {
        const std::size_t at = static_cast<std::size_t>(outflow.axis) * count + i;
        const double a = step.before[at], b = step.after[at], va = length * step.rate_before[at],
                     vb = length * step.rate_after[at];
        const auto is_beyond = [&](double x) { return x < outflow.low || x > outflow.high; };
        if (is_beyond(b) && !beyond[i]) beyond[i] = came_in;
        if (beyond[i]) continue;
        // x(s) = a + va s + (3 (b - a) - 2 va - vb) s^2 + (va + vb - 2 (b - a)) s^3 is extreme where x'(s) = 0.
        const double c2 = 3 * (b - a) - 2 * va - vb, c3 = va + vb - 2 * (b - a), root = c2 * c2 - 3 * c3 * va;
        if (!(root >= 0)) continue;
        const double q = -(c2 + std::copysign(std::sqrt(root), c2));
        for (const double s : {c3 != 0 ? q / (3 * c3) : -1.0, q != 0 ? va / q : -1.0})
          if (s > 0 && s < 1 && is_beyond(a + s * (va + s * (c2 + s * c3)))) beyond[i] = came_in;
      }
  }

  void look_for_land(double from, const double* before, double to, const double* after, std::size_t count,
                     std::vector<char>& beyond) const {
    for (std::size_t i = 0; i < count && options_.no_fluid; ++i)
      if (!beyond[i] && options_.no_fluid->between(from, point_of(before, count, i), to, point_of(after, count, i)))
        beyond[i] = met_land;
  }

  // Traces by fixed steps. Points do not see each other, so a lost one does not affect the others.
  template <class Rate>
  void walk(const Rate& rate, Block& block, std::size_t count, double from, ReferenceReport& report) const {
    std::vector<double>& state = block.state;
    const time::Tableau& tableau = *options_.steps_by;
    const std::size_t steps = time::Interval(0, from, options_.step).steps();
    const double length = steps > 0 ? from / static_cast<double>(steps) : 0;
    time::Stages work(tableau, state.size());
    std::vector<double> before = state;
    const auto known = [&](const std::vector<double>& numbers, std::size_t i) {
      bool finite = true;
      for (std::size_t c = 0; c < components_; ++c) finite = finite && std::isfinite(numbers[c * count + i]);
      return finite;
    };
    for (std::size_t step = 0; step < steps; ++step) {
      const double t = from - static_cast<double>(step) * length;
      std::copy(state.begin(), state.end(), before.begin());
      time::step(tableau, t, -length, rate, state.data(), work);
      for (std::size_t i = 0; i < count && report.trouble.empty(); ++i)
        if (!known(state, i) && known(before, i) && (block.beyond.empty() || !block.beyond[i]))
          report.trouble = why_lost_in_step(before, work.rates[0], count, i, t, length);
      for (const Outflow& outflow : options_.outflows)
        for (std::size_t i = 0; i < count; ++i) {
          const double x = state[static_cast<std::size_t>(outflow.axis) * count + i];
          if ((x < outflow.low || x > outflow.high) && !block.beyond[i]) block.beyond[i] = came_in;
        }
      look_for_land(t, before.data(), t - length, state.data(), count, block.beyond);
    }
    report.rates += static_cast<std::size_t>(tableau.stages) * count * steps;
    for (std::size_t i = 0; i < count; ++i) {
      if (known(state, i) || (!block.beyond.empty() && block.beyond[i])) continue;
      for (std::size_t c = 0; c < components_; ++c) state[c * count + i] = nan;
      ++report.untraced;
    }
  }

  std::string why_lost_in_step(const std::vector<double>& state, const std::vector<double>& rates, std::size_t count,
                               std::size_t i, double t, double length) const {
    Vector x{};
    double square = 0;
    for (int k = 0; k < lattice_.dimension; ++k) {
      x[k] = state[static_cast<std::size_t>(k) * count + i];
      square += std::pow(rates[static_cast<std::size_t>(k) * count + i], 2);
    }
    const std::string reason = why_path_ends(velocity_, t, lattice_.dimension, x, -length * std::sqrt(square));
    return reason.empty() ? "the velocity is not finite on its way back in time" : "on its way back in time " + reason;
  }

  std::string why_lost(const std::vector<double>& state, std::size_t count, const time::AdaptiveResult& result) const {
    Vector x{};
    for (int k = 0; k < lattice_.dimension; ++k) x[k] = state[static_cast<std::size_t>(k) * count];
    const std::string reason =
        why_path_ends(velocity_, result.time, lattice_.dimension, x, -1e-6 * longest_side(lattice_));
    return reason.empty() ? result.trouble : "on its way back in time " + reason;
  }

  void trace_halves(Block& block, const Block& begun, std::size_t count, double from, ReferenceReport& report) const {
    for (const auto& [first, length] : {std::pair{std::size_t{0}, count / 2}, {count / 2, count - count / 2}}) {
      Block part = empty_block(length);
      for (std::size_t c = 0; c < components_; ++c)
        std::copy_n(begun.state.data() + c * count + first, length, part.state.data() + c * length);
      if (!begun.beyond.empty()) std::copy_n(begun.beyond.data() + first, length, part.beyond.data());
      trace(part, length, from, report);
      for (std::size_t c = 0; c < components_; ++c)
        std::copy_n(part.state.data() + c * length, length, block.state.data() + c * count + first);
      if (!begun.beyond.empty()) std::copy_n(part.beyond.data(), length, block.beyond.data() + first);
    }
  }

  void values(const Block& block, std::size_t count, double* rho) const {
    density_.add(view_of(lattice_.dimension, count, block.state.data()), rho);
    const double* exponent = block.state.data() + static_cast<std::size_t>(lattice_.dimension) * count;
    for (std::size_t i = 0; i < count; ++i) {
      // Shapes answer a NaN with 0: comparisons with it are false.
      const char end = block.beyond.empty() ? char{not_yet} : block.beyond[i];
      if (end == on_land)
        rho[i] = nan;
      else if (end != not_yet)
        rho[i] = end == met_land ? options_.no_fluid->from_there : 0;
      else if (std::isnan(block.state[i]))
        rho[i] = nan;
      else if (growth_ && rho[i] != 0)
        rho[i] *= std::exp(exponent[i]);
    }
  }

  Vector place(std::size_t index) const {
    Vector x{};
    fill_coordinates(lattice_, index, 1, x.data());
    return x;
  }

  const VelocityField& velocity_;
  const InitialDensity& density_;
  const ScalarRate growth_;
  const Lattice lattice_;
  const CharacteristicsOptions options_;
  const std::size_t components_;
  const std::size_t block_length_;
  time::AdaptiveOptions bounds_;
  std::vector<Block> kept_;  // of the output before; only in a steady flow
  double kept_until_ = 0;
};

}  // namespace

std::unique_ptr<Reference> characteristics(const VelocityField& velocity, const InitialDensity& density,
                                           ScalarRate growth, const Lattice& lattice,
                                           const CharacteristicsOptions& options) {
  return std::make_unique<Characteristics>(velocity, density, std::move(growth), lattice, options);
}

}  // namespace gaussdrift

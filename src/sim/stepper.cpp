#include "sim/stepper.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "base/parallel.hpp"
#include "base/stopwatch.hpp"
#include "field/velocity/block_carrier.hpp"
#include "field/velocity/value_seconds.hpp"
#include "gaussdrift/error.hpp"
#include "time/runge_kutta.hpp"

namespace gaussdrift {

namespace {

constexpr std::size_t block_length = 256;  // particles stepped together: state and stages stay in the first-level cache

constexpr std::size_t steps_at_a_time = 1024;  // bounds what a formula needs of the time of their stages

bool all_finite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

// The sign of a NaN is not shown.
std::string number(double value) { return std::isnan(value) ? "nan" : fmt::format("{:.6g}", value); }

template <class T>
std::string tuple(const std::array<T, max_dimension>& axis, int dimension, std::size_t j) {
  std::string text = "(";
  for (int k = 0; k < dimension; ++k) text += (k ? ", " : "") + number(axis[k][j]);
  return text + ")";
}

void check_block(const VelocityField& field, const PointsView& x, const VectorsView& u, const std::int64_t* id,
                 double time, std::size_t step) {
  for (std::size_t j = 0; j < x.count; ++j) {
    bool placed = true, moving = true;
    for (int k = 0; k < x.dimension; ++k) {
      placed = placed && std::isfinite(x.axis[k][j]);
      moving = moving && std::isfinite(u.axis[k][j]);
    }
    if (placed && moving) continue;
    const std::string when = fmt::format("in step {} at t = {:.10g}", step, field.shown_time(time));
    if (!placed)
      throw NumericalError(fmt::format(
          "particle {} left for infinity {}. Either time.step is too long for this field, or the flow itself blows up.",
          id[j], when));
    Vector place{};
    for (int k = 0; k < x.dimension; ++k) place[k] = x.axis[k][j];
    const std::string reason = field.why_not_finite(time, place);
    throw NumericalError(fmt::format(
        "the velocity is {} {}, for particle {} at {}; {}", tuple(u.axis, x.dimension, j), when, id[j],
        tuple(x.axis, x.dimension, j),
        !reason.empty() ? reason
                        : "the field must be finite wherever particles go: guard the expression, shorten time.end, or "
                          "move the density"));
  }
}

void check_rates(const PathIntegral& integral, const PointsView& x, const double* values, const std::int64_t* id,
                 double time, std::size_t step) {
  for (std::size_t j = 0; j < x.count; ++j)
    if (!std::isfinite(values[j]))
      throw NumericalError(
          fmt::format("{} is {} in step {} at t = {:.10g}, for particle {} at {}; it must be finite wherever particles "
                      "go: guard the expression, shorten time.end, or move the density",
                      integral.quantity(), number(values[j]), step, time, id[j], tuple(x.axis, x.dimension, j)));
}

// The block's coordinates, axis after axis, then its path integrals, each `length` long: the flat state that the
// integrator sees.
struct Block {
  int dimension;
  std::size_t length;
  std::vector<double> state;

  PointsView points(const double* from) const {
    PointsView view{dimension, length, {}};
    for (int k = 0; k < dimension; ++k) view.axis[k] = from + static_cast<std::size_t>(k) * length;
    return view;
  }
  VectorsView vectors(double* to) const {
    VectorsView view{dimension, length, {}};
    for (int k = 0; k < dimension; ++k) view.axis[k] = to + static_cast<std::size_t>(k) * length;
    return view;
  }
};

}  // namespace

void check_velocity(const VelocityField& field, const Particles& particles, const VectorsView& u, double time,
                    std::size_t step) {
  check_block(field, particles.view(), u, particles.id.data(), time, step);
}

double add_flow_and_drifts(const VelocityField& velocity, const std::vector<const Drift*>& drifts, double t,
                           const Particles& particles, const PointsView& x, const VectorsView& u, int threads,
                           base::Communicator* ranks) {
  const std::size_t longest = velocity.evaluates_in_blocks() ? block_length : std::max<std::size_t>(1, x.count);
  const base::Pieces pieces((x.count + longest - 1) / longest, static_cast<double>(x.count) * value_seconds(velocity));
  const auto add_flow = [&](std::size_t b) {
    const std::size_t begin = b * longest, length = std::min(longest, x.count - begin);
    PointsView some{x.dimension, length, {}};
    VectorsView there{x.dimension, length, {}};
    for (int k = 0; k < x.dimension; ++k) some.axis[k] = x.axis[k] + begin, there.axis[k] = u.axis[k] + begin;
    velocity.add(t, some, there);
  };
  agree_on(drifts.empty() ? nullptr : ranks, [&] { base::parallel_for(pieces, threads, add_flow); });
  if (drifts.empty()) return 0;
  const base::Stopwatch watch;
  for (const Drift* drift : drifts) drift->add(t, particles, x, u);
  return watch.seconds();
}

bool Stepper::carry_in_registers(const BlockCarrier& carrier, Particles& particles, const time::Interval& interval,
                                 std::size_t first, std::size_t count) const {
  const std::size_t axes = static_cast<std::size_t>(particles.dimension), length = particles.size();
  for (std::size_t k = 0; k < axes; ++k) carried_[k] = particles.position[k];
  const double step_seconds = value_seconds(velocity_) * tableau_.stages;
  std::vector<double> lengths, of_time;
  for (std::size_t done = 0; done < count;) {
    const std::size_t steps = std::min(steps_at_a_time, count - done);
    lengths.clear(), of_time.clear();
    for (std::size_t i = first + done; i < first + done + steps; ++i) {
      lengths.push_back(interval.length(i));
      for (int s = 0; s < tableau_.stages; ++s) {
        of_time.resize(of_time.size() + carrier.time_values());
        carrier.at_time(interval.start(i) + tableau_.c(s) * interval.length(i),
                        of_time.data() + (of_time.size() - carrier.time_values()));
      }
    }
    const BlockSteps job{tableau_.stages, tableau_.stage_weights.data(), tableau_.weights.data(), steps, lengths.data(),
                         of_time.data()};
    const std::size_t blocks = (length + block_length - 1) / block_length;
    base::parallel_for({blocks, static_cast<double>(length * steps) * step_seconds}, threads_, [&](std::size_t b) {
      const std::size_t begin = b * block_length;
      std::array<double*, max_dimension> x{};
      for (std::size_t k = 0; k < axes; ++k) x[k] = carried_[k].data() + begin;
      carrier.carry(job, x, std::min(block_length, length - begin));
    });
    done += steps;
  }
  for (std::size_t k = 0; k < axes; ++k)
    if (!all_finite(carried_[k])) return false;
  for (std::size_t k = 0; k < axes; ++k) particles.position[k].swap(carried_[k]);
  return true;
}

StepperSeconds Stepper::advance(Particles& particles, const time::Interval& interval, std::size_t first,
                                std::size_t count, std::size_t steps_before) const {
  const BlockCarrier* const carrier = velocity_.block_carrier();
  // If a value is not finite, the steps are taken again below, which finds the place.
  if (carrier && integrals_.empty() && drifts_.empty() &&
      carry_in_registers(*carrier, particles, interval, first, count))
    return {};
  const auto dimension = static_cast<std::size_t>(particles.dimension), rows = dimension + rows_of(integrals_);
  const bool together = !velocity_.evaluates_in_blocks() || !drifts_.empty();
  const std::size_t longest = together ? std::max<std::size_t>(1, particles.size()) : block_length;
  // Particles that move each other are one block, also on a rank that has none of them.
  const std::size_t blocks = drifts_.empty() ? (particles.size() + longest - 1) / longest : 1;
  std::vector<std::vector<double>> results(blocks);
  std::vector<double> seconds(integrals_.empty() ? 0 : blocks, 0.0);
  double drift_seconds = 0;  // with drifts there is one block
  const auto column = [&](std::size_t row) {
    return row < dimension ? particles.position[row].data() : particles.path[row - dimension].data();
  };

  const auto lost_on_any_rank = [&](bool lost) {
    std::int64_t any = lost;
    if (ranks_) ranks_->max(std::span(&any, 1));
    return any != 0;
  };
  const double rates = static_cast<double>(particles.size() * count) * static_cast<double>(tableau_.stages);
  const auto carry = [&](std::size_t b) {
    const std::size_t begin = b * longest, length = std::min(longest, particles.size() - begin);
    Block block{particles.dimension, length, std::vector<double>(length * rows)};
    const auto load = [&] {
      for (std::size_t k = 0; k < rows; ++k) std::copy_n(column(k) + begin, length, block.state.data() + k * length);
    };
    time::Stages work(tableau_, block.state.size());
    const auto rate = [&](double t, const double* x, double* u) {
      std::fill_n(u, block.state.size(), 0.0);
      if (drifts_.empty()) {
        velocity_.add(t, block.points(x), block.vectors(u));
      } else {
        drift_seconds +=
            add_flow_and_drifts(velocity_, drifts_, t, particles, block.points(x), block.vectors(u), threads_, ranks_);
      }
      if (integrals_.empty()) return;
      const base::Stopwatch watch;
      agree_on(ranks_, [&] {
        std::size_t row = dimension;
        for (const PathIntegral* integral : integrals_) {
          integral->add_rates(t, particles, begin, block.points(x), x + row * length, u + row * length);
          row += integral->rows();
        }
      });
      seconds[b] += watch.seconds();
    };
    load();
    for (std::size_t i = first; i < first + count; ++i)
      time::step(tableau_, interval.start(i), interval.length(i), rate, block.state.data(), work);

    // A value that is not finite stays so. One look after many steps is enough, and only a failure is traced step by
    // step.
    if (lost_on_any_rank(!all_finite(block.state))) {
      load();
      std::size_t i = first;
      const auto check = [&](double t, const double* x, double* u, const double* values) {
        agree_on(ranks_, [&] {
          const std::int64_t* const ids = particles.id.data() + begin;
          check_block(velocity_, block.points(x), block.vectors(u), ids, t, steps_before + i + 1);
          std::size_t row = 0;
          for (const PathIntegral* integral : integrals_)
            for (std::size_t end = row + integral->rows(); row < end; ++row)
              check_rates(*integral, block.points(x), values + row * length, ids, velocity_.shown_time(t),
                          steps_before + i + 1);
        });
      };
      const auto traced_rate = [&](double t, const double* x, double* u) {
        rate(t, x, u);
        check(t, x, u, u + dimension * length);
      };
      for (; i < first + count; ++i) {
        time::step(tableau_, interval.start(i), interval.length(i), traced_rate, block.state.data(), work);
        check(interval.start(i + 1), block.state.data(), block.state.data(), block.state.data() + dimension * length);
      }
    }
    results[b] = std::move(block.state);
  };
  if (drifts_.empty())
    base::parallel_for({blocks, rates * value_seconds(velocity_)}, threads_, carry);
  else
    carry(0);

  for (std::size_t b = 0; b < blocks; ++b) {
    const std::size_t begin = b * longest, length = std::min(longest, particles.size() - begin);
    for (std::size_t k = 0; k < rows; ++k) std::copy_n(results[b].data() + k * length, length, column(k) + begin);
  }
  return {std::accumulate(seconds.begin(), seconds.end(), 0.0), drift_seconds};
}

}  // namespace gaussdrift

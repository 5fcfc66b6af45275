#include "sim/stepper.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "time/runge_kutta.hpp"

namespace gaussdrift {

namespace {

constexpr std::size_t block_length = 256;  // particles stepped together: state and stages stay in the first-level cache

bool all_finite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

// NaN has a sign that means nothing to anybody.
std::string number(double value) { return std::isnan(value) ? "nan" : fmt::format("{:.6g}", value); }

std::string tuple(const double* values, std::size_t stride, int dimension) {
  std::string text = "(";
  for (int k = 0; k < dimension; ++k)
    text += fmt::format("{}{}", k ? ", " : "", number(values[static_cast<std::size_t>(k) * stride]));
  return text + ")";
}

// The block's coordinates, axis after axis, each `length` long: the flat state that the integrator sees.
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

void Stepper::advance(Particles& particles, const time::Interval& interval, std::size_t first, std::size_t count,
                      std::size_t steps_before) const {
  const int dimension = particles.dimension;
  const std::size_t blocks = (particles.size() + block_length - 1) / block_length;
  std::vector<std::vector<double>> results(blocks);

  base::parallel_for(blocks, threads_, [&](std::size_t b) {
    const std::size_t begin = b * block_length, length = std::min(block_length, particles.size() - begin);
    Block block{dimension, length, std::vector<double>(length * static_cast<std::size_t>(dimension))};
    const auto load = [&] {
      for (int k = 0; k < dimension; ++k)
        std::copy_n(particles.position[k].data() + begin, length,
                    block.state.data() + static_cast<std::size_t>(k) * length);
    };
    time::Stages work(tableau_, block.state.size());
    const auto rate = [&](double t, const double* x, double* u) {
      std::fill_n(u, block.state.size(), 0.0);
      velocity_.add(t, block.points(x), block.vectors(u));
    };
    load();
    for (std::size_t i = first; i < first + count; ++i)
      time::step(tableau_, interval.start(i), interval.length(i), rate, block.state.data(), work);

    // What is not finite stays so, hence one look after many steps; only a failure is traced step by step.
    if (!all_finite(block.state)) {
      load();
      std::size_t i = first;
      const auto traced_rate = [&](double t, const double* x, double* u) {
        rate(t, x, u);
        for (std::size_t j = 0; j < length; ++j) {
          bool finite = true;
          for (int k = 0; k < dimension; ++k)
            finite = finite && std::isfinite(u[static_cast<std::size_t>(k) * length + j]);
          if (finite) continue;
          throw NumericalError(fmt::format(
              "the velocity is {} in step {} at t = {:.10g}, for particle {} at {}; the field must be finite wherever "
              "particles go: guard the expression, shorten time.end, or move the density",
              tuple(u + j, length, dimension), steps_before + i + 1, t, particles.id[begin + j],
              tuple(x + j, length, dimension)));
        }
      };
      for (; i < first + count; ++i) {
        time::step(tableau_, interval.start(i), interval.length(i), traced_rate, block.state.data(), work);
        for (std::size_t j = 0; j < length; ++j)
          for (int k = 0; k < dimension; ++k)
            if (!std::isfinite(block.state[static_cast<std::size_t>(k) * length + j]))
              throw NumericalError(fmt::format(
                  "particle {} left for infinity in step {} at t = {:.10g}; time.step = {:.6g} is too "
                  "long for this field, or the flow itself blows up",
                  particles.id[begin + j], steps_before + i + 1, interval.start(i + 1), interval.length(i)));
      }
    }
    results[b] = std::move(block.state);
  });

  for (std::size_t b = 0; b < blocks; ++b) {
    const std::size_t begin = b * block_length, length = std::min(block_length, particles.size() - begin);
    for (int k = 0; k < dimension; ++k)
      std::copy_n(results[b].data() + static_cast<std::size_t>(k) * length, length,
                  particles.position[k].data() + begin);
  }
}

}  // namespace gaussdrift

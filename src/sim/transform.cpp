#include "sim/transform.hpp"

#include <fmt/format.h>
#include <fgtd/fgtd.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "base/duration_text.hpp"
#include "base/stopwatch.hpp"
#include "base/users_words.hpp"
#include "gaussdrift/error.hpp"
#include "sim/blob_sum.hpp"
#include "sim/tiled_density.hpp"
#include "sim/transform_errors.hpp"

namespace gaussdrift {

namespace {

// Some particles where the density is probably large: those of largest weight, and a few spread over all of them.
std::vector<std::size_t> promising_particles(const Particles& particles) {
  constexpr std::size_t wanted = 16;
  const std::size_t count = particles.size();
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  const std::size_t heaviest = std::min(wanted, count);
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(heaviest), order.end(),
                    [&](std::size_t a, std::size_t b) {
                      const double wa = std::abs(particles.alpha[a]), wb = std::abs(particles.alpha[b]);
                      return wa != wb ? wa > wb : a < b;
                    });
  order.resize(heaviest);
  for (std::size_t i = 0; i < wanted; ++i) order.push_back(i * count / wanted);
  return order;
}

// The largest among some promising points, by `direct`: lower bounds of the maxima.
template <int d, int e>
OfQuantities lower_bounds_of_maxima(const BlobSum<d, e>& blobs, const Particles& particles) {
  const std::vector<std::size_t> chosen = promising_particles(particles);
  fgtd::Points<d> targets(d, static_cast<Eigen::Index>(chosen.size()));
  for (std::size_t i = 0; i < chosen.size(); ++i)
    targets.col(static_cast<Eigen::Index>(i)) = blobs.sources().col(static_cast<Eigen::Index>(chosen[i]));
  return blobs.largest_near(targets);
}

template <int d, int e>
void measure(const BlobSum<d, e>& blobs, const Lattice& lattice, const std::vector<double>& values,
             DensityReport& report) {
  // At most 2e7 pairs, so that measuring stays a small part of any run; never fewer than 4 points.
  const std::size_t wanted = std::clamp<std::size_t>(20'000'000 / blobs.size(), 4, 200);
  const std::size_t points = lattice.size(), quantities = values.size() / points;
  std::vector<std::size_t> sample;
  OfQuantities maxima;
  for (std::size_t q = 0; q < quantities; ++q) {
    const std::span<const double> of_quantity(values.data() + q * points, points);
    sample.push_back(number_of_largest(of_quantity));
    maxima.push_back(std::abs(of_quantity[sample.back()]));
  }
  for (const std::size_t number : spread_numbers(points, std::min(wanted, points))) sample.push_back(number);
  report.sample = sample.size();
  tell_errors(blobs.largest_errors(lattice, whole(lattice), values, sample), maxima, report);
}

template <int d, int e>
DensityWork predict_in_dimension(const Particles& particles, const Cutoff& cutoff, const Lattice& lattice,
                                 const DensityOptions& options) {
  DensityReport ignored;
  BlobSum<d, e> blobs(particles, cutoff, options);
  blobs.choose_tolerance(blobs.error_of_unit_tolerance(particles), lower_bounds_of_maxima(blobs, particles), ignored);
  return blobs.predict(nodes_of(lattice, whole(lattice)));
}

template <int d, int e>
void evaluate_in_dimension(const Particles& particles, const Cutoff& cutoff, DensityGrid& grid,
                           const DensityOptions& options, DensityReport& report) {
  const base::Stopwatch evaluating;
  const fgtd::TensorGrid nodes = nodes_of(grid.lattice, whole(grid.lattice));
  BlobSum<d, e> blobs(particles, cutoff, options);
  const OfQuantities unit_errors = blobs.error_of_unit_tolerance(particles);
  const OfQuantities expected = lower_bounds_of_maxima(blobs, particles);
  blobs.choose_tolerance(unit_errors, expected, report);
  Eigen::MatrixXd values = blobs.transform(nodes, report);
  // Where most of the density has left the grid, the largest value on it decides, and the first tolerance was too
  // coarse.
  const Eigen::RowVectorXd largest = values.cwiseAbs().colwise().maxCoeff();
  const OfQuantities found(largest.begin(), largest.end());
  if (is_too_coarse(found, expected)) {
    const double before = report.requested_tolerance;
    blobs.choose_tolerance(unit_errors, found, report);
    if (found[0] > 0 && report.requested_tolerance < before) values = blobs.transform(nodes, report);
  }
  grid.rho.assign(values.data(), values.data() + values.rows());
  report.derivatives.clear();
  for (Eigen::Index q = 1; q < values.cols(); ++q)
    report.derivatives.emplace_back(values.col(q).begin(), values.col(q).end());
  report.evaluate_seconds = evaluating.seconds();
  if (options.measure) {
    const base::Stopwatch measuring;
    measure(blobs, grid.lattice, {values.data(), values.data() + values.size()}, report);
    report.measure_seconds = measuring.seconds();
  }
}

}  // namespace

void raise(OfQuantities& largest, const OfQuantities& other) {
  for (std::size_t q = 0; q < largest.size(); ++q) largest[q] = std::max(largest[q], other[q]);
}

bool is_too_coarse(const OfQuantities& found, const OfQuantities& expected) {
  for (std::size_t q = 0; q < found.size(); ++q)
    if (found[q] < 0.5 * expected[q]) return true;
  return false;
}

void tell_errors(const OfQuantities& errors, const OfQuantities& maxima, DensityReport& report) {
  const auto relative = [&](std::size_t q) { return maxima[q] > 0 ? errors[q] / maxima[q] : errors[q]; };
  report.measured_error = relative(0);
  report.derivatives_error = 0;
  for (std::size_t q = 1; q < errors.size(); ++q)
    report.derivatives_error = std::max(report.derivatives_error, relative(q));
}

Tiles tiles_of(const Particles& particles, const Cutoff& cutoff, const Lattice& lattice, const DensityOptions& options,
               const Tiles::SumOverProcesses& sum) {
  return {lattice, reach_of_blob(cutoff, options), particles.view(),
          options.tiles.value_or(usual_tiles(lattice.dimension)), sum};
}

DensityGrid evaluate_at_once(const Particles& particles, const Cutoff& cutoff, const Lattice& lattice,
                             const DensityOptions& options, DensityReport* report) {
  DensityReport ignored;
  DensityReport& filled = report ? *report : ignored;
  filled = {};
  DensityGrid grid{lattice, {}};
  if (particles.size() == 0) {
    grid.rho.assign(lattice.size(), 0.0);
    filled.derivatives.assign(options.derivatives.size(), grid.rho);
    filled.choice = "no particles carry weight";
    return grid;
  }
  in_words_of_a_case([&] {
    in_dimensions(lattice.dimension, cutoff,
                  [&](auto d, auto e) { evaluate_in_dimension<d, e>(particles, cutoff, grid, options, filled); });
  });
  return grid;
}

DensityGrid evaluate_density(const Particles& particles, const Cutoff& cutoff, const Lattice& lattice,
                             const DensityOptions& options, DensityReport* report) {
  if (particles.size() == 0) return evaluate_at_once(particles, cutoff, lattice, options, report);
  const Tiles tiles = tiles_of(particles, cutoff, lattice, options);
  if (tiles.list().size() == 1) return evaluate_at_once(particles, cutoff, lattice, options, report);
  DensityReport ignored;
  DensityReport& filled = report ? *report : ignored;
  filled = {};
  DensityGrid grid{lattice, std::vector<double>(lattice.size())};
  filled.derivatives.assign(options.derivatives.size(), grid.rho);
  const std::vector<char> all(tiles.list().size(), 1);
  base::Communicator alone;
  for (const auto& [tile, values] :
       evaluate_tiles({particles, {}}, tiles, all, cutoff, lattice, options, alone, filled))
    place(values, tiles.list()[tile], grid, filled.derivatives);
  return grid;
}

DensityWork predict_density(const Particles& particles, const Cutoff& cutoff, const Lattice& lattice,
                            const DensityOptions& options) {
  if (particles.size() == 0) return {};
  const Tiles tiles = tiles_of(particles, cutoff, lattice, options);
  return in_words_of_a_case([&] {
    if (tiles.list().size() > 1) return predict_tiles(particles, tiles, cutoff, lattice, options);
    return in_dimensions(lattice.dimension, cutoff, [&](auto d, auto e) {
      return predict_in_dimension<d, e>(particles, cutoff, lattice, options);
    });
  });
}

void check_seconds(const EvaluateSpec& evaluate, const DensityWork& work, int threads,
                   const std::function<DensityWork()>& fastest) {
  constexpr double most_if_named = 300;  // as `sum` has it
  const double most = evaluate.most_seconds > 0 ? evaluate.most_seconds : most_if_named;
  const double seconds = work.seconds / threads;
  if (seconds <= most) return;
  const DensityWork other = fastest();
  const bool faster = other.seconds < work.seconds / 2;
  throw InputError(fmt::format(
      "evaluate.method = \"{}\" would take about {} for each density on {} {}, and only densities of up to {} are "
      "begun. {}, or raise evaluate.most_seconds.",
      evaluate.method, base::duration_text(seconds), threads, threads == 1 ? "thread" : "threads",
      base::duration_text(most),
      faster ? fmt::format("Use evaluate.method = \"auto\", which takes about {} ({})",
                           base::duration_text(other.seconds / threads), other.method)
             : "Lower evaluate.per_axis or particles.per_axis"));
}

namespace {

template <int d, int e>
std::vector<double> sum_blobs_in(const Particles& particles, const Cutoff& cutoff, const PointsView& points,
                                 int threads) {
  fgtd::Points<d> targets(d, static_cast<Eigen::Index>(points.count));
  for (int k = 0; k < d; ++k)
    targets.row(k) = Eigen::Map<const Eigen::RowVectorXd>(points.axis[k], static_cast<Eigen::Index>(points.count));
  DensityOptions options;
  options.threads = threads;
  const Eigen::VectorXd sum = BlobSum<d, e>(particles, cutoff, options).direct(targets);
  return {sum.data(), sum.data() + sum.size()};
}

}  // namespace

std::vector<double> sum_blobs(const Particles& particles, const Cutoff& cutoff, const PointsView& points, int threads) {
  if (particles.size() == 0 || points.count == 0) return std::vector<double>(points.count, 0.0);
  return in_dimensions(particles.dimension, cutoff,
                       [&](auto d, auto e) { return sum_blobs_in<d, e>(particles, cutoff, points, threads); });
}

}  // namespace gaussdrift

#include "sim/transform.hpp"

#include <fmt/format.h>
#include <fgtd/fgtd.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

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

// Largest |rho| among some promising points, by `direct`: a lower bound of max |rho|.
template <int d>
double lower_bound_of_maximum(const BlobSum<d>& blobs, const Particles& particles) {
  const std::vector<std::size_t> chosen = promising_particles(particles);
  fgtd::Points<d> targets(d, static_cast<Eigen::Index>(chosen.size()));
  for (std::size_t i = 0; i < chosen.size(); ++i)
    targets.col(static_cast<Eigen::Index>(i)) = blobs.sources().col(static_cast<Eigen::Index>(chosen[i]));
  return blobs.direct(targets).cwiseAbs().maxCoeff();
}

template <int d>
void measure(const BlobSum<d>& blobs, const Lattice& lattice, const std::vector<double>& rho, DensityReport& report) {
  // At most 2e7 pairs, so that measuring stays a small part of any run; never fewer than 4 points.
  const std::size_t wanted = std::clamp<std::size_t>(20'000'000 / blobs.size(), 4, 200);
  std::vector<std::size_t> sample{number_of_largest(rho)};
  const double maximum = std::abs(rho[sample.front()]);
  for (const std::size_t number : spread_numbers(rho.size(), std::min(wanted, rho.size()))) sample.push_back(number);
  const double error = blobs.largest_error(lattice, whole(lattice), rho, sample);
  report.measured_error = maximum > 0 ? error / maximum : error;
  report.sample = sample.size();
}

template <int d>
DensityWork predict_in_dimension(const Particles& particles, const Cutoff& cutoff, const Lattice& lattice,
                                 const DensityOptions& options) {
  DensityReport ignored;
  BlobSum<d> blobs(particles, cutoff, options);
  blobs.choose_tolerance(blobs.error_of_unit_tolerance(particles), lower_bound_of_maximum(blobs, particles), ignored);
  return blobs.predict(nodes_of(lattice, whole(lattice)));
}

template <int d>
void evaluate_in_dimension(const Particles& particles, const Cutoff& cutoff, DensityGrid& grid,
                           const DensityOptions& options, DensityReport& report) {
  const base::Stopwatch evaluating;
  const fgtd::TensorGrid nodes = nodes_of(grid.lattice, whole(grid.lattice));
  BlobSum<d> blobs(particles, cutoff, options);
  const double unit_error = blobs.error_of_unit_tolerance(particles);
  const double expected = lower_bound_of_maximum(blobs, particles);
  blobs.choose_tolerance(unit_error, expected, report);
  Eigen::VectorXd rho = blobs.transform(nodes, report);
  // Where most of the density has left the grid, the largest value on it decides, and the first tolerance was too
  // coarse.
  const double found = rho.cwiseAbs().maxCoeff();
  if (found < 0.5 * expected) {
    const double before = report.requested_tolerance;
    blobs.choose_tolerance(unit_error, found, report);
    if (found > 0 && report.requested_tolerance < before) rho = blobs.transform(nodes, report);
  }
  grid.rho.assign(rho.data(), rho.data() + rho.size());
  report.evaluate_seconds = evaluating.seconds();
  if (options.measure) {
    const base::Stopwatch measuring;
    measure(blobs, grid.lattice, grid.rho, report);
    report.measure_seconds = measuring.seconds();
  }
}

}  // namespace

Tiles tiles_of(const Particles& particles, const Cutoff& cutoff, const Lattice& lattice, const DensityOptions& options,
               const Tiles::SumOverProcesses& sum) {
  return {lattice, reach_of_blob(cutoff), particles.view(), options.tiles.value_or(usual_tiles(lattice.dimension)),
          sum};
}

DensityGrid evaluate_at_once(const Particles& particles, const Cutoff& cutoff, const Lattice& lattice,
                             const DensityOptions& options, DensityReport* report) {
  DensityReport ignored;
  DensityReport& filled = report ? *report : ignored;
  filled = {};
  DensityGrid grid{lattice, {}};
  if (particles.size() == 0) {
    grid.rho.assign(lattice.size(), 0.0);
    filled.choice = "no particles carry weight";
    return grid;
  }
  in_words_of_a_case([&] {
    if (lattice.dimension == 2)
      evaluate_in_dimension<2>(particles, cutoff, grid, options, filled);
    else
      evaluate_in_dimension<3>(particles, cutoff, grid, options, filled);
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
  const std::vector<char> all(tiles.list().size(), 1);
  base::Communicator alone;
  for (const auto& [tile, rho] : evaluate_tiles({particles, {}}, tiles, all, cutoff, lattice, options, alone, filled))
    place(rho, tiles.list()[tile], lattice, grid.rho);
  return grid;
}

DensityWork predict_density(const Particles& particles, const Cutoff& cutoff, const Lattice& lattice,
                            const DensityOptions& options) {
  if (particles.size() == 0) return {};
  const Tiles tiles = tiles_of(particles, cutoff, lattice, options);
  return in_words_of_a_case([&] {
    if (tiles.list().size() > 1) return predict_tiles(particles, tiles, cutoff, lattice, options);
    return lattice.dimension == 2 ? predict_in_dimension<2>(particles, cutoff, lattice, options)
                                  : predict_in_dimension<3>(particles, cutoff, lattice, options);
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

template <int d>
std::vector<double> sum_blobs_in(const Particles& particles, const Cutoff& cutoff, const PointsView& points,
                                 int threads) {
  fgtd::Points<d> targets(d, static_cast<Eigen::Index>(points.count));
  for (int k = 0; k < d; ++k)
    targets.row(k) = Eigen::Map<const Eigen::RowVectorXd>(points.axis[k], static_cast<Eigen::Index>(points.count));
  DensityOptions options;
  options.threads = threads;
  const Eigen::VectorXd sum = BlobSum<d>(particles, cutoff, options).direct(targets);
  return {sum.data(), sum.data() + sum.size()};
}

}  // namespace

std::vector<double> sum_blobs(const Particles& particles, const Cutoff& cutoff, const PointsView& points, int threads) {
  if (particles.size() == 0 || points.count == 0) return std::vector<double>(points.count, 0.0);
  return particles.dimension == 2 ? sum_blobs_in<2>(particles, cutoff, points, threads)
                                  : sum_blobs_in<3>(particles, cutoff, points, threads);
}

}  // namespace gaussdrift

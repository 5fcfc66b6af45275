// A plan and an evaluation of farfield on four ranks, each a thread, against one: processor seconds, alternating, and the
// bytes that a rank receives. docs/distributed.md has the table.
//
//   bench_farfield_ranks [rounds [points]]
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <string>
#include <vector>

#include "../../tests/farfield/naive.hpp"
#include "../../tests/farfield/ranks.hpp"

using farfield::Kernel;
using farfield::Points;

namespace {

constexpr int size = 4;

double processor_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

struct OfRanks {
  double sum = 0, largest = 0;
  farfield::Received received;  // by the rank that receives most
};

double all(const farfield::Received& received) {
  return received.points + received.tree + received.moments + received.near;
}

/// A rank has every fourth block of 1024 points.
template <int d>
OfRanks on_four(Kernel kernel, const Points<d>& points, const Eigen::VectorXd& charges,
                const farfield::Options& options) {
  OfRanks of;
  std::mutex mutex;
  const auto on_rank = [&](farfield::Ranks& ranks) {
    std::vector<std::int64_t> numbers;
    for (Eigen::Index j = 0; j < points.cols(); ++j)
      if (j / 1024 % size == ranks.rank()) numbers.push_back(j);
    Points<d> own(d, static_cast<Eigen::Index>(numbers.size()));
    Eigen::VectorXd weights(own.cols());
    for (Eigen::Index i = 0; i < own.cols(); ++i) {
      own.col(i) = points.col(numbers[static_cast<std::size_t>(i)]);
      weights[i] = charges[numbers[static_cast<std::size_t>(i)]];
    }
    const double begun = processor_seconds();
    const farfield::Plan<d> plan(kernel, own, numbers, options, ranks);
    plan.evaluate(weights);
    const double seconds = processor_seconds() - begun;
    const std::lock_guard lock(mutex);
    of.sum += seconds;
    of.largest = std::max(of.largest, seconds);
    if (all(plan.received()) > all(of.received)) of.received = plan.received();
  };
  test::on_ranks(size, on_rank, gaussdrift::InTurns::yes);
  return of;
}

template <int d>
void measure(const char* name, Kernel kernel, const Points<d>& points, farfield::Options options, int rounds) {
  options.threads = 1;
  const Eigen::VectorXd charges = Eigen::VectorXd::Ones(points.cols());
  const farfield::Plan<d> keeps_the_tables(kernel, points, options);
  std::vector<double> one, sum, largest;
  OfRanks four;
  for (int i = 0; i < rounds; ++i) {
    const double begun = processor_seconds();
    farfield::Plan<d>(kernel, points, options).evaluate(charges);
    one.push_back(processor_seconds() - begun);
    four = on_four<d>(kernel, points, charges, options);
    sum.push_back(four.sum / one.back());
    largest.push_back(four.largest / (four.sum / size));
  }
  const farfield::Received& in = four.received;
  std::printf(
      "%s: %.3g points, one rank %.3g s; 4 ranks: sum %.3f of one, largest %.3f of the mean; the most received: "
      "%.3g MB of points, %.3g tree, %.3g moments, %.3g near\n",
      name, static_cast<double>(points.cols()), median(one), median(sum), median(largest), in.points * 1e-6,
      in.tree * 1e-6, in.moments * 1e-6, in.near * 1e-6);
}

}  // namespace

int main(int count, char** arguments) {
  const int rounds = count > 1 ? std::atoi(arguments[1]) : 3;
  const auto points = static_cast<Eigen::Index>(count > 2 ? std::atof(arguments[2]) : 1e6);
  measure<3>("cube, 3e-4", Kernel::coulomb, naive::cube<3>(points, 1), {.tolerance = 3e-4}, rounds);
  measure<3>("Plummer's sphere, 3e-4", Kernel::coulomb, naive::plummer<3>(points, 1), {.tolerance = 3e-4}, rounds);
  measure<2>("logarithms in the square, 1e-6", Kernel::log, naive::cube<2>(points, 1), {.tolerance = 1e-6}, rounds);
  measure<2>("vortex blobs in the square, 1e-6", Kernel::vortex_blob, naive::cube<2>(points, 1),
             {.tolerance = 1e-6, .core_radius = 2 / std::sqrt(static_cast<double>(points))}, rounds);
}

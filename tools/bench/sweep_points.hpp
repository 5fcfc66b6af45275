// Points of a sweep over dimension, numbers of sources and targets, sigma, tolerance and kind of targets, and the time
// that a method takes at one of them.
#pragma once

#include <algorithm>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "fgtd/choose.hpp"
#include "workloads.hpp"

namespace bench {

struct SweepPoint {
  int dimension;
  int sources;
  int targets;    // scattered, or about as many nodes
  double widths;  // extent of the sources in units of sigma^{-1/2}
  double tolerance;
  bool grid;
  int derivative_order;
  bool clustered;

  std::string text() const {
    char buffer[160];
    std::snprintf(buffer, sizeof buffer, "d=%d N=%d M=%d widths=%g tolerance=%g %s order=%d%s", dimension, sources,
                  targets, widths, tolerance, grid ? "grid" : "points", derivative_order,
                  clustered ? " clustered" : "");
    return buffer;
  }
};

/// Drawn at random over the whole range with a fixed seed, so that the first ones of a longer sweep are the same.
inline std::vector<SweepPoint> sweep_points(int count) {
  std::mt19937 random(20);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
  };
  std::vector<SweepPoint> points;
  while (static_cast<int>(points.size()) < count) {
    SweepPoint point{};
    point.dimension = 1 + static_cast<int>(uniform(0, 3));
    point.sources = static_cast<int>(std::pow(10, uniform(2, 5.3)));
    point.targets = static_cast<int>(std::pow(10, uniform(2, 5.3)));
    point.widths = std::pow(10, uniform(-1, 3.5));
    point.tolerance = std::pow(10, -uniform(2, 13));
    point.grid = uniform(0, 1) < 0.5;
    point.derivative_order = uniform(0, 1) < 0.7 ? 0 : 1 + static_cast<int>(uniform(0, 2));
    point.clustered = uniform(0, 1) < 0.25;
    points.push_back(point);
  }
  return points;
}

struct Timing {
  fgtd::Choice choice;
  double seconds = 0;  // of plan and evaluation
  bool done = false;   // false: its own prediction is beyond the limit
};

/// The point in the dimension d made concrete; times one method after the other.
template <int d>
class SweepTask {
 public:
  explicit SweepTask(const SweepPoint& point) : point_(point) {
    std::mt19937 random(21);
    std::uniform_real_distribution<double> unit(0, 1);
    std::normal_distribution<double> normal;
    const auto fill = [&](fgtd::Points<d>& points, int count) {
      points.resize(d, count);
      for (int j = 0; j < count; ++j)
        for (int l = 0; l < d; ++l)
          points(l, j) = point.clustered ? 0.2 + 0.15 * (j % 5) + 0.01 * normal(random) : unit(random);
    };
    fill(sources_, point.sources);
    weights_ = Eigen::MatrixXd::Random(point.sources, 1);
    sigma_ = point.widths * point.widths;
    alpha_[0] = point.derivative_order;
    if (!point.grid) {
      fill(targets_, point.targets);
      return;
    }
    const int nodes = std::max(2, static_cast<int>(std::round(std::pow(point.targets, 1.0 / d))));
    std::vector<double> axis;
    for (int i = 0; i < nodes; ++i) axis.push_back((i + 0.5) / nodes);
    grid_.axes.assign(d, axis);
  }

  /// What is chosen and predicted.
  fgtd::Choice predict(fgtd::Method method) const {
    fgtd::detail::Buffer<double> position(static_cast<std::size_t>(sources_.size()));
    for (Eigen::Index j = 0; j < sources_.cols(); ++j)
      for (int l = 0; l < d; ++l) position[static_cast<std::size_t>(l * sources_.cols() + j)] = sources_(l, j);
    return fgtd::detail::choose<d>(position, static_cast<std::size_t>(sources_.cols()), 1, sigma_, options(method))
        .choice;
  }

  /// The best of up to three; nothing is run that predicts more than `limit` seconds.
  Timing time(fgtd::Method method, double limit) const {
    Timing timing;
    double total = 0;
    for (int turn = 0; turn < 3 && total < 0.3; ++turn) {
      bool beyond = false;
      const double seconds = processor_seconds([&] {
        const fgtd::Plan<d> plan(sources_, weights_, sigma_, options(method));
        timing.choice = plan.choice();
        beyond = timing.choice.seconds > limit;
        if (beyond) return;
        const Eigen::MatrixXd values = point_.grid ? plan.evaluate(grid_, alpha_) : plan.evaluate(targets_, alpha_);
        checksum_ += values(0, 0);
      });
      if (beyond) return timing;
      timing.seconds = timing.done ? std::min(timing.seconds, seconds) : seconds;
      timing.done = true;
      total += seconds;
    }
    return timing;
  }

 private:
  fgtd::Options options(fgtd::Method method) const {
    fgtd::Options options{
        .tolerance = point_.tolerance, .derivative_order = point_.derivative_order, .method = method, .threads = 1};
    if (point_.grid) {
      options.expected_grid = grid_;
    } else {
      options.expected_targets = static_cast<std::size_t>(point_.targets);
    }
    return options;
  }

  SweepPoint point_;
  fgtd::Points<d> sources_, targets_;
  Eigen::MatrixXd weights_;
  fgtd::TensorGrid grid_;
  double sigma_ = 1;
  fgtd::Derivative<d> alpha_{};
  mutable double checksum_ = 0;  // keeps the work
};

/// Calls work(task) with the task of the point's dimension.
template <class Work>
void with_task(const SweepPoint& point, const Work& work) {
  if (point.dimension == 1) work(SweepTask<1>(point));
  if (point.dimension == 2) work(SweepTask<2>(point));
  if (point.dimension == 3) work(SweepTask<3>(point));
}

}  // namespace bench

#include "sim/transform.hpp"

#include <fmt/format.h>
#include <fgtd/fgtd.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <sstream>

#include "base/duration_text.hpp"
#include "base/stopwatch.hpp"
#include "base/users_words.hpp"
#include "base/weight_within.hpp"
#include "gaussdrift/error.hpp"
#include "particle/fgtd_points.hpp"

namespace gaussdrift {

namespace {

// All terms of one Gaussian width: one prepared transform, evaluated with derivatives.
template <int d>
struct WidthGroup {
  double sigma = 0;  // 1 / width^2
  fgtd::Combination<d> combination;
  int derivative_order = 0;
  double scale = 0;  // sum |c_alpha| N_alpha, the largest value of the combination for a unit weight
};

template <int d>
std::vector<WidthGroup<d>> group_by_width(const Cutoff& cutoff) {
  std::map<double, WidthGroup<d>> groups;
  for (const CutoffTerm& term : cutoff) {
    WidthGroup<d>& group = groups[term.width];
    group.sigma = 1 / (term.width * term.width);
    fgtd::Derivative<d> alpha{};
    for (int k = 0; k < d; ++k) alpha[static_cast<std::size_t>(k)] = term.derivative[static_cast<std::size_t>(k)];
    group.combination.push_back({alpha, term.coefficient});
    group.derivative_order = std::max(group.derivative_order, std::accumulate(alpha.begin(), alpha.end(), 0));
    group.scale += std::abs(term.coefficient) * fgtd::derivative_scale<d>(alpha, group.sigma);
  }
  std::vector<WidthGroup<d>> list;
  for (auto& [width, group] : groups) list.push_back(std::move(group));
  return list;
}

fgtd::Method method_by_name(const std::string& name) {
  std::string known;
  for (const fgtd::Method method : fgtd::methods()) {
    if (fgtd::to_string(method) == name) return method;
    known += (known.empty() ? "" : ", ") + fgtd::to_string(method);
  }
  throw InputError("evaluate.method = \"" + name + "\" is not a method of the Gauss transform; there are " + known);
}

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

// Grid points to compare with `direct`: the one of the largest |rho|, and a low-discrepancy choice of others.
std::vector<std::size_t> points_to_measure(const std::vector<double>& rho, std::size_t wanted) {
  std::vector<std::size_t> sample;
  const auto largest =
      std::max_element(rho.begin(), rho.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  sample.push_back(static_cast<std::size_t>(largest - rho.begin()));
  constexpr double golden = 0.61803398874989485;  // multiples of the golden ratio fill [0, 1) evenly
  for (std::size_t i = 1; i < wanted; ++i) {
    const double fraction = std::fmod(static_cast<double>(i) * golden, 1.0);
    sample.push_back(std::min(rho.size() - 1, static_cast<std::size_t>(fraction * static_cast<double>(rho.size()))));
  }
  return sample;
}

template <int d>
class Evaluation {
 public:
  Evaluation(const Particles& particles, const Cutoff& cutoff, const DensityOptions& options)
      : options_(options),
        sources_(points_of<d>(particles)),
        weights_(
            Eigen::Map<const Eigen::VectorXd>(particles.alpha.data(), static_cast<Eigen::Index>(particles.size()))),
        groups_(group_by_width<d>(cutoff)) {}

  // Largest |rho| among some promising points, by `direct`: a lower bound of max |rho|.
  double lower_bound_of_maximum(const Particles& particles) const {
    const std::vector<std::size_t> chosen = promising_particles(particles);
    fgtd::Points<d> targets(d, static_cast<Eigen::Index>(chosen.size()));
    for (std::size_t i = 0; i < chosen.size(); ++i)
      targets.col(static_cast<Eigen::Index>(i)) = sources_.col(static_cast<Eigen::Index>(chosen[i]));
    return direct(targets).cwiseAbs().maxCoeff();
  }

  // The error that a per-term tolerance of 1 gives at most.
  double error_of_unit_tolerance(const Particles& particles) const {
    double error = 0;
    for (const WidthGroup<d>& group : groups_) {
      const double reach = std::sqrt((2 * std::log(1 / options_.tolerance) + 40) / group.sigma);
      error += group.scale * largest_weight_within(particles.view(), particles.alpha.data(), reach);
    }
    return error;
  }

  // The promise of fgtd is tolerance * N * (weight around the target); the simulator's is relative to max |rho|.
  void choose_tolerance(double unit_error, double maximum, DensityReport& report) {
    constexpr double coarsest = 0.1;  // nothing is gained above
    const double wanted = unit_error > 0 ? options_.tolerance * maximum / unit_error : coarsest;
    tolerance_ = std::clamp(wanted, fgtd::smallest_tolerance, coarsest);
    report.requested_tolerance = tolerance_;
    report.achievable = wanted >= fgtd::smallest_tolerance || maximum == 0
                            ? options_.tolerance
                            : fgtd::smallest_tolerance * unit_error / maximum;
  }

  DensityWork predict(const fgtd::TensorGrid& grid) const {
    DensityWork work;
    for (const WidthGroup<d>& group : groups_) {
      fgtd::Options options = options_for(group, grid);
      options.most_seconds = 0;  // any work is more, so the plan tells how much and does nothing
      try {
        fgtd::Plan<d>(sources_, weights_, group.sigma, options);
      } catch (const fgtd::TimeLimitError& limit) {
        work.seconds += limit.seconds;
        work.method = to_string(limit.method);
      }
    }
    return work;
  }

  Eigen::VectorXd transform(const fgtd::TensorGrid& grid, DensityReport& report) const {
    report.choice.clear();
    Eigen::VectorXd rho = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(grid.size()));
    for (const WidthGroup<d>& group : groups_) {
      const fgtd::Plan<d> plan(sources_, weights_, group.sigma, options_for(group, grid));
      rho += plan.evaluate_combination(grid, group.combination);
      std::ostringstream text;
      text << plan.choice();
      if (!report.choice.empty()) report.choice += '\n';
      report.choice += text.str();
    }
    return rho;
  }

  Eigen::VectorXd direct(const fgtd::Points<d>& targets) const {
    Eigen::VectorXd rho = Eigen::VectorXd::Zero(targets.cols());
    for (const WidthGroup<d>& group : groups_) {
      fgtd::Options options;
      options.method = fgtd::Method::direct;
      options.derivative_order = group.derivative_order;
      options.threads = options_.threads;
      rho += fgtd::Plan<d>(sources_, weights_, group.sigma, options).evaluate_combination(targets, group.combination);
    }
    return rho;
  }

  void measure(const Lattice& lattice, const std::vector<double>& rho, DensityReport& report) const {
    // At most 2e7 pairs, so that measuring stays a small part of any run; never fewer than 4 points.
    const std::size_t wanted = std::clamp<std::size_t>(20'000'000 / static_cast<std::size_t>(sources_.cols()), 4, 200);
    const std::vector<std::size_t> sample = points_to_measure(rho, std::min(wanted, rho.size()));
    fgtd::Points<d> targets(d, static_cast<Eigen::Index>(sample.size()));
    for (std::size_t i = 0; i < sample.size(); ++i) {
      std::size_t index = sample[i];
      for (int k = 0; k < d; ++k) {
        targets(k, static_cast<Eigen::Index>(i)) =
            lattice.coordinate(k, index % lattice.points[static_cast<std::size_t>(k)]);
        index /= lattice.points[static_cast<std::size_t>(k)];
      }
    }
    const Eigen::VectorXd exact = direct(targets);
    double error = 0;
    for (std::size_t i = 0; i < sample.size(); ++i)
      error = std::max(error, std::abs(exact(static_cast<Eigen::Index>(i)) - rho[sample[i]]));
    const double maximum = std::abs(rho[sample.front()]);
    report.measured_error = maximum > 0 ? error / maximum : error;
    report.sample = sample.size();
  }

 private:
  fgtd::Options options_for(const WidthGroup<d>& group, const fgtd::TensorGrid& grid) const {
    fgtd::Options options;
    options.tolerance = tolerance_;
    options.derivative_order = group.derivative_order;
    options.method = method_by_name(options_.method);
    options.threads = options_.threads;
    options.expected_grid = grid;
    return options;
  }

  const DensityOptions& options_;
  fgtd::Points<d> sources_;
  Eigen::MatrixXd weights_;
  std::vector<WidthGroup<d>> groups_;
  double tolerance_ = 0;
};

template <int d>
fgtd::TensorGrid nodes_of(const Lattice& lattice) {
  fgtd::TensorGrid nodes;
  for (int k = 0; k < d; ++k) nodes.axes.push_back(lattice.nodes(k));
  return nodes;
}

template <int d>
DensityWork predict_in_dimension(const Particles& particles, const Cutoff& cutoff, const Lattice& lattice,
                                 const DensityOptions& options) {
  DensityReport ignored;
  Evaluation<d> evaluation(particles, cutoff, options);
  evaluation.choose_tolerance(evaluation.error_of_unit_tolerance(particles),
                              evaluation.lower_bound_of_maximum(particles), ignored);
  return evaluation.predict(nodes_of<d>(lattice));
}

template <int d>
void evaluate_in_dimension(const Particles& particles, const Cutoff& cutoff, DensityGrid& grid,
                           const DensityOptions& options, DensityReport& report) {
  const base::Stopwatch evaluating;
  const fgtd::TensorGrid nodes = nodes_of<d>(grid.lattice);
  Evaluation<d> evaluation(particles, cutoff, options);
  const double unit_error = evaluation.error_of_unit_tolerance(particles);
  const double expected = evaluation.lower_bound_of_maximum(particles);
  evaluation.choose_tolerance(unit_error, expected, report);
  Eigen::VectorXd rho = evaluation.transform(nodes, report);
  // Where most of the density has left the grid, the largest value on it decides, and the first tolerance was too
  // coarse.
  const double found = rho.cwiseAbs().maxCoeff();
  if (found < 0.5 * expected) {
    const double before = report.requested_tolerance;
    evaluation.choose_tolerance(unit_error, found, report);
    if (found > 0 && report.requested_tolerance < before) rho = evaluation.transform(nodes, report);
  }
  grid.rho.assign(rho.data(), rho.data() + rho.size());
  report.evaluate_seconds = evaluating.seconds();
  if (options.measure) {
    const base::Stopwatch measuring;
    evaluation.measure(grid.lattice, grid.rho, report);
    report.measure_seconds = measuring.seconds();
  }
}

/// Errors of fgtd in the words of a case.
template <class Work>
auto in_words_of_a_case(const Work& work) {
  try {
    return work();
  } catch (const fgtd::MemoryLimitError& error) {
    throw InputError(
        fmt::format("summing the density would take {:.3g} GB, at most {:.3g} GB are used; lower "
                    "evaluate.per_axis or particles.per_axis",
                    error.needed / 1e9, static_cast<double>(error.limit) / 1e9));
  } catch (const fgtd::Error& error) {
    throw InputError("the density cannot be summed: " +
                     base::in_users_words(error.what(), {{"Options::tolerance = ", "evaluate.tolerance = "}}) +
                     "; check the size of the domain, particles.per_axis and particles.overlap");
  }
}

}  // namespace

DensityGrid evaluate_density(const Particles& particles, const Cutoff& cutoff, const Lattice& lattice,
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

DensityWork predict_density(const Particles& particles, const Cutoff& cutoff, const Lattice& lattice,
                            const DensityOptions& options) {
  if (particles.size() == 0) return {};
  return in_words_of_a_case([&] {
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
  const fgtd::Points<d> sources = points_of<d>(particles);
  const Eigen::Map<const Eigen::VectorXd> weights(particles.alpha.data(), static_cast<Eigen::Index>(particles.size()));
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(targets.cols());
  for (const WidthGroup<d>& group : group_by_width<d>(cutoff)) {
    const fgtd::Plan<d> plan(
        sources, weights, group.sigma,
        {.tolerance = 1e-10,  // direct sums are exact whatever is asked; orders above 12 need less than 1e-4
         .derivative_order = group.derivative_order,
         .method = fgtd::Method::direct,
         .threads = threads});
    sum += plan.evaluate_combination(targets, group.combination);
  }
  return {sum.data(), sum.data() + sum.size()};
}

}  // namespace

std::vector<double> sum_blobs(const Particles& particles, const Cutoff& cutoff, const PointsView& points, int threads) {
  if (particles.size() == 0 || points.count == 0) return std::vector<double>(points.count, 0.0);
  return particles.dimension == 2 ? sum_blobs_in<2>(particles, cutoff, points, threads)
                                  : sum_blobs_in<3>(particles, cutoff, points, threads);
}

}  // namespace gaussdrift

#include "farfield/general/engine.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/parallel.hpp"
#include "farfield/check.hpp"

namespace farfield::detail {

using gaussdrift::base::parallel_for;

namespace {

constexpr double least_tolerance = 1e-10;
constexpr std::size_t sampled = 128;            // targets
constexpr double aimed_at = 1.0, enough = 0.9;  // of the tolerance
constexpr int attempts = 4;
constexpr double rounding = 1e-14;  // of both ways to sum, relative to the sums without signs

void check(const GeneralOptions& options) {
  const auto refuse = [](const std::string& what) { throw InvalidArgument("farfield: " + what); };
  if (!(options.tolerance >= least_tolerance) || !(options.tolerance < 1))
    refuse("GeneralOptions::tolerance = " + text(options.tolerance) + ", must lie in [" + text(least_tolerance) +
           ", 1)");
  if (options.threads < 0)
    refuse("GeneralOptions::threads = " + std::to_string(options.threads) + ", must be positive, or 0 for all");
  if (!(options.eta >= 0) || !std::isfinite(options.eta))
    refuse("GeneralOptions::eta = " + text(options.eta) + ", must be positive, or 0 to be chosen");
}

/// Sides between admissible cubes.
int separation_of(double eta, int dimension) {
  if (eta == 0) return 1;
  for (int sides = 1; sides <= 4; ++sides)
    if (std::sqrt(dimension) <= eta * sides * (1 + 1e-12)) return sides;
  throw InvalidArgument("farfield: GeneralOptions::eta = " + text(eta) +
                        ", must be at least sqrt(d)/4 = " + text(std::sqrt(dimension) / 4) + ", or 0 to be chosen");
}

template <int d>
Coordinates by_axis(const Eigen::Ref<const Points<d>>& points) {
  Coordinates axes;
  const auto count = static_cast<std::size_t>(points.cols());
  for (std::size_t l = 0; l < d; ++l) {
    axes[l].assign(count + padding, 0.0);
    for (std::size_t i = 0; i < count; ++i)
      axes[l][i] = points(static_cast<Eigen::Index>(l), static_cast<Eigen::Index>(i));
  }
  return axes;
}

/// The root of the trees. Corner and side are multiples of a 512th of the extent, so that centres are exact.
struct Root {
  std::array<double, 3> corner{};
  double side = 1;
};

Root root_of(int dimension, const Coordinates& sources, std::size_t source_count, const Coordinates& targets,
             std::size_t target_count) {
  double low[3], high[3], extent = 0;
  for (std::size_t l = 0; l < static_cast<std::size_t>(dimension); ++l) {
    low[l] = HUGE_VAL;
    high[l] = -HUGE_VAL;
    const auto include = [&](const Buffer<double>& x, std::size_t count) {
      for (std::size_t i = 0; i < count; ++i) {
        low[l] = std::min(low[l], x[i]);
        high[l] = std::max(high[l], x[i]);
      }
    };
    include(sources[l], source_count);
    include(targets[l], target_count);
    if (low[l] <= high[l]) extent = std::max(extent, high[l] - low[l]);
  }
  Root root;
  if (extent == 0) return root;  // one point, or none
  if (!std::isfinite(4 * extent) || extent < 1e-290)
    throw InvalidArgument("farfield: points extend over " + text(extent) + ", which is beyond the range of the method");
  const double unit = std::ldexp(1.0, std::ilogb(extent) - 9);
  root.side = (std::ceil(extent / unit) + 1) * unit;
  for (std::size_t l = 0; l < static_cast<std::size_t>(dimension); ++l)
    root.corner[l] = std::floor(low[l] / unit) * unit;
  return root;
}

/// Roughly the functions a cluster that the tolerance takes.
double expected_rank(int dimension, double tolerance) {
  const double digits = -std::log10(tolerance);
  return dimension == 2 ? 3 + 4 * digits : 10 + 1.9 * digits * digits;
}

/// Of all couplings, the root of the mean square.
double mean_rank(const GeneralBlocks& blocks, const std::vector<LevelBasis>& bases) {
  double squares = 0, count = 0;
  for (std::size_t level = 0; level < blocks.couplings.size(); ++level)
    for (const GeneralCoupling& coupling : blocks.couplings[level]) {
      const LevelBasis& basis = bases[level];
      squares += std::pow(static_cast<double>(basis.matrices[basis.uses[coupling.offset].matrix].size()), 2);
      ++count;
    }
  return count == 0 ? 0 : std::sqrt(squares / count);
}

}  // namespace

template <int d>
GeneralEngine<d>::GeneralEngine(const KernelFunction& kernel, const Eigen::Ref<const Points<d>>& sources,
                                const Eigen::Ref<const Points<d>>* targets, const GeneralOptions& options)
    : kernel_(kernel),
      options_(options),
      self_(targets == nullptr),
      source_count_(static_cast<std::size_t>(sources.cols())),
      target_count_(targets ? static_cast<std::size_t>(targets->cols()) : source_count_) {
  Laps laps;
  check(options);
  choice_.separation = separation_of(options.eta, d);
  check_points("source", sources.data(), d, source_count_, static_cast<std::size_t>(sources.outerStride()),
               options.threads);
  if (targets)
    check_points("target", targets->data(), d, target_count_, static_cast<std::size_t>(targets->outerStride()),
                 options.threads);
  if (std::max(source_count_, target_count_) >= std::size_t{1} << 32)
    throw InvalidArgument("farfield: there are 2^32 points or more; general kernels take fewer");
  check_memory("the plan", 8.0 * d * static_cast<double>(source_count_ + target_count_), options.memory_limit);
  source_ = by_axis<d>(sources);
  if (targets) target_ = by_axis<d>(*targets);
  choice_.tolerance = options.tolerance;
  choice_.sources = source_count_;
  choice_.targets = target_count_;
  choose();
  choice_.build_seconds = laps.lap();
}

template <int d>
void GeneralEngine<d>::choose() {
  const double pairs = static_cast<double>(source_count_) * static_cast<double>(target_count_);
  const double direct_seconds = 1e-9 * kernel_.data().nanoseconds * pairs;
  const bool automatic = options_.method == GeneralMethod::automatic;
  choice_.pairs = pairs;
  // A plan takes longer than that.
  constexpr double least_plan = d == 2 ? 0.03 : 0.3, longest_instead = 30;
  if (pairs == 0 || options_.method == GeneralMethod::direct || (automatic && direct_seconds <= least_plan)) return;
  try {
    build(take_sample());
  } catch (const ToleranceError&) {
    if (!automatic || direct_seconds > longest_instead) throw;
  }
}

template <int d>
typename GeneralEngine<d>::Sample GeneralEngine<d>::take_sample() const {
  const KernelData& kernel = kernel_.data();
  const Coordinates& targets = self_ ? source_ : target_;
  Sample sample;
  const std::size_t count = std::min(sampled, target_count_);
  Coordinates some;
  for (auto& axis : some) axis.assign(count + padding, 0.0);
  for (std::size_t k = 0; k < count; ++k) {
    sample.targets.push_back(k * target_count_ / count);
    for (std::size_t l = 0; l < d; ++l) some[l][k] = targets[l][sample.targets[k]];
  }
  // Signs without an order: the top bit of a multiplicative sequence.
  std::uint64_t state = 0x9e3779b97f4a7c15ULL;
  for (std::size_t j = 0; j < source_count_; ++j) {
    state ^= state << 13U;
    state ^= state >> 7U;
    state ^= state << 17U;
    sample.charges.push_back((state >> 63U) != 0 ? 1.0 : -1.0);
  }
  sample.charges.resize(source_count_ + padding, 0.0);
  sample.sums.assign(count, 0.0);
  std::vector<double> sizes(count, 0.0);
  const double *target[3] = {}, *source[3] = {};
  for (std::size_t l = 0; l < 3; ++l) {
    target[l] = some[l].data();
    source[l] = source_[l].data();
  }
  constexpr std::size_t together = 16;
  const double seconds = 2e-9 * kernel.nanoseconds * static_cast<double>(count) * static_cast<double>(source_count_);
  const bool positive = kernel.shape != GeneralShape::of_distance && kernel.shape != GeneralShape::of_difference;
  const std::vector<double> ones(source_count_ + padding, 1.0);
  parallel_for({(count + together - 1) / together, seconds}, options_.threads, [&](std::size_t piece) {
    const Range these{piece * together, std::min(count, (piece + 1) * together)}, all{0, source_count_};
    double sums[together + padding] = {}, absolute[together + padding] = {};
    const double* shifted[3];
    for (int l = 0; l < d; ++l) shifted[l] = target[l] + these.begin;
    const Range from_zero{0, these.end - these.begin};
    add_pairs(kernel, d, shifted, from_zero, source, sample.charges.data(), &all, 1, sums);
    if (positive) {
      add_pairs(kernel, d, shifted, from_zero, source, ones.data(), &all, 1, absolute);
    } else {
      double difference[3][kernel_block], values[kernel_block];
      const double* const rows[3] = {difference[0], difference[1], difference[2]};
      for (std::size_t i = these.begin; i < these.end; ++i)
        for (std::size_t begin = 0; begin < source_count_; begin += kernel_block) {
          const std::size_t length = std::min(kernel_block, source_count_ - begin);
          for (std::size_t l = 0; l < d; ++l)
            for (std::size_t j = 0; j < length; ++j) difference[l][j] = target[l][i] - source[l][begin + j];
          kernel_values(kernel, d, rows, length, values);
          for (std::size_t j = 0; j < length; ++j) absolute[i - these.begin] += std::abs(values[j]);
        }
    }
    for (std::size_t i = these.begin; i < these.end; ++i) {
      sample.sums[i] = sums[i - these.begin];
      sizes[i] = absolute[i - these.begin];
    }
  });
  for (std::size_t k = 0; k < count; ++k)
    if (!std::isfinite(sizes[k]))
      throw InvalidArgument("farfield: the kernel is not finite between target " + std::to_string(sample.targets[k]) +
                            " and a source at r > 0");
  sample.sizes = sizes;
  std::sort(sizes.begin(), sizes.end());
  // The tenth that sees most is left out: two points that are very close to each other should not make the promise void.
  const std::size_t typical = count - count / 10;
  for (std::size_t k = 0; k < typical; ++k)
    sample.kernel_size += sizes[k] / (static_cast<double>(source_count_) * static_cast<double>(typical));
  return sample;
}

template <int d>
std::vector<LevelTask> GeneralEngine<d>::tasks_of(const GeneralBlocks& blocks, const GeneralTree& tree,
                                                  double tolerance) const {
  // The square of the error is the sum of those of the levels. Half of it is shared by their numbers of couplings, so that
  // levels with much work may err more.
  std::vector<LevelTask> tasks(blocks.couplings.size());
  double all_couplings = 0, levels = 0;
  for (const auto& couplings : blocks.couplings) {
    all_couplings += static_cast<double>(couplings.size());
    levels += couplings.empty() ? 0 : 1;
  }
  const double pairs = static_cast<double>(source_count_) * static_cast<double>(target_count_);
  for (std::size_t level = 0; level < tasks.size(); ++level) {
    LevelTask& task = tasks[level];
    task.side = tree.side(static_cast<int>(level));
    task.offsets = blocks.offsets[level];
    if (task.offsets.empty()) continue;
    double far_pairs = 0;
    for (const GeneralOffset& offset : task.offsets) far_pairs += offset.far_pairs;
    const double share = 0.3 / levels + 0.7 * static_cast<double>(blocks.couplings[level].size()) / all_couplings;
    task.allowed = tolerance * std::sqrt(share * pairs / far_pairs);
    task.needed = true;
  }
  return tasks;
}

template <int d>
std::unique_ptr<H2Matrix> GeneralEngine<d>::make_matrix(double tolerance) const {
  const KernelData& kernel = kernel_.data();
  const Root root = root_of(d, source_, source_count_, target_, self_ ? 0 : target_count_);
  GeneralTree targets(d, self_ ? source_ : target_, target_count_, root.corner, root.side);
  GeneralTree sources(d, self_ ? Coordinates{} : source_, self_ ? 0 : source_count_, root.corner, root.side);
  BasisOptions options{.recompress = options_.recompress};
  GeneralBlocks blocks;
  std::vector<LevelTask> tasks;
  std::vector<LevelBasis> bases;
  double rank = expected_rank(d, options_.tolerance);
  for (bool again = options_.leaf_size == 0;; again = false) {
    GeneralTree target_tree = targets, source_tree = sources;
    // A coupling costs two numbers of rank^2, of which some 40 are done in a nanosecond, and touches 4 rank numbers.
    const double coupling = (rank * rank / 25 + rank) / kernel.nanoseconds;  // in pairs of points
    // To divide two touching clusters makes (in the inside of a cloud) 3^d - 1 times 2^d - 1 such couplings more a child.
    DivisionLimits limits{choice_.separation, (d == 2 ? 16.0 : 64.0) * coupling, coupling};
    if (options_.leaf_size > 0) {
      limits.touching = static_cast<double>(options_.leaf_size) * static_cast<double>(options_.leaf_size);
      limits.worthwhile = std::min(limits.worthwhile, limits.touching);
    }
    blocks = make_blocks(target_tree, self_ ? target_tree : source_tree, limits, options_.memory_limit);
    tasks = tasks_of(blocks, target_tree, tolerance);
    // A level needs a basis from the first one with couplings to the last one.
    std::size_t first = 0, end = tasks.size();
    while (first < end && !tasks[first].needed) ++first;
    while (end > first && !tasks[end - 1].needed) --end;
    for (std::size_t level = first; level < end; ++level) tasks[level].needed = true;
    bases = build_bases(kernel, d, tasks, options, options_.memory_limit);
    const double found = mean_rank(blocks, bases);
    if (!again || found == 0 || (found < 1.5 * rank && found > 0.6 * rank)) {
      targets = std::move(target_tree);
      sources = std::move(source_tree);
      break;
    }
    rank = found;  // a kernel that takes more functions than most, or fewer, gets other clusters
  }
  if (!options_.variable_order) {
    for (const LevelBasis& basis : bases)
      if (basis.products) options.fixed_order = std::max(options.fixed_order, basis.products->order);
    if (options.fixed_order > 0) bases = build_bases(kernel, d, tasks, options, options_.memory_limit);
  }
  return std::make_unique<H2Matrix>(
      kernel, d, H2Matrix::Parts{std::move(targets), std::move(sources), self_, std::move(blocks), std::move(bases)},
      options_.threads, options_.memory_limit);
}

/// The square of the error's Frobenius norm is M times the mean over targets of the square of a sum's error, in the mean
/// over random signs of the charges.
template <int d>
double GeneralEngine<d>::measured_error(const H2Matrix& matrix, const Sample& sample) const {
  std::vector<double> sums(target_count_, 0.0);
  GeneralSeconds ignored;
  matrix.multiply(sample.charges.data(), sums.data(), options_.threads, ignored);
  double squares = 0;
  for (std::size_t k = 0; k < sample.targets.size(); ++k)
    squares +=
        std::pow(std::max(0.0, std::abs(sums[sample.targets[k]] - sample.sums[k]) - rounding * sample.sizes[k]), 2);
  const double scale = sample.kernel_size * std::sqrt(static_cast<double>(source_count_));
  const double error = std::sqrt(squares / static_cast<double>(sample.targets.size()));
  return error == 0 ? 0 : error / scale;
}

template <int d>
void GeneralEngine<d>::build(const Sample& sample) {
  double share = aimed_at;
  for (int attempt = 1;; ++attempt) {
    std::unique_ptr<H2Matrix> matrix = make_matrix(share * options_.tolerance * sample.kernel_size);
    const double measured = measured_error(*matrix, sample);
    if (measured <= enough * options_.tolerance) {
      choice_.measured = measured;
      choice_.compared = sample.targets.size();
      choice_.kernel_size = sample.kernel_size;
      choice_.method = GeneralMethod::interpolation;
      matrix_ = std::move(matrix);
      tell(*matrix_);
      return;
    }
    if (attempt == attempts || !std::isfinite(measured))
      throw ToleranceError("farfield: the sums err by " + text(measured) +
                           ", GeneralOptions::tolerance = " + text(options_.tolerance) +
                           ": the kernel is not smooth enough. Raise the tolerance, or leave the method to direct");
    share *= std::max(0.02, 0.7 * enough * options_.tolerance / measured);
  }
}

template <int d>
void GeneralEngine<d>::tell(const H2Matrix& matrix) {
  choice_.pairs = matrix.blocks().near_pairs;
  choice_.clusters = matrix.clusters();
  choice_.basis_bytes = matrix.basis_bytes();
  choice_.coupling_bytes = matrix.coupling_bytes();
  choice_.list_bytes = matrix.list_bytes();
  const Root root = root_of(d, source_, source_count_, target_, self_ ? 0 : target_count_);
  for (std::size_t level = 0; level < matrix.bases().size(); ++level) {
    const LevelBasis& basis = matrix.bases()[level];
    if (!basis.products) continue;
    GeneralLevel& told = choice_.levels.emplace_back();
    told.level = static_cast<int>(level);
    told.side = std::ldexp(root.side, -told.level);
    told.order = basis.products->order;
    told.functions = basis.products->size();
    told.rank = basis.rank;
    told.clusters = matrix.target_bases().clusters[level].size();
    told.couplings = matrix.blocks().couplings[level].size();
    told.matrices = basis.matrices.size();
    double squares = 0;
    for (const GeneralCoupling& coupling : matrix.blocks().couplings[level])
      squares += std::pow(static_cast<double>(basis.matrices[basis.uses[coupling.offset].matrix].size()), 2);
    told.mean_rank = told.couplings == 0 ? 0 : std::sqrt(squares / static_cast<double>(told.couplings));
    for (const GeneralOffset& offset : matrix.blocks().offsets[level]) told.far_pairs += offset.far_pairs;
  }
}

template <int d>
Eigen::VectorXd GeneralEngine<d>::evaluate(const Eigen::Ref<const Eigen::VectorXd>& charges,
                                           GeneralSeconds& seconds) const {
  check_charges(charges, source_count_);
  seconds = {};
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(target_count_));
  if (matrix_) {
    matrix_->multiply(charges.data(), sums.data(), options_.threads, seconds);
  } else if (target_count_ > 0) {
    Laps laps;
    const Coordinates& targets = self_ ? source_ : target_;
    Buffer<double> padded_charges(source_count_ + padding, 0.0);
    std::copy(charges.data(), charges.data() + source_count_, padded_charges.begin());
    Buffer<double> padded_sums(target_count_ + padding, 0.0);
    const double *target[3] = {}, *source[3] = {};
    for (std::size_t l = 0; l < 3; ++l) {
      target[l] = targets[l].data();
      source[l] = source_[l].data();
    }
    constexpr std::size_t together = 256;
    parallel_for({(target_count_ + together - 1) / together, 1e-9 * kernel_.data().nanoseconds * choice_.pairs},
                 options_.threads, [&](std::size_t piece) {
                   const Range all{0, source_count_};
                   add_pairs(kernel_.data(), d, target,
                             {piece * together, std::min(target_count_, (piece + 1) * together)}, source,
                             padded_charges.data(), &all, 1, padded_sums.data());
                 });
    std::copy_n(padded_sums.begin(), target_count_, sums.data());
    seconds.near = laps.lap();
  }
  check_values("sum", sums.data(), target_count_, 1, nullptr);
  return sums;
}

template class GeneralEngine<2>;
template class GeneralEngine<3>;

}  // namespace farfield::detail
